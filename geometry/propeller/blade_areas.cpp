#include "geometry/propeller/blade_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/propeller/blade_surface.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/interpolation.h"

namespace isorim::geometry {
namespace {

/// What is interpolated across the sections.
enum Row : Eigen::Index { radius, leading_x, leading_y, trailing_x, trailing_y, pitch_over_turn, skew, row_count };

/// The spline of the rows over v.
BSpline laws_across(std::span<const BladeSection> sections, int degree) {
  const std::vector<double> parameters = parameters_across(sections);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(row_count), static_cast<Eigen::Index>(sections.size()));
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const BladeSection& section = sections[k];
    const Eigen::Index last = section.outline.cols() - 1;
    const Point2 leading = section.outline.col(section.leading_edge_point);
    const Point2 trailing = 0.5 * (section.outline.col(0) + section.outline.col(last));
    values.col(static_cast<Eigen::Index>(k)) << section.station.radius, leading.x(), leading.y(), trailing.x(),
        trailing.y(), section.station.pitch / (2.0 * std::numbers::pi), section.station.skew;
  }
  return interpolate(averaged_knots(degree, parameters), parameters, values);
}

/// A point of the expanded plane on its cylinder: the angle from the generator line.
double angle_of(double x, double y, double r, double p, double skew_angle) {
  const double along = std::hypot(r, p);
  return (x * r - y * p) / (along * r) - skew_angle;
}

/// How far inward of the first section the laws are continued, as a part of their domain.
constexpr double longest_extension = 0.5;

/// d(area) / dv of the three areas.
BladeAreas density(const BSpline& laws, double v) {
  const Eigen::MatrixXd jet = evaluate_derivatives(laws, v, 1);
  const double r = jet(radius, 0);
  const double r_v = jet(radius, 1);
  const double p = jet(pitch_over_turn, 0);
  const double p_v = jet(pitch_over_turn, 1);
  const double chord = jet(leading_x, 0) - jet(trailing_x, 0);
  BladeAreas areas;
  areas.expanded = chord * r_v;
  const double lead = angle_of(jet(leading_x, 0), jet(leading_y, 0), r, p, jet(skew, 0));
  const double trail = angle_of(jet(trailing_x, 0), jet(trailing_y, 0), r, p, jet(skew, 0));
  areas.projected = r * (lead - trail) * r_v;
  // The helix's radius of curvature c = r + p^2 / r; an arc length x from the generator line, which the section has
  // left by its skew, lies at the angle x / c about a centre c below the arc. The area is that of the map (x, r) ->
  // plane.
  const double c = r + p * p / r;
  const double c_v = r_v + 2.0 * p * p_v / r - p * p * r_v / (r * r);
  const double shift = jet(skew, 0) * std::hypot(r, p);
  const double sines = std::sin((jet(leading_x, 0) - shift) / c) - std::sin((jet(trailing_x, 0) - shift) / c);
  areas.developed = c * (r_v - c_v) * sines + c_v * chord;
  return areas;
}

/// The parameter v at which the radius is that of the hub, by bisection: the radius rises.
double parameter_of_radius(const BSpline& laws, double hub_radius) {
  Interval bracket = laws.knots.domain();
  if (evaluate(laws, bracket.first)(radius) > hub_radius)
    throw GeometryError(
        fmt::format("blade areas: the blade starts too far outside the hub's radius {:.6g}", hub_radius));
  for (int i = 0; i < 100; ++i) {
    const double middle = bracket.middle();
    (evaluate(laws, middle)(radius) < hub_radius ? bracket.first : bracket.last) = middle;
  }
  return bracket.middle();
}

/// Gauss's rule of five points on eight parts of an interval.
BladeAreas integrate(const BSpline& laws, Interval range) {
  constexpr std::array<double, 5> nodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                        0.9061798459386640};
  constexpr std::array<double, 5> weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                          0.4786286704993665, 0.2369268850561891};
  constexpr int parts = 8;
  const double half = 0.5 * range.length() / parts;
  BladeAreas sum;
  for (int part = 0; part < parts; ++part) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const BladeAreas value =
          density(laws, range.first + (2.0 * part + 1.0 + nodes[i]) * half).scaled(weights[i] * half);
      sum = {sum.expanded + value.expanded, sum.developed + value.developed, sum.projected + value.projected};
    }
  }
  return sum;
}

}  // namespace

BladeAreas blade_areas(std::span<const BladeSection> sections, double hub_radius) {
  if (!sections.empty() && !(hub_radius < sections.back().station.radius))
    throw GeometryError(fmt::format("blade areas: a hub of radius {:.6g} covers the blade, whose tip lies at {:.6g}",
                                    hub_radius, sections.back().station.radius));
  const int degree = std::min(3, static_cast<int>(sections.size()) - 1);
  BSpline laws = laws_across(sections, degree);
  // Also for a hub that ends just there: the spline meets the first section's radius to rounding only.
  if (hub_radius <= sections.front().station.radius) laws = extend(laws, {-longest_extension, 1.0});
  const double first = parameter_of_radius(laws, hub_radius);
  std::vector<double> ends{first};
  for (const double knot : laws.knots.breakpoints())
    if (knot > first) ends.push_back(knot);
  BladeAreas sum;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const BladeAreas part = integrate(laws, {ends[i], ends[i + 1]});
    sum = {sum.expanded + part.expanded, sum.developed + part.developed, sum.projected + part.projected};
  }
  return sum;
}

double disc_area(double diameter) {
  return 0.25 * std::numbers::pi * diameter * diameter;
}

}  // namespace isorim::geometry
