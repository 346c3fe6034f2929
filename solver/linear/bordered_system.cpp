#include "solver/linear/bordered_system.h"

#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check(const LinearOperator& matrix, const Border& border) {
  const Index n = matrix.rows();
  const Index e = border.size();
  if (matrix.cols() != n || border.columns.rows() != n || border.columns.cols() != e || border.rows.rows() != e ||
      border.rows.cols() != n || border.corner.cols() != e)
    throw InputError(fmt::format("a border of {} x {}, {} x {} and {} x {} does not fit a matrix of {} x {}",
                                 border.columns.rows(), border.columns.cols(), border.rows.rows(), border.rows.cols(),
                                 border.corner.rows(), border.corner.cols(), n, matrix.cols()));
}

std::size_t bytes(const MatrixXd& matrix) {
  return static_cast<std::size_t>(matrix.size()) * sizeof(double);
}

}  // namespace

BorderedMatrix::BorderedMatrix(const LinearOperator& matrix, Border border)
    : matrix_(matrix), border_(std::move(border)) {
  check(matrix_, border_);
}

void BorderedMatrix::add_product(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> result) const {
  const Index n = matrix_.rows();
  const Index e = border_.size();
  matrix_.add_product(x.head(n), result.head(n));
  result.head(n) += border_.columns * x.tail(e);
  result.tail(e) += border_.rows * x.head(n) + border_.corner * x.tail(e);
}

std::size_t BorderedMatrix::memory() const {
  return matrix_.memory() + bytes(border_.columns) + bytes(border_.rows) + bytes(border_.corner);
}

BorderedInverse::BorderedInverse(const LinearOperator& inverse, Border border, double weight)
    : inverse_(inverse), border_(std::move(border)), weight_(weight) {
  check(inverse_, border_);
  const MatrixXd columns = border_.columns + weight_ * border_.columns * border_.corner;
  solved_columns_.resize(columns.rows(), columns.cols());
  for (Index k = 0; k < columns.cols(); ++k) solved_columns_.col(k) = inverse_.product(columns.col(k));
  const MatrixXd schur = border_.corner - border_.rows * solved_columns_;
  const Eigen::FullPivLU<MatrixXd> factors(schur);
  if (!schur.allFinite() || factors.rank() < border_.size())
    throw NumericalError(
        fmt::format("the {} extra rows of the system do not determine its null space: rank {} of the Schur complement",
                    border_.size(), schur.allFinite() ? factors.rank() : 0));
  schur_inverse_ = factors.inverse();
}

void BorderedInverse::add_product(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> result) const {
  const Index n = inverse_.rows();
  const Index e = border_.size();
  const VectorXd shifted = x.head(n) + weight_ * border_.columns * x.tail(e);
  const VectorXd first = inverse_.product(shifted);
  const VectorXd last = schur_inverse_ * (x.tail(e) - border_.rows * first);
  result.head(n) += first - solved_columns_ * last;
  result.tail(e) += last;
}

std::size_t BorderedInverse::memory() const {
  return inverse_.memory() + bytes(border_.columns) + bytes(border_.rows) + bytes(border_.corner) +
         bytes(solved_columns_) + bytes(schur_inverse_);
}

}  // namespace isorim::solver
