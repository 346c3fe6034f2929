#include "geometry/shapes/curves.h"

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"

namespace isorim::geometry {
namespace {

constexpr double half_pi = 0.5 * std::numbers::pi;
constexpr double two_pi = 2.0 * std::numbers::pi;
/// Angles that differ by less are the same: a few roundings of a full turn.
constexpr double angle_rounding = 1e-14;

AffineMap<2> ellipse_map(const Vector2& radii, const Point2& centre, double rotation) {
  const CosineSine turn = cosine_sine(rotation);
  AffineMap<2> map;
  map.linear << turn.cosine * radii.x(), -turn.sine * radii.y(), turn.sine * radii.x(), turn.cosine * radii.y();
  map.translation = centre;
  return map;
}

NurbsCurve<2> checked_ellipse_arc(const char* shape, const Vector2& radii, const Point2& centre, double rotation,
                                  double from, double to) {
  checks::positive(shape, "radii", radii);
  checks::finite(shape, "centre", centre);
  checks::finite(shape, "rotation", rotation);
  return transform(unit_arc(from, to), ellipse_map(radii, centre, rotation));
}

NurbsCurve<2> checked_circular_arc(const char* shape, double radius, const Point2& centre, double from, double to) {
  checks::positive(shape, "radius", radius);
  checks::finite(shape, "centre", centre);
  return transform(unit_arc(from, to), ellipse_map(Vector2(radius, radius), centre, 0.0));
}

}  // namespace

CosineSine cosine_sine(double angle) {
  const double quarters = std::round(angle / half_pi);
  if (std::abs(angle - quarters * half_pi) <= angle_rounding * std::max(1.0, std::abs(quarters))) {
    switch (static_cast<int>(std::fmod(std::fmod(quarters, 4.0) + 4.0, 4.0))) {
      case 0:
        return {1.0, 0.0};
      case 1:
        return {0.0, 1.0};
      case 2:
        return {-1.0, 0.0};
      default:
        return {0.0, -1.0};
    }
  }
  return {std::cos(angle), std::sin(angle)};
}

NurbsCurve<2> unit_arc(double from, double to) {
  checks::finite("arc", "from", from);
  checks::finite("arc", "to", to);
  const double sweep = to - from;
  if (std::abs(sweep) <= angle_rounding) {
    throw GeometryError(fmt::format("arc: the angles from = {} and to = {} are the same", from, to));
  }
  if (std::abs(sweep) > two_pi * (1.0 + angle_rounding)) {
    throw GeometryError(
        fmt::format("arc: from = {} to = {} is {} radians, more than a full turn (2 pi)", from, to, std::abs(sweep)));
  }
  const bool full = std::abs(sweep) >= two_pi * (1.0 - angle_rounding);
  const int pieces = full ? 4 : std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / half_pi - angle_rounding)));
  const double piece = full ? std::copysign(half_pi, sweep) : sweep / pieces;
  // cos(pi / 4) itself may round to the neighbour of sqrt(2) / 2.
  const bool quarter = std::abs(std::abs(piece) - half_pi) <= angle_rounding;
  const double weight = quarter ? 0.5 * std::numbers::sqrt2 : std::cos(0.5 * piece);

  HomogeneousPoints<2> net(3, 2 * pieces + 1);
  std::vector<double> knots{0.0};
  for (int i = 0; i <= pieces; ++i) {
    const CosineSine end = cosine_sine(i == pieces && !full ? to : from + i * piece);
    net.col(2 * i) << end.cosine, end.sine, 1.0;
    knots.insert(knots.end(), 2, static_cast<double>(i) / pieces);
  }
  if (full) net.col(2 * pieces) = net.col(0);
  knots.push_back(1.0);
  for (int i = 0; i < pieces; ++i) {
    // The tangents' intersection lies at 1 / weight times the middle direction; homogeneous, the middle direction
    // itself: (E0 + E1) / 2 over its length, which is the weight.
    const Vector2 sum = 0.5 * (net.col(2 * i) + net.col(2 * i + 2)).head<2>();
    net.col(2 * i + 1) << sum / weight, weight;
  }
  return {KnotVector(2, std::move(knots)), std::move(net)};
}

NurbsCurve<2> circular_arc(double radius, const Point2& centre, double from, double to) {
  return checked_circular_arc("circular arc", radius, centre, from, to);
}

NurbsCurve<2> circle_curve(double radius, const Point2& centre) {
  return checked_circular_arc("circle", radius, centre, 0.0, two_pi);
}

NurbsCurve<2> ellipse_arc(const Vector2& radii, const Point2& centre, double rotation, double from, double to) {
  return checked_ellipse_arc("ellipse arc", radii, centre, rotation, from, to);
}

NurbsCurve<2> ellipse_curve(const Vector2& radii, const Point2& centre, double rotation) {
  return checked_ellipse_arc("ellipse", radii, centre, rotation, 0.0, two_pi);
}

template <int Dim>
NurbsCurve<Dim> line_segment(const Point<Dim>& from, const Point<Dim>& to) {
  checks::finite("line segment", "from", from);
  checks::finite("line segment", "to", to);
  if (from == to) {
    throw GeometryError(fmt::format("line segment: both ends are ({})", fmt::join(from.begin(), from.end(), ", ")));
  }
  Points<Dim> points(Dim, 2);
  points << from, to;
  return NurbsCurve<Dim>::from_points(KnotVector::bezier(1), points);
}

template <int Dim>
NurbsCurve<Dim> polyline(const Points<Dim>& points) {
  checks::finite("polyline", "points", points);
  if (points.cols() < 2) {
    throw GeometryError(fmt::format("polyline: {} points, at least 2 are needed", points.cols()));
  }
  for (Eigen::Index i = 0; i + 1 < points.cols(); ++i) {
    if (points.col(i) == points.col(i + 1)) {
      const Point<Dim> point = points.col(i);
      throw GeometryError(fmt::format("polyline: points {} and {} are both ({})", i, i + 1,
                                      fmt::join(point.begin(), point.end(), ", ")));
    }
  }
  return NurbsCurve<Dim>::from_points(KnotVector::clamped_uniform(1, static_cast<int>(points.cols()) - 1), points);
}

template NurbsCurve<2> line_segment<2>(const Point<2>&, const Point<2>&);
template NurbsCurve<3> line_segment<3>(const Point<3>&, const Point<3>&);
template NurbsCurve<2> polyline<2>(const Points<2>&);
template NurbsCurve<3> polyline<3>(const Points<3>&);

}  // namespace isorim::geometry
