#include "geometry/fitting/pereira_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/fit_problem.h"
#include "geometry/fitting/section_rules.h"

namespace isorim::geometry {

namespace {

constexpr int degree = 3;

/// Chord lengths along the open polygon, from 0 to 1.
std::vector<double> open_parameters(const Points<2>& points) {
  std::vector<double> parameters(static_cast<std::size_t>(points.cols()), 0.0);
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const Eigen::Index column = static_cast<Eigen::Index>(i);
    parameters[i] = parameters[i - 1] + (points.col(column) - points.col(column - 1)).norm();
  }
  const double length = parameters.back();
  for (double& u : parameters) u /= length;
  return parameters;
}

/// The mean (1 - a) u[i - 1] + a u[i] at k spacing = i + a.
double averaged_parameter(const std::vector<double>& parameters, double place) {
  const std::size_t i = static_cast<std::size_t>(place);
  const double a = place - static_cast<double>(i);
  return (1.0 - a) * parameters[i - 1] + a * parameters[i];
}

KnotVector clamped_knots(const std::vector<double>& parameters, int count, double data_count) {
  const double spacing = data_count / (count - degree + 1);
  std::vector<double> breakpoints{0.0};
  for (int k = 1; k < count - degree; ++k) breakpoints.push_back(averaged_parameter(parameters, k * spacing));
  breakpoints.push_back(1.0);
  return KnotVector::clamped(degree, breakpoints);
}

KnotVector closed_knots(const std::vector<double>& parameters, int count) {
  const double spacing = static_cast<double>(parameters.size()) / (count + 1);
  std::vector<double> breakpoints{0.0};
  for (int k = 1; k <= count; ++k) breakpoints.push_back(averaged_parameter(parameters, k * spacing));
  return KnotVector::periodic(degree, breakpoints);
}

Points<2> clamped_fit(const Points<2>& points, const std::vector<double>& parameters,
                      const std::vector<double>& weights, const KnotVector& knots) {
  const Points<2> control = solve_fit<2>({knots, 0}, {points, weights}, parameters, {}, {});
  if (control.cols() == 0)
    throw GeometryError(
        fmt::format("Pereira's fit: {} control points, but some of them are not determined by the {} "
                    "points; give fewer control points",
                    knots.basis_count(), points.cols()));
  return control;
}

/// The line through the first point on which P1 and P2 shall lie: to the point that has the coordinates of a
/// derivative vector.
struct SeamLine {
  Point2 origin;
  Vector2 direction;

  SeamLine(const Point2& first, const Vector2& derivative)
      : origin(first), direction((derivative - first).normalized()) {}

  Point2 foot(const Point2& point) const { return origin + direction * direction.dot(point - origin); }
};

SeamLine seam_line(const Points<2>& points, const KnotVector& knots, PereiraTangent tangent) {
  // Eq. 5.11.
  if (tangent == PereiraTangent::of_start)
    return {points.col(0), degree / knots[degree + 1] * (points.col(1) - points.col(0))};
  const Eigen::Index last = points.cols() - 1;
  const double span = 1.0 - knots[knots.basis_count() - 1];
  return {points.col(0), degree / span * (points.col(last) - points.col(last - 1))};
}

void require_counts(Eigen::Index points, std::size_t weights, int control_points) {
  if (weights != static_cast<std::size_t>(points))
    throw GeometryError(fmt::format("Pereira's fit: {} weights for {} points", weights, points));
  if (control_points < degree + 2 || control_points >= points)
    throw GeometryError(fmt::format("Pereira's fit: {} control points for {} points; expected {} to {}", control_points,
                                    points, degree + 2, points - 1));
}

}  // namespace

std::vector<PereiraStart> pereira_starts(const Points<2>& points, const std::vector<double>& weights,
                                         int control_points, PereiraTangent tangent) {
  std::vector<PereiraStart> starts;
  Points<2> turned = points;
  std::vector<double> turned_weights = weights;
  for (const int start : aligned_points(interior_angles(points))) {
    const Eigen::Index rest = points.cols() - start;
    turned.leftCols(rest) = points.rightCols(rest);
    turned.rightCols(start) = points.leftCols(start);
    std::rotate_copy(weights.begin(), weights.begin() + start, weights.end(), turned_weights.begin());
    const int count = control_points > 0 ? control_points : inversion_control_points(turned);
    require_counts(points.cols(), weights.size(), count);
    const std::vector<double> parameters = open_parameters(turned);
    const KnotVector knots = clamped_knots(parameters, count, static_cast<double>(points.cols() + 1));
    const Points<2> control = clamped_fit(turned, parameters, turned_weights, knots);
    const SeamLine line = seam_line(turned, knots, tangent);
    starts.push_back({start, (control.col(1) - line.foot(control.col(1))).norm(),
                      (control.col(2) - line.foot(control.col(2))).norm(), count});
  }
  return starts;
}

PereiraFit pereira_fit(const Points<2>& points, const std::vector<double>& weights, int control_points) {
  require_counts(points.cols(), weights.size(), control_points);
  const std::vector<double> parameters = open_parameters(points);
  const KnotVector knots = clamped_knots(parameters, control_points, static_cast<double>(points.cols()));
  Points<2> control = clamped_fit(points, parameters, weights, knots);
  const SeamLine line = seam_line(points, knots, PereiraTangent::of_end);
  for (const Eigen::Index i : {1, 2}) control.col(i) = line.foot(control.col(i));

  Points<2> closed(2, control_points + degree);
  for (Eigen::Index i = 0; i < closed.cols(); ++i)
    closed.col(i) = control.col((i + control_points - 2) % control_points);
  return {NurbsCurve<2>::from_points(closed_knots(parameters, control_points), closed), std::move(control)};
}

}  // namespace isorim::geometry
