#include "solver/linear/low_rank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/QR>

#include "geometry/errors.h"
#include "solver/linear/column_products.h"
#include "solver/linear/column_qr.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Turns the columns p < q of the matrix in their plane until they are orthogonal, unless the cosine of their angle is
/// small enough; whether there was anything to turn.
bool orthogonalise(MatrixXd& matrix, Eigen::VectorXd& squared_norms, Index p, Index q, double small) {
  const double product = matrix.col(p).dot(matrix.col(q));
  if (std::abs(product) <= small * std::sqrt(squared_norms[p] * squared_norms[q])) return false;
  const double zeta = (squared_norms[q] - squared_norms[p]) / (2.0 * product);
  const double tangent = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
  const double cosine = 1.0 / std::hypot(1.0, tangent);
  const double sine = cosine * tangent;
  for (Index i = 0; i < matrix.rows(); ++i) {
    const double a = matrix(i, p);
    const double b = matrix(i, q);
    matrix(i, p) = cosine * a - sine * b;
    matrix(i, q) = sine * a + cosine * b;
  }
  squared_norms[p] = matrix.col(p).squaredNorm();
  squared_norms[q] = matrix.col(q).squaredNorm();
  return true;
}

/// One-sided Jacobi (Hestenes): turns the columns until they are orthogonal. Their norms are then the singular values;
/// divided by them they are the left singular vectors.
void orthogonalise_columns(MatrixXd& matrix, double small) {
  Eigen::VectorXd squared_norms = matrix.colwise().squaredNorm().transpose();
  constexpr int max_sweeps = 40;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool turned = false;
    for (Index p = 0; p + 1 < matrix.cols(); ++p)
      for (Index q = p + 1; q < matrix.cols(); ++q) turned |= orthogonalise(matrix, squared_norms, p, q, small);
    if (!turned) return;
  }
}

/// How many of the rows of a triangle or of the sorted singular values must stay for the rest to be within `allowed`.
Index kept_count(const Eigen::VectorXd& norms, double allowed) {
  double tail = 0.0;
  Index kept = norms.size();
  while (kept > 0 && tail + norms[kept - 1] * norms[kept - 1] <= allowed * allowed) {
    tail += norms[kept - 1] * norms[kept - 1];
    --kept;
  }
  return kept;
}

/// The right singular vectors of the matrix that belong to the singular values which the accuracy asks for.
MatrixXd dominant_right_vectors(const MatrixXd& matrix, const Accuracy& accuracy) {
  const double norm = matrix.norm();
  if (!std::isfinite(norm)) throw NumericalError("a low-rank block has entries that are not finite");
  if (norm == 0.0) return MatrixXd(matrix.cols(), 0);
  const double allowed = std::max(accuracy.allowed(norm), epsilon * norm);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(matrix);
  const Index steps = std::min(matrix.rows(), matrix.cols());
  MatrixXd triangle = qr.matrixQR().topRows(steps).template triangularView<Eigen::Upper>();
  // What the pivoting has already driven far below the accuracy need not be turned.
  const Index rows = kept_count(triangle.rowwise().norm(), 0.05 * allowed);
  MatrixXd vectors = triangle.topRows(rows).transpose();
  orthogonalise_columns(vectors,
                        std::clamp(1e-3 * allowed / norm, 2.0 * epsilon * std::sqrt(static_cast<double>(steps)), 1e-7));
  const Eigen::VectorXd values = vectors.colwise().norm().transpose();
  std::vector<Index> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] > values[b]; });
  const Eigen::VectorXd sorted = values(order);
  const Index kept = kept_count(sorted, 0.998 * allowed);
  MatrixXd result(matrix.cols(), kept);
  for (Index k = 0; k < kept; ++k) result.col(k) = vectors.col(order[static_cast<std::size_t>(k)]) / sorted[k];
  return qr.colsPermutation() * result;
}

}  // namespace

LowRank truncate(const LowRank& matrix, const Accuracy& accuracy) {
  if (matrix.rank() == 0) return matrix;
  const ColumnQr right(matrix.v);
  const MatrixXd left_triangle = ColumnQr(matrix.u).triangle();
  const MatrixXd right_triangle = right.triangle();
  MatrixXd core = MatrixXd::Zero(left_triangle.rows(), right_triangle.rows());
  add_product_with_transposed(1.0, left_triangle, right_triangle, core);
  const MatrixXd vectors = dominant_right_vectors(core, accuracy);
  MatrixXd mix = MatrixXd::Zero(matrix.rank(), vectors.cols());
  add_transposed_product(1.0, right_triangle, vectors, mix);
  MatrixXd u = MatrixXd::Zero(matrix.u.rows(), vectors.cols());
  add_product(1.0, matrix.u, mix, u);
  return {std::move(u), right.orthonormal_times(vectors)};
}

LowRank compress(const Eigen::Ref<const MatrixXd>& matrix, const Accuracy& accuracy) {
  if (matrix.size() == 0) return {MatrixXd(matrix.rows(), 0), MatrixXd(matrix.cols(), 0)};
  MatrixXd vectors = dominant_right_vectors(matrix, accuracy);
  MatrixXd scaled = matrix * vectors;
  return {std::move(scaled), std::move(vectors)};
}

double frobenius_norm(const LowRank& matrix) {
  if (matrix.rank() == 0) return 0.0;
  const MatrixXd left = matrix.u.transpose() * matrix.u;
  const MatrixXd right = matrix.v.transpose() * matrix.v;
  return std::sqrt(std::max(0.0, left.cwiseProduct(right).sum()));
}

}  // namespace isorim::solver
