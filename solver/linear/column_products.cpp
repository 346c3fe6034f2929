#include "solver/linear/column_products.h"

#include "solver/linear/small_products.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// result += a b, entry (l, j) of b at b.data[j b.row_step + l b.column_step]. Seen by rows it is bᵀ aᵀ: the kernel's
/// rows are columns here.
void add(const ConstColumns& a, const SteppedMatrix& b, Eigen::Ref<MatrixXd> result) {
  const auto depth = static_cast<int>(a.cols());
  const auto columns = static_cast<int>(result.cols());
  const Index whole = result.rows() / product_lanes * product_lanes;
  if (whole > 0)
    add_product(columns, static_cast<int>(whole), depth, b, a.data(), a.outerStride(), result.data(),
                result.outerStride());
  const Index rest = result.rows() - whole;
  if (rest == 0) return;
  MatrixXd last = MatrixXd::Zero(product_lanes, depth);
  last.topRows(rest) = a.bottomRows(rest);
  MatrixXd sums = MatrixXd::Zero(product_lanes, columns);
  add_product(columns, product_lanes, depth, b, last.data(), product_lanes, sums.data(), product_lanes);
  result.bottomRows(rest) += sums.topRows(rest);
}

}  // namespace

void add_product(double factor, const ConstColumns& a, const ConstColumns& b, Eigen::Ref<MatrixXd> result) {
  if (factor == 1.0) return add(a, {b.data(), b.outerStride(), 1}, result);
  const MatrixXd scaled = factor * b;
  add(a, {scaled.data(), scaled.outerStride(), 1}, result);
}

void add_product_with_transposed(double factor, const ConstColumns& a, const ConstColumns& b,
                                 Eigen::Ref<MatrixXd> result) {
  if (factor == 1.0) return add(a, {b.data(), 1, b.outerStride()}, result);
  const MatrixXd scaled = factor * b;
  add(a, {scaled.data(), 1, scaled.outerStride()}, result);
}

void add_transposed_product(double factor, const ConstColumns& a, const ConstColumns& b, Eigen::Ref<MatrixXd> result) {
  const auto depth = static_cast<int>(a.rows());
  const auto rows = static_cast<int>(result.rows());
  const auto columns = static_cast<int>(result.cols());
  const auto add_scaled = [&](const ConstColumns& right) {
    add_product_transposed(columns, rows, depth, right.data(), right.outerStride(), a.data(), a.outerStride(),
                           result.data(), result.outerStride());
  };
  if (factor == 1.0) return add_scaled(b);
  add_scaled(factor * b);
}

}  // namespace isorim::solver
