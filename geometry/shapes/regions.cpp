#include "geometry/shapes/regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/curves.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {
namespace {

double doubled_signed_area(const Points<2>& points) {
  double sum = 0.0;
  const Point2 origin = points.col(0);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector2 a = points.col(i) - origin;
    const Vector2 b = points.col((i + 1) % points.cols()) - origin;
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// The arc of a part, counter-clockwise; refuses a full turn.
NurbsCurve<2> open_arc(const char* shape, const EllipsePart& part) {
  checks::finite(shape, "from", part.from);
  checks::finite(shape, "to", part.to);
  const auto [low, high] = std::minmax(part.from, part.to);
  if (high - low >= 2.0 * std::numbers::pi * (1.0 - 1e-14)) {
    throw GeometryError(
        fmt::format("{}: from = {} to = {} is a full turn, an open arc is expected", shape, part.from, part.to));
  }
  return ellipse_arc(part.radii, part.centre, part.rotation, low, high);
}

}  // namespace

Boundary<2> disc(double radius, const Point2& centre) {
  return {{{"circle", circle_curve(radius, centre)}}};
}

Boundary<2> elliptic_disc(const Vector2& radii, const Point2& centre, double rotation) {
  return {{{"ellipse", ellipse_curve(radii, centre, rotation)}}};
}

Boundary<2> rectangle(const Vector2& size, const Point2& corner) {
  checks::positive("rectangle", "size", size);
  checks::finite("rectangle", "corner", corner);
  const Point2 a = corner;
  const Point2 b = corner + Vector2(size.x(), 0.0);
  const Point2 c = corner + size;
  const Point2 d = corner + Vector2(0.0, size.y());
  return {{{"bottom", line_segment<2>(a, b)},
           {"right", line_segment<2>(b, c)},
           {"top", line_segment<2>(c, d)},
           {"left", line_segment<2>(d, a)}}};
}

Boundary<2> polygon(const Points<2>& points) {
  checks::finite("polygon", "points", points);
  const bool repeated = points.cols() > 1 && points.col(0) == points.col(points.cols() - 1);
  const Points<2> corners = points.leftCols(points.cols() - (repeated ? 1 : 0));
  const Eigen::Index count = corners.cols();
  if (count < 3) throw GeometryError(fmt::format("polygon: {} distinct points, at least 3 are needed", count));
  const int orientation = doubled_signed_area(corners) < 0.0 ? -1 : 1;
  Boundary<2> result;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Point2 from = corners.col(i);
    const Point2 to = corners.col((i + 1) % count);
    if (from == to) {
      throw GeometryError(
          fmt::format("polygon: points {} and {} are both ({}, {})", i, (i + 1) % count, from.x(), from.y()));
    }
    const NurbsCurve<2> side = orientation > 0 ? line_segment<2>(from, to) : line_segment<2>(to, from);
    result.patches.push_back({fmt::format("side_{}", i + 1), side});
  }
  return result;
}

Boundary<2> regular_polygon(int sides, double circumradius, const Point2& centre, double rotation) {
  if (sides < 3) throw GeometryError(fmt::format("regular polygon: sides is {}, it must be at least 3", sides));
  checks::positive("regular polygon", "circumradius", circumradius);
  checks::finite("regular polygon", "centre", centre);
  checks::finite("regular polygon", "rotation", rotation);
  Points<2> corners(2, sides);
  for (int i = 0; i < sides; ++i) {
    const CosineSine angle = cosine_sine(rotation + i * 2.0 * std::numbers::pi / sides);
    corners.col(i) = centre + circumradius * Vector2(angle.cosine, angle.sine);
  }
  return polygon(corners);
}

Boundary<2> ellipse_segment(const EllipsePart& part) {
  NurbsCurve<2> arc = open_arc("ellipse segment", part);
  const Point2 first = evaluate(arc, 0.0);
  const Point2 last = evaluate(arc, 1.0);
  return {{{"arc", std::move(arc)}, {"chord", line_segment<2>(last, first)}}};
}

Boundary<2> ellipse_sector(const EllipsePart& part) {
  NurbsCurve<2> arc = open_arc("ellipse sector", part);
  const Point2 first = evaluate(arc, 0.0);
  const Point2 last = evaluate(arc, 1.0);
  return {{{"arc", std::move(arc)},
           {"last_radius", line_segment<2>(last, part.centre)},
           {"first_radius", line_segment<2>(part.centre, first)}}};
}

Boundary<2> region(std::span<const std::vector<NurbsCurve<2>>> loops) {
  if (loops.empty()) throw GeometryError("region: there are no loops");
  Boundary<2> all;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::string name = fmt::format("loop_{}", i + 1);
    if (loops[i].empty()) throw GeometryError(fmt::format("region: {} has no curves", name));
    Boundary<2> loop;
    for (std::size_t k = 0; k < loops[i].size(); ++k) {
      loop.patches.push_back({loops[i].size() == 1 ? name : fmt::format("{}_curve_{}", name, k + 1), loops[i][k]});
    }
    try {
      require_closed(orient(loop));
    } catch (GeometryError& error) {
      error.add_context(fmt::format("region: {}", name));
      throw;
    }
    all.patches.insert(all.patches.end(), loop.patches.begin(), loop.patches.end());
  }
  return orient(all).boundary;
}

}  // namespace isorim::geometry
