#include "solver/linear/column_qr.h"

#include <algorithm>
#include <utility>

#include <Eigen/Householder>

#include "solver/linear/column_products.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Columns that are reflected one by one.
constexpr Index panel_width = 8;

/// The triangle t of (I - tau_1 v_1 v_1ᵀ) ... (I - tau_w v_w v_wᵀ) = I - v t vᵀ.
MatrixXd triangle_of_product(const MatrixXd& v, const VectorXd& tau) {
  const Index width = v.cols();
  MatrixXd gram = MatrixXd::Zero(width, width);
  add_transposed_product(1.0, v, v, gram);
  MatrixXd t = MatrixXd::Zero(width, width);
  for (Index j = 0; j < width; ++j) {
    t(j, j) = tau[j];
    for (Index i = 0; i < j; ++i) t(i, j) = -tau[j] * t.row(i).head(j).dot(gram.col(j).head(j));
  }
  return t;
}

}  // namespace

ColumnQr::ColumnQr(MatrixXd matrix) : matrix_(std::move(matrix)) {
  const Index steps = std::min(matrix_.rows(), matrix_.cols());
  for (Index first = 0; first < steps; first += panel_width) {
    panels_.push_back(reflect(first, std::min(panel_width, steps - first)));
    const Panel& panel = panels_.back();
    const Index next = first + panel.v.cols();
    if (next == matrix_.cols()) continue;
    auto rest = matrix_.bottomRightCorner(matrix_.rows() - first, matrix_.cols() - next);
    MatrixXd inner = MatrixXd::Zero(panel.v.cols(), rest.cols());
    add_transposed_product(1.0, panel.v, rest, inner);
    add_product(-1.0, panel.v, panel.t.transpose() * inner, rest);
  }
}

ColumnQr::Panel ColumnQr::reflect(Index first, Index width) {
  const Index rows = matrix_.rows() - first;
  Panel panel{first, MatrixXd::Zero(rows, width), {}};
  VectorXd tau(width);
  Eigen::RowVectorXd room(width);
  for (Index k = 0; k < width; ++k) {
    auto column = matrix_.col(first + k).tail(rows - k);
    auto v = panel.v.col(k).tail(rows - k);
    double beta = 0.0;
    auto essential = v.tail(rows - k - 1);
    column.makeHouseholder(essential, tau[k], beta);
    v[0] = 1.0;
    column.setZero();
    column[0] = beta;
    auto others = matrix_.block(first + k, first + k + 1, rows - k, width - k - 1);
    room.head(width - k - 1).noalias() = v.transpose() * others;
    others.noalias() -= (tau[k] * v) * room.head(width - k - 1);
  }
  panel.t = triangle_of_product(panel.v, tau);
  return panel;
}

MatrixXd ColumnQr::triangle() const {
  return matrix_.topRows(std::min(matrix_.rows(), matrix_.cols())).triangularView<Eigen::Upper>();
}

MatrixXd ColumnQr::orthonormal_times(const Eigen::Ref<const MatrixXd>& matrix) const {
  MatrixXd result = MatrixXd::Zero(matrix_.rows(), matrix.cols());
  result.topRows(matrix.rows()) = matrix;
  for (auto panel = panels_.rbegin(); panel != panels_.rend(); ++panel) {
    auto rows = result.bottomRows(result.rows() - panel->first);
    MatrixXd inner = MatrixXd::Zero(panel->v.cols(), result.cols());
    add_transposed_product(1.0, panel->v, rows, inner);
    add_product(-1.0, panel->v, panel->t * inner, rows);
  }
  return result;
}

}  // namespace isorim::solver
