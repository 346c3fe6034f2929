#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "geometry/errors.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/intersection/plane_image.h"
#include "geometry/intersection/tool_caps.h"
#include "geometry/trimming/face_locator.h"

namespace isorim::geometry {
namespace {

/// Loops with less content, relative to the square of the size, are edges that run back on themselves.
constexpr double smallest_area = 1e-15;

struct PlaneBox {
  Point2 lower = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 upper = Point2::Constant(-std::numeric_limits<double>::infinity());

  void add(const TrimLoop& loop) {
    for (const NurbsCurve<2>& curve : loop.curves) {
      const Points<2> points = curve.control_points();
      lower = lower.cwiseMin(points.rowwise().minCoeff());
      upper = upper.cwiseMax(points.rowwise().maxCoeff());
    }
  }
};

/// The rectangle of the plane around the loops; its parameters are the coordinates of the plane.
NurbsSurface<3> plane_patch(const PlaneFrame& frame, const std::vector<TrimLoop>& loops) {
  PlaneBox box;
  for (const TrimLoop& loop : loops) box.add(loop);
  const Vector2 margin = 0.02 * (box.upper - box.lower);
  const Point2 low = box.lower - margin;
  const Point2 high = box.upper + margin;
  Points<3> net(3, 4);
  for (Eigen::Index k = 0; k < 4; ++k)
    net.col(k) = frame.to_space({(k % 2 == 0 ? low : high).x(), (k < 2 ? low : high).y()});
  return NurbsSurface<3>::from_points(KnotVector(1, {low.x(), low.x(), high.x(), high.x()}),
                                      KnotVector(1, {low.y(), low.y(), high.y(), high.y()}), net);
}

bool lies_in(const TrimLoop& hole, const FaceLocator& outer) {
  for (const NurbsCurve<2>& curve : hole.curves)
    for (const double t : {0.5, 0.21}) {
      const Interval domain = curve.domain();
      const std::optional<int> turns = outer.winding_number(evaluate(curve, domain.first + t * domain.length()), 1e-9);
      if (turns) return *turns != 0;
    }
  return false;
}

}  // namespace

PlaneFrame cap_frame(const PlaneTool& plane, const Point3& near) {
  PlaneFrame frame = plane_frame(plane.point, plane.normal);
  frame.origin = near - (near - plane.point).dot(frame.normal) * frame.normal;
  return frame;
}

std::vector<TrimLoop> plane_loops(const PlaneFrame& frame, const std::vector<CapEdge>& edges, double size,
                                  const ClipOptions& options) {
  std::vector<NurbsCurve<2>> curves;
  for (const CapEdge& edge : edges) {
    const std::vector<NurbsCurve<2>> pieces = plane_image(edge.surface, edge.curve, frame, size);
    curves.insert(curves.end(), pieces.begin(), pieces.end());
  }
  std::vector<TrimLoop> loops =
      chain_directed_curves(curves, Vector2::Ones(), options.gap_tolerance * size, 1e-12 * size);
  std::erase_if(loops,
                [&](const TrimLoop& loop) { return std::abs(doubled_area(loop)) <= smallest_area * size * size; });
  return loops;
}

std::vector<Patch<3>> plane_caps(const PlaneFrame& frame, const std::vector<TrimLoop>& loops) {
  struct Part {
    double area;
    std::vector<TrimLoop> loops;
    FaceLocator locator;
  };
  std::vector<Part> parts;
  std::vector<TrimLoop> holes;
  for (const TrimLoop& loop : loops) {
    const double area = doubled_area(loop);
    if (area > 0.0) {
      parts.push_back({area, {loop}, FaceLocator(std::span<const TrimLoop>(&loop, 1))});
    } else {
      holes.push_back(loop);
    }
  }
  // The smallest loop around a hole is its own.
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.area < b.area; });
  for (const TrimLoop& hole : holes) {
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return lies_in(hole, p.locator); });
    if (part == parts.end())
      throw GeometryError("clip: a hole of the section lies in no outer loop; are the solid's normals consistent?");
    part->loops.push_back(hole);
  }
  std::vector<Patch<3>> caps;
  for (Part& part : parts) {
    NurbsSurface<3> surface = plane_patch(frame, part.loops);
    caps.push_back({"cap", TrimmedSurface(std::move(surface), std::move(part.loops)), 1});
  }
  return caps;
}

}  // namespace isorim::geometry
