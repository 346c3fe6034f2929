#include "geometry/tessellation/edge_division.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "geometry/topology/edge_curve.h"

namespace isorim::geometry {
namespace {

double distance_from_segment(const Point3& point, const Point3& from, const Point3& to) {
  const Vector3 direction = to - from;
  const double squared_length = direction.squaredNorm();
  const double part = squared_length > 0.0 ? std::clamp((point - from).dot(direction) / squared_length, 0.0, 1.0) : 0.0;
  return (point - from - part * direction).norm();
}

/// Parameters along a curve at which it is divided.
class CurveDivider {
 public:
  CurveDivider(const EdgeCurve& curve, double tolerance)
      : curve_(curve), tolerance_(tolerance), breakpoints_(curve.breakpoints()) {}

  /// Rising, the ends of the domain among them.
  std::vector<double> divide(Interval domain, const std::vector<double>& breakpoints, bool is_closed) const {
    std::vector<double> ends{domain.first};
    for (const double u : breakpoints)
      if (u > domain.first && u < domain.last) ends.push_back(u);
    ends.push_back(domain.last);
    if (!is_closed && bulge(domain.first, domain.last) <= 1e-10 * curve_.diagonal()) return {domain.first, domain.last};
    const int parts = is_closed && ends.size() < 4 ? 4 : 2;
    std::vector<double> parameters;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      for (int k = 0; k < parts; ++k)
        bisect(std::lerp(ends[i], ends[i + 1], double(k) / parts),
               std::lerp(ends[i], ends[i + 1], double(k + 1) / parts), 0, parameters);
    parameters.push_back(domain.last);
    return parameters;
  }

 private:
  static constexpr int max_depth = 20;

  /// The largest distance from the chord at a few places of each span.
  double bulge(double from, double to) const {
    const Point3 start = curve_.at(from);
    const Point3 end = curve_.at(to);
    double largest = 0.0;
    auto next = std::ranges::upper_bound(breakpoints_, from);
    for (double left = from; left < to;) {
      const double right = next != breakpoints_.end() && *next < to ? *next++ : to;
      for (const double part : {0.18, 0.36, 0.5, 0.64, 0.82})
        largest = std::max(largest, distance_from_segment(curve_.at(std::lerp(left, right, part)), start, end));
      left = right;
    }
    return largest;
  }

  void bisect(double from, double to, int depth, std::vector<double>& parameters) const {
    if (depth < max_depth && bulge(from, to) > tolerance_) {
      const double middle = 0.5 * (from + to);
      bisect(from, middle, depth + 1, parameters);
      bisect(middle, to, depth + 1, parameters);
      return;
    }
    parameters.push_back(from);
  }

  const EdgeCurve& curve_;
  double tolerance_;
  std::vector<double> breakpoints_;
};

/// Where the other use comes nearest to the points, in the direction of the edge; the ends are its own.
std::vector<double> parameters_on(const EdgeUse& use, const EdgeCurve& curve, const std::vector<Point3>& points) {
  const double last = use.forward ? use.domain.last : use.domain.first;
  std::vector<double> parameters{use.forward ? use.domain.first : use.domain.last};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double before = parameters.back();
    const Interval rest{std::min(before, last), std::max(before, last)};
    const auto foot = curve.nearest(points[i], rest, std::numeric_limits<double>::max());
    double t = foot ? foot->t : before;
    // What is nearest to an end is put a little beside it, in the order of the points.
    if (t == before || t == last) t = std::lerp(before, last, 1.0 / static_cast<double>(points.size() - i));
    parameters.push_back(t);
  }
  parameters.push_back(last);
  return parameters;
}

DividedUse divided(const EdgeUse& use, std::vector<double> parameters, std::vector<int> vertices) {
  if (!use.forward) {
    std::ranges::reverse(parameters);
    std::ranges::reverse(vertices);
  }
  return {use.domain, std::move(parameters), std::move(vertices)};
}

}  // namespace

DividedEdges divide_edges(const OrientedBoundary<3>& oriented, const std::vector<ShapeLoops>& loops, double tolerance,
                          const std::vector<double>& refinement) {
  DividedEdges result;
  result.vertices = oriented.topology.vertices;
  for (const BoundaryEdge& edge : oriented.topology.edges) {
    const auto curve_of = [&](const EdgeUse& use) {
      const ShapeLoops& shape = loops[static_cast<std::size_t>(use.patch)];
      return EdgeCurve(shape.surface(use.loop), shape.curve(use.loop, use.curve));
    };
    const double factor = std::max(refinement[static_cast<std::size_t>(edge.first.patch)],
                                   refinement[static_cast<std::size_t>(edge.second.patch)]);
    const EdgeCurve first = curve_of(edge.first);
    const NurbsCurve<2>& pcurve =
        loops[static_cast<std::size_t>(edge.first.patch)].curve(edge.first.loop, edge.first.curve);
    std::vector<double> parameters = CurveDivider(first, 0.5 * tolerance / factor)
                                         .divide(edge.first.domain, pcurve.knots().breakpoints(), edge.from == edge.to);
    if (!edge.first.forward) std::ranges::reverse(parameters);
    std::vector<int> vertices{edge.from};
    std::vector<Point3> points{result.vertices[static_cast<std::size_t>(edge.from)]};
    for (std::size_t i = 1; i + 1 < parameters.size(); ++i) {
      points.push_back(first.at(parameters[i]));
      vertices.push_back(static_cast<int>(result.vertices.size()));
      result.vertices.push_back(points.back());
    }
    vertices.push_back(edge.to);
    points.push_back(result.vertices[static_cast<std::size_t>(edge.to)]);
    const std::vector<double> others = parameters_on(edge.second, curve_of(edge.second), points);
    const auto key = [](const EdgeUse& use) { return CurveKey{use.patch, use.loop, use.curve}; };
    result.uses[key(edge.first)].push_back(divided(edge.first, std::move(parameters), vertices));
    result.uses[key(edge.second)].push_back(divided(edge.second, others, vertices));
  }
  for (auto& [curve, uses] : result.uses)
    std::ranges::sort(uses, {}, [](const DividedUse& use) { return use.domain.first; });
  return result;
}

}  // namespace isorim::geometry
