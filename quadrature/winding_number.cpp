#include "quadrature/winding_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "geometry/bezier/subdivision.h"

namespace isorim::quadrature {

namespace {

using geometry::Point2;
using geometry::Vector2;
using Net = std::span<const double>;

Vector2 seen_from(const Point2& place, Net net, std::size_t point) {
  return Vector2(net[3 * point], net[3 * point + 1]) / net[3 * point + 2] - place;
}

/// The angle that a curve subtends.
double angle_of(Net net, const Point2& place, int depth) {
  constexpr int most_bisections = 50;
  const std::size_t count = net.size() / 3;
  const Vector2 first = seen_from(place, net, 0);
  const Vector2 last = seen_from(place, net, count - 1);
  Vector2 middle = Vector2::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2 ray = seen_from(place, net, i);
    middle += ray / std::max(ray.norm(), 1e-300);
  }
  bool is_narrow = true;
  for (std::size_t i = 0; i < count; ++i) is_narrow = is_narrow && seen_from(place, net, i).dot(middle) > 0.0;
  if (is_narrow || depth == most_bisections)
    return std::atan2(first[0] * last[1] - first[1] * last[0], first.dot(last));
  const std::array<int, 1> degree{static_cast<int>(count) - 1};
  const auto [lower, upper] = geometry::subdivide(net, 3, degree, 0);
  return angle_of(lower, place, depth + 1) + angle_of(upper, place, depth + 1);
}

}  // namespace

double winding_number(const geometry::TrimmedRegion& region, const Point2& place) {
  double angle = 0.0;
  for (const geometry::HomogeneousPoints<2>& curve : region.curves)
    angle += angle_of({curve.data(), static_cast<std::size_t>(curve.size())}, place, 0);
  return angle / (2.0 * std::numbers::pi);
}

}  // namespace isorim::quadrature
