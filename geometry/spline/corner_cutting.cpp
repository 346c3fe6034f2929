#include "geometry/spline/corner_cutting.h"

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {

void blend_columns(Eigen::Ref<Eigen::MatrixXd> columns, Eigen::Index target, Eigen::Index x, Eigen::Index y, double u,
                   double left, double right) {
  // Measured from the nearer end, so that u = left and u = right give x and y exactly.
  const double width = right - left;
  if (u - left <= right - u)
    columns.col(target) = columns.col(x) + (u - left) / width * (columns.col(y) - columns.col(x));
  else
    columns.col(target) = columns.col(y) + (right - u) / width * (columns.col(x) - columns.col(y));
}

void cut_from_left(const KnotVector& knots, int span, double u, Eigen::Ref<Eigen::MatrixXd> local) {
  const int p = knots.degree();
  for (int r = 0; r < p; ++r)
    for (int i = 0; i < p - r; ++i)
      blend_columns(local, i, i, i + 1, u, knots[span - p + i + r + 1], knots[span + i + 1]);
}

void cut_from_right(const KnotVector& knots, int span, double u, Eigen::Ref<Eigen::MatrixXd> local) {
  const int p = knots.degree();
  for (int r = 0; r < p; ++r)
    for (int i = p; i > r; --i) blend_columns(local, i, i - 1, i, u, knots[span - p + i], knots[span + i - r]);
}

void cut_to_bezier(const KnotVector& knots, int span, Eigen::Ref<Eigen::MatrixXd> local) {
  const int p = knots.degree();
  const double first = knots[span];
  const double last = knots[span + 1];
  cut_from_left(knots, span, first, local);
  for (int r = 0; r < p; ++r)
    for (int i = p; i > r; --i) blend_columns(local, i, i - 1, i, last, first, knots[span + i - r]);
}

void require_consistent(const BSpline& spline) {
  if (spline.coefficients.cols() != spline.knots.basis_count())
    throw GeometryError(fmt::format("B-spline: {} coefficients for {} basis functions", spline.coefficients.cols(),
                                    spline.knots.basis_count()));
}

std::vector<int> nonempty_spans(const KnotVector& knots) {
  std::vector<int> spans;
  for (int i = knots.degree(); i < knots.basis_count(); ++i)
    if (knots[i] < knots[i + 1]) spans.push_back(i);
  return spans;
}

}  // namespace isorim::geometry
