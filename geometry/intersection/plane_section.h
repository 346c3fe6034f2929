#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/trimming/trimmed_surface.h"
#include "geometry/vocabulary.h"

/// Plane sections of boundaries: waterlines, frames, blade sections.
namespace isorim::geometry {

/// A plane with coordinates: (x, y) -> origin + x axis_x + y axis_y. The axes are orthonormal, axis_x x axis_y =
/// normal.
struct PlaneFrame {
  Point3 origin = Point3::Zero();
  Vector3 axis_x = Vector3::UnitX();
  Vector3 axis_y = Vector3::UnitY();
  Vector3 normal = Vector3::UnitZ();

  Point2 to_plane(const Point3& x) const { return {(x - origin).dot(axis_x), (x - origin).dot(axis_y)}; }
  Point3 to_space(const Point2& p) const { return origin + p.x() * axis_x + p.y() * axis_y; }
};

/// The plane through a point. Its origin is the point of the plane nearest to that of space, so in a plane z = constant
/// the coordinates are x and y of space. In other planes axis_x is horizontal (along Z x normal) and axis_y points
/// upwards: the section is seen against the normal. Throws GeometryError if the normal is zero or a number is not
/// finite.
PlaneFrame plane_frame(const Point3& point, const Vector3& normal);

/// A part of a section in one patch: t -> S(c(t)), t in [0, 1].
struct SectionPiece {
  int patch = 0;
  /// Of an extracted surface; -1 otherwise.
  int element = -1;
  /// S: the patch's surface, or the element of an extracted one as a surface over the unit square.
  std::shared_ptr<const NurbsSurface<3>> surface;
  /// c, over [0, 1], in the parameters of `surface`: a few units of rounding off the exact curve F(S(u, v)) = 0.
  NurbsCurve<2> parameters;
};

/// A point of a section: on the patch exactly, on the plane to rounding.
struct SectionPoint {
  Point3 point;
  int patch = 0;
  int element = -1;
  /// In the parameters of the piece's surface.
  Point2 uv;
};

struct SectionPointJet {
  SectionPoint place;
  /// d/dt of the point.
  Vector3 derivative;
};
SectionPointJet evaluate_jet(const SectionPiece& piece, double t);

/// Pieces one after the other, each ending where the next one starts but for the gaps between patches.
struct SectionCurve {
  std::vector<SectionPiece> pieces;
  /// The last piece ends where the first starts.
  bool is_closed = false;
  /// The largest distance between an end and the next start, and where it is.
  double largest_gap = 0.0;
  Point3 largest_gap_place = Point3::Zero();
  /// The pieces in the coordinates of the plane, in the same order (of one piece one curve or several); ends that
  /// differ by more than rounding are joined by straight lines. Isoparametric pieces are exact, others are met to
  /// 4e-15 of the size of the boundary, or of its largest coordinate.
  TrimLoop plane_curves;
};

/// A closed curve that bounds the region in which the plane cuts the solid.
struct SectionLoop {
  SectionCurve curve;
  /// It bounds a hole of the region.
  bool is_hole = false;
  /// Of a hole: the index of the loop around it, -1 if there is none (an open or inconsistent boundary). Of an outer
  /// loop -1.
  int parent = -1;
};

/// A face (or, of an extracted surface, an element) that lies in the plane.
struct CoplanarFace {
  int patch = 0;
  int element = -1;
  /// Its outward normal is that of the plane: the solid lies below it.
  bool looks_along_normal = true;
  /// Its boundary, each loop with the face on the left as seen against the normal of the plane.
  std::vector<SectionCurve> loops;
};

/// What a plane has in common with a boundary.
struct PlaneSection {
  PlaneFrame frame;
  /// Of a closed solid: the boundary of the region in which the plane cuts it (the closure of its limits from both
  /// sides, so faces in the plane belong to it), each loop with the solid on its left as seen against the normal: outer
  /// loops run counter-clockwise in the coordinates of the frame, holes clockwise. Loops may touch themselves and each
  /// other but do not cross: at a double point each branch turns left.
  std::vector<SectionLoop> loops;
  /// What does not close: sections of open boundaries.
  std::vector<SectionCurve> chains;
  /// Along which the boundary touches the plane without crossing it: circles of a torus' top, ridges and valleys.
  std::vector<SectionCurve> touching;
  /// Single points that the plane touches (poles, corners, extrema of edges), on none of the curves above.
  std::vector<SectionPoint> isolated;
  /// Where branches of the section cross: the plane touches the boundary in a saddle.
  std::vector<SectionPoint> double_points;
  std::vector<CoplanarFace> coplanar;
  /// Over all curves.
  double largest_gap = 0.0;
  Point3 largest_gap_place = Point3::Zero();
  /// The section is that of the plane moved by this along its normal, since the plane itself meets the boundary in a
  /// singular point that is no double point: at most 4e-11 of the size. 0 nearly always.
  double shift = 0.0;
  /// What a user should know: open chains, bridged gaps, faces in the plane, the shift.
  std::vector<std::string> messages;

  bool is_empty() const { return loops.empty() && chains.empty() && touching.empty() && isolated.empty(); }
};

struct SectionOptions {
  /// Distances from the plane that count as zero, relative to the diagonal of the boundary's box or, if that is larger,
  /// the largest coordinate: a hundred times rounding.
  double tolerance = 1e-13;
  /// How wide gaps between patches may be, relative to the diagonal. Where a plane meets the edge of two patches
  /// at a small angle the gap between its curves is wider: ends are joined up to a hundred times this, the nearest
  /// first, so that no features are lost.
  double gap_tolerance = 1e-6;
};

/// Cuts one boundary by many planes: what does not depend on the plane is made once. Its functions may be called from
/// several threads at a time.
class PlaneCutter {
 public:
  /// The boundary is oriented (orient()) if it is closed; it need not outlive this.
  explicit PlaneCutter(const Boundary<3>& boundary, const SectionOptions& options = {});
  ~PlaneCutter();
  PlaneCutter(PlaneCutter&&) noexcept;
  PlaneCutter& operator=(PlaneCutter&&) noexcept;

  /// The diagonal of the box of the control points.
  double size() const;

  /// Throws GeometryError, naming the patch and the place, if a patch cannot be cut by the plane or its neighbours.
  PlaneSection section(const PlaneFrame& plane) const;

 private:
  class Faces;
  std::unique_ptr<const Faces> faces_;
};

/// The section by one plane: every loop, open chain, touching curve and isolated point, all on the patches exactly and
/// on the plane to about 1e-14 of the size. Whether there is a loop is decided for certain, element by element, by
/// Bernstein coefficients (ImplicitTrace).
PlaneSection plane_section(const Boundary<3>& boundary, const PlaneFrame& plane, const SectionOptions& options = {});

/// The region that the loops bound, in the coordinates of the frame: patches "loop_1", or "loop_1_curve_1", ..., all
/// with the region on their left. Throws GeometryError if there is no loop.
Boundary<2> section_region(const PlaneSection& section);

}  // namespace isorim::geometry
