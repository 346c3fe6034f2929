#include "geometry/topology/duplicate_faces.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/topology/edge_curve.h"
#include "geometry/topology/shape_loops.h"

namespace isorim::geometry {
namespace {

/// An edge and the surface that it runs on.
struct FaceEdge {
  const NurbsSurface<3>* surface = nullptr;
  EdgeCurve curve;
};

std::vector<FaceEdge> face_edges(const ShapeLoops& loops, double tolerance) {
  std::vector<FaceEdge> edges;
  for (int k = 0; k < static_cast<int>(loops.size()); ++k) {
    for (const NurbsCurve<2>& pcurve : loops.loop(k).curves) {
      EdgeCurve curve(loops.surface(k), pcurve);
      if (curve.diagonal() > tolerance) edges.push_back({&loops.surface(k), std::move(curve)});
    }
  }
  return edges;
}

/// Into the kept part, which lies on the left of the loop seen along the natural normal.
Vector3 inward(const LiftedJet& jet) {
  return jet.normal.cross(jet.tangent).normalized();
}

/// A point of the face beside its edge, at about a fiftieth of the edge's length.
Point3 beside(const FaceEdge& edge, const LiftedJet& jet) {
  const SurfaceJet<3> at = evaluate_jet(*edge.surface, jet.uv);
  // The step in the parameters whose image is the wanted one, by the metric of the surface.
  const Vector3 wanted = 0.02 * edge.curve.length() * inward(jet);
  Eigen::Matrix2d metric;
  metric << at.du.dot(at.du), at.du.dot(at.dv), at.du.dot(at.dv), at.dv.dot(at.dv);
  const Vector2 right(at.du.dot(wanted), at.dv.dot(wanted));
  const double determinant = metric(0, 0) * metric(1, 1) - metric(0, 1) * metric(1, 0);
  const Vector2 step((metric(1, 1) * right[0] - metric(0, 1) * right[1]) / determinant,
                     (metric(0, 0) * right[1] - metric(1, 0) * right[0]) / determinant);
  return evaluate(*edge.surface, Point2(jet.uv + step));
}

/// Every edge of one runs along an edge of the other, the face on the same side.
bool is_covered(const std::vector<FaceEdge>& own, const std::vector<FaceEdge>& others, double tolerance) {
  for (const FaceEdge& edge : own) {
    const LiftedJet jet = edge.curve.jet(edge.curve.domain().middle());
    const auto runs_along = [&](const FaceEdge& other) {
      const std::optional<EdgeCurve::Foot> foot = other.curve.nearest(jet.point, other.curve.domain(), tolerance);
      return foot && inward(other.curve.jet(foot->t)).dot(inward(jet)) > 0.999 &&
             closest_point(*other.surface, beside(edge, jet)).distance <= 10.0 * tolerance;
    };
    if (std::ranges::none_of(others, runs_along)) return false;
  }
  return !own.empty();
}

}  // namespace

bool is_same_face(const Patch<3>& a, const Patch<3>& b, double tolerance) {
  const ShapeLoops loops_a(a.shape);
  const ShapeLoops loops_b(b.shape);
  const std::vector<FaceEdge> edges_a = face_edges(loops_a, tolerance);
  const std::vector<FaceEdge> edges_b = face_edges(loops_b, tolerance);
  return is_covered(edges_a, edges_b, tolerance) && is_covered(edges_b, edges_a, tolerance);
}

}  // namespace isorim::geometry
