#include "geometry/topology/duplicate_faces.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/topology/edge_curve.h"

namespace isorim::geometry {
namespace {

std::vector<EdgeCurve> edge_curves(const Patch<3>& patch, double tolerance) {
  std::vector<EdgeCurve> curves;
  for (const TrimLoop& loop : trim_loops(patch.shape)) {
    for (const NurbsCurve<2>& pcurve : loop.curves) {
      EdgeCurve curve(surface_of(patch.shape), pcurve);
      if (curve.diagonal() > tolerance) curves.push_back(std::move(curve));
    }
  }
  return curves;
}

/// Into the kept part, which lies on the left of the loop seen along the natural normal.
Vector3 inward(const LiftedJet& jet) {
  return jet.normal.cross(jet.tangent).normalized();
}

/// A point of the patch beside its edge, at about a fiftieth of the edge's length.
Point3 beside(const Patch<3>& patch, const EdgeCurve& edge, const LiftedJet& jet) {
  const NurbsSurface<3>& surface = surface_of(patch.shape);
  const SurfaceJet<3> at = evaluate_jet(surface, jet.uv);
  // The step in the parameters whose image is the wanted one, by the metric of the surface.
  const Vector3 wanted = 0.02 * edge.length() * inward(jet);
  Eigen::Matrix2d metric;
  metric << at.du.dot(at.du), at.du.dot(at.dv), at.du.dot(at.dv), at.dv.dot(at.dv);
  const Vector2 right(at.du.dot(wanted), at.dv.dot(wanted));
  const double determinant = metric(0, 0) * metric(1, 1) - metric(0, 1) * metric(1, 0);
  const Vector2 step((metric(1, 1) * right[0] - metric(0, 1) * right[1]) / determinant,
                     (metric(0, 0) * right[1] - metric(1, 0) * right[0]) / determinant);
  return evaluate(surface, Point2(jet.uv + step));
}

bool is_covered(const Patch<3>& a, const Patch<3>& b, double tolerance) {
  const std::vector<EdgeCurve> own = edge_curves(a, tolerance);
  const std::vector<EdgeCurve> others = edge_curves(b, tolerance);
  for (const EdgeCurve& edge : own) {
    const LiftedJet jet = edge.jet(edge.domain().middle());
    const auto runs_along = [&](const EdgeCurve& other) {
      const std::optional<EdgeCurve::Foot> foot = other.nearest(jet.point, other.domain(), tolerance);
      return foot && inward(other.jet(foot->t)).dot(inward(jet)) > 0.999;
    };
    if (std::ranges::none_of(others, runs_along)) return false;
    const Point3 inner = beside(a, edge, jet);
    if (!(closest_point(surface_of(b.shape), inner).distance <= 10.0 * tolerance)) return false;
  }
  return !own.empty();
}

}  // namespace

bool is_same_face(const Patch<3>& a, const Patch<3>& b, double tolerance) {
  return is_covered(a, b, tolerance) && is_covered(b, a, tolerance);
}

}  // namespace isorim::geometry
