#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geometry/tspline/tspline.h"

/// Local refinement that leaves the surface as it is (Scott, Li, Sederberg & Hughes, CMAME 213-216, 2012).
namespace isorim::geometry {

/// A new edge across a face from side to side: where direction d has the value `knot`, strictly inside the face.
struct FaceCut {
  int face = 0;
  Direction direction = Direction::u;
  double knot = 0.0;
};

/// The T-mesh with these cuts, and with the fewest further ones found that make it fit for use: T-junctions that face
/// each other are joined; it is analysis-suitable; and its extended mesh holds that of `mesh`, so the spline space of
/// `mesh` lies in its own (Li & Scott, M3AS 24, 2014, theorem 6.8; Bressan, Buffa & Sangalli, CAGD 39, 2015, for all
/// degrees).
///
/// Throws GeometryError if `mesh` is not analysis-suitable, naming a pair of T-junctions, for a face that does not
/// exist and a knot outside its face.
TMesh refine(const TMesh& mesh, std::span<const FaceCut> cuts);

/// The same surface over the refined T-mesh. Control points are convex combinations of the old ones: products of the
/// discrete B-splines of Cohen, Lyche & Riesenfeld (CGIP 14, 1980), which are what the dual functionals of the new
/// functions give for the old ones. Equal weights stay equal bit for bit. Errors as above.
TSpline refine(const TSpline& surface, std::span<const FaceCut> cuts);

/// Which edges divide a face.
enum class Bisection { u, v, both };

/// Cuts through the middle of these faces. Faces without width in a direction are not divided in it. Throws
/// GeometryError for a face that is too thin for another number in its middle.
std::vector<FaceCut> bisections(const TMesh& mesh, std::span<const int> faces, Bisection how);

/// The faces of which a part lies inside, by 5 x 5 points within each cell of the Bézier mesh.
std::vector<int> faces_where(const TSpline& surface,
                             const std::function<bool(const Point3& x, const Point2& uv)>& inside);

}  // namespace isorim::geometry
