#include "geometry/propeller/mould_lines.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "geometry/intersection/section_spline.h"
#include "geometry/trimming/lifted_curve.h"

namespace isorim::geometry {
namespace {

/// The part of the domain of u in which the farthest point is looked for.
constexpr Interval nose{0.2, 0.8};
/// Parameters this near to the domain's ends lie on the trailing edge.
constexpr double edge_tolerance = 1e-9;
/// Of the hub's radius.
constexpr double on_hub = 1e-6;

/// A point of the section on the blade.
struct Place {
  Point2 point;
  /// 0 to 1.
  double u = 0.0;
};

std::vector<Place> places_on(const PlaneSection& section, const SurfaceShape& shape, int blade, double sag) {
  const Interval domain = surface_of(shape).knots_u().domain();
  std::vector<Place> places;
  const auto add = [&](const SectionCurve& curve) {
    for (const SectionSample& sample : sample_section(curve, section.frame, sag))
      if (sample.place.patch == blade)
        places.push_back({sample.plane, (sample.place.uv.x() - domain.first) / domain.length()});
  };
  for (const SectionLoop& loop : section.loops) add(loop.curve);
  for (const SectionCurve& chain : section.chains) add(chain);
  return places;
}

/// The first of those that `admits` takes that is farthest from a point.
template <class Admits>
std::optional<Point2> farthest(const std::vector<Place>& places, const Point2& from, const Admits& admits) {
  std::optional<Point2> best;
  double largest = -1.0;
  for (const Place& place : places) {
    const double distance = (place.point - from).norm();
    if (!admits(place) || distance <= largest) continue;
    largest = distance;
    best = place.point;
  }
  return best;
}

/// The largest value of f on [first, last], near the best of the samples, by golden sections.
double largest_value(const std::function<double(double)>& f, Interval domain) {
  constexpr int samples = 400;
  double best = domain.first;
  for (int i = 1; i <= samples; ++i) {
    const double t = domain.first + domain.length() * i / samples;
    if (f(t) > f(best)) best = t;
  }
  const double step = domain.length() / samples;
  double low = std::max(domain.first, best - step);
  double high = std::min(domain.last, best + step);
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  while (high - low > 1e-9 * step) {
    const double left = high - ratio * (high - low);
    const double right = low + ratio * (high - low);
    if (f(left) > f(right))
      high = right;
    else
      low = left;
  }
  return std::max({f(best), f(low), f(high), f(0.5 * (low + high))});
}

}  // namespace

std::optional<PartingLine> parting_line(const PlaneSection& section, const Boundary<3>& boundary, int blade,
                                        double sag) {
  const std::vector<Place> places =
      places_on(section, boundary.patches.at(static_cast<std::size_t>(blade)).shape, blade, sag);
  if (places.empty()) return std::nullopt;
  const auto is_trailing = [](const Place& place) {
    return place.u <= edge_tolerance || place.u >= 1.0 - edge_tolerance;
  };
  const auto is_nose = [](const Place& place) { return nose.first < place.u && place.u < nose.last; };
  const auto any = [](const Place&) { return true; };
  const auto edge = std::ranges::find_if(places, is_trailing);
  std::optional<Point2> to = farthest(places, Point2::Zero(), is_nose);
  if (edge == places.end() && !to) to = farthest(places, Point2::Zero(), any);
  const Point2 from = edge != places.end() ? edge->point : *farthest(places, *to, any);
  if (!to) to = farthest(places, from, any);
  if (from == *to) return std::nullopt;
  return PartingLine{from, *to};
}

std::optional<double> hub_half_width(double radius, double height) {
  if (std::abs(height) >= radius) return std::nullopt;
  return std::sqrt((radius - height) * (radius + height));
}

std::optional<Interval> root_extent(const SurfaceShape& blade, double radius) {
  const NurbsSurface<3>& surface = surface_of(blade);
  Interval extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const TrimLoop& loop : trim_loops(blade)) {
    for (const NurbsCurve<2>& curve : loop.curves) {
      const Interval domain = curve.domain();
      const auto is_on_hub = [&](double part) {
        const Point3 point = lifted_point(surface, curve, domain.first + part * domain.length());
        return std::abs(std::hypot(point.y(), point.z()) - radius) <= on_hub * radius;
      };
      if (!is_on_hub(0.25) || !is_on_hub(0.5) || !is_on_hub(0.75)) continue;
      const auto x = [&](double t) { return lifted_point(surface, curve, t).x(); };
      extent.last = std::max(extent.last, largest_value(x, domain));
      extent.first = std::min(extent.first, -largest_value([&](double t) { return -x(t); }, domain));
    }
  }
  if (extent.first > extent.last) return std::nullopt;
  return extent;
}

}  // namespace isorim::geometry
