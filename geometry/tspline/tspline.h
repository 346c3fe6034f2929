#pragma once

#include <span>
#include <vector>

#include "geometry/nurbs/surface.h"
#include "geometry/tspline/extracted_surface.h"
#include "geometry/tspline/tmesh.h"

namespace isorim::geometry {

/// A T-spline surface S = sum w_k N_k P_k / sum w_k N_k, N_k the product of the B-splines on the local knot vectors of
/// the k-th anchor of its T-mesh; valid from construction on. The natural normal is S_u x S_v.
class TSpline {
 public:
  /// homogeneous: 4 x mesh.function_count(), columns (w x, w y, w z, w) in the order of the mesh's anchors. Throws
  /// GeometryError, naming the control point and the place of its anchor, for a wrong number of them, a weight that is
  /// not positive and a number that is not finite.
  TSpline(TMesh mesh, HomogeneousPoints<3> homogeneous);
  static TSpline from_points(TMesh mesh, const Points<3>& points, std::span<const double> weights = {});
  /// The same surface, exactly: same knots, same control points in the same order. Any multiplicities, clamped or not.
  explicit TSpline(const NurbsSurface<3>& surface);

  const TMesh& mesh() const { return mesh_; }
  const HomogeneousPoints<3>& homogeneous() const { return homogeneous_; }
  /// 3 x function_count() Cartesian control points.
  Points<3> control_points() const;
  Eigen::VectorXd weights() const { return homogeneous_.row(3).transpose(); }

 private:
  TMesh mesh_;
  HomogeneousPoints<3> homogeneous_;
};

/// The value, straight from the local knot vectors. Limits at knots as for NURBS: from the right, at the domain's end
/// from the left; beyond the domain the nearest piece continues. Costs a few function values for each function on the
/// face of uv; whoever needs many points extracts the surface.
Point3 evaluate(const TSpline& surface, const Point2& uv);
SurfaceJet<3> evaluate_jet(const TSpline& surface, const Point2& uv);

/// Values at uv of all functions N_k, not weighted; limits as above.
Eigen::VectorXd function_values(const TMesh& mesh, const Point2& uv);

/// A map with negative determinant turns the natural normal round.
TSpline transform(const TSpline& surface, const AffineMap<3>& map);

/// A rectangle on which every function is one polynomial.
struct BezierCell {
  int face = 0;
  std::array<Interval, 2> domain;
};

/// The Bézier mesh: each face that has area, cut by the knot lines of all functions that live on it; face by face from
/// the lowest (v, then u), u fastest within a face, so for a tensor product in the order of its spans. For an
/// analysis-suitable mesh these are the rectangles of the mesh with its face extensions; for others a face is cut from
/// side to side even where fewer cuts would do.
std::vector<BezierCell> bezier_mesh(const TMesh& mesh);

/// The elements of the Bézier mesh in its order, each with the functions that live on it (increasing) and their
/// Bernstein coefficients: polar forms of the pieces, which is what knot insertion gives (Scott, Borden, Verhoosel,
/// Sederberg & Hughes, IJNME 88, 2011, section 4). Exact but for rounding, without cancellation.
std::vector<ExtractionElement> extraction_elements(const TMesh& mesh);
ExtractedSurface extract(const TSpline& surface);

}  // namespace isorim::geometry
