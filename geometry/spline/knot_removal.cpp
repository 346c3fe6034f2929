#include "geometry/spline/knot_removal.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/corner_cutting.h"

namespace isorim::geometry {

namespace {

/// The largest norm among the blocks of a column.
double largest_block_norm(const Eigen::VectorXd& column, Eigen::Index block) {
  return column.reshaped(block, column.size() / block).colwise().norm().maxCoeff();
}

}  // namespace

void require_inner_knot(const KnotVector& knots, double u) {
  const Interval domain = knots.domain();
  if (!(domain.first < u && u < domain.last) || knots.multiplicity(u) == 0)
    throw GeometryError(
        fmt::format("knot removal: {} is no knot strictly inside the domain [{}, {}]", u, domain.first, domain.last));
}

SingleRemoval remove_knot_once(const BSpline& spline, double u, Eigen::Index block) {
  const int p = spline.knots.degree();
  const Eigen::MatrixXd& old = spline.coefficients;
  std::vector<double> knots(spline.knots.knots().begin(), spline.knots.knots().end());
  const auto end = std::upper_bound(knots.begin(), knots.end(), u);
  // s and k: multiplicity of u and index of its last occurrence (or of the knot before it) after the removal.
  const int s = spline.knots.multiplicity(u) - 1;
  const int k = static_cast<int>(end - knots.begin()) - 2;
  knots.erase(end - 1);
  SingleRemoval result{{KnotVector(p, std::move(knots)), {}}, 0.0};
  const KnotVector& tau = result.spline.knots;
  Eigen::MatrixXd& c = result.spline.coefficients;
  c.resize(old.rows(), old.cols() - 1);
  c.leftCols(k - p + 1) = old.leftCols(k - p + 1);
  c.rightCols(c.cols() - (k - s)) = old.rightCols(c.cols() - (k - s));
  if (s == p) {
    // A jump: two coefficients become one.
    c.col(k - p) = old.col(k - p) + 0.5 * (old.col(k - p + 1) - old.col(k - p));
    result.largest_move = 0.5 * largest_block_norm(old.col(k - p + 1) - old.col(k - p), block);
    return result;
  }

  // Insertion says old_i = (1 - a_i) c_{i-1} + a_i c_i for i = k - p + 1 .. k - s.
  const auto left_share = [&](int i) { return (u - tau[i]) / (tau[i + p] - tau[i]); };
  const auto right_share = [&](int i) { return (tau[i + p] - u) / (tau[i + p] - tau[i]); };
  int low = k - p + 1;
  int high = k - s;
  while (low < high) {
    c.col(low) = c.col(low - 1) + (old.col(low) - c.col(low - 1)) / left_share(low);
    if (++low == high) break;
    c.col(high - 1) = c.col(high) + (old.col(high) - c.col(high)) / right_share(high);
    --high;
  }
  for (int i = k - p + 1; i <= k - s; ++i) {
    const Eigen::VectorXd change = c.col(i - 1) + left_share(i) * (c.col(i) - c.col(i - 1)) - old.col(i);
    result.largest_move = std::max(result.largest_move, largest_block_norm(change, block));
  }
  return result;
}

KnotRemoval remove_knot(const BSpline& spline, double u, int times, double tolerance) {
  require_consistent(spline);
  require_inner_knot(spline.knots, u);
  KnotRemoval result{spline, 0, 0.0};
  while (result.removed < times && result.spline.knots.multiplicity(u) > 0) {
    SingleRemoval candidate = remove_knot_once(result.spline, u, spline.coefficients.rows());
    const double bound = result.error_bound + candidate.largest_move;
    if (!(bound <= tolerance)) break;
    result = {std::move(candidate.spline), result.removed + 1, bound};
  }
  return result;
}

}  // namespace isorim::geometry
