#pragma once

#include <array>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// The parameter rectangle of a surface, and how its sides are glued in space.
namespace isorim::geometry {

enum class SideKind {
  /// An edge of the surface in space.
  open,
  /// The same curve in space as the opposite side: the surface is closed across it.
  seam,
  /// A single point in space.
  pole,
};

/// The sides are in the order of boundary_curves(): v = first, u = last, v = last, u = first; counter-clockwise.
///
/// What files say about closedness is often wrong, so seams and poles are found from the geometry: points of a seam
/// coincide, and control points of a pole's side do, to within `coincidence` times the size of the surface.
class ParameterRectangle {
 public:
  static constexpr double coincidence = 1e-6;

  /// Keeps a reference to the surface.
  explicit ParameterRectangle(const NurbsSurface<3>& surface);

  const NurbsSurface<3>& surface() const { return *surface_; }
  /// Of the parameter d (0: u, 1: v).
  Interval domain(int d) const { return domain_[static_cast<std::size_t>(d)]; }
  Vector2 lengths() const { return {domain_[0].length(), domain_[1].length()}; }
  bool is_closed(int d) const { return sides_[d == 0 ? 1 : 0] == SideKind::seam; }
  SideKind side(int index) const { return sides_[static_cast<std::size_t>(index)]; }
  /// No side is an edge in space, as on spheres and tori.
  bool has_no_open_side() const;
  /// The point that a pole's side collapses to.
  const Point3& pole(int side) const { return pole_points_[static_cast<std::size_t>(side)]; }
  /// Diagonal of the box of the control points.
  double surface_size() const { return surface_size_; }

  /// The place in the rectangle, moved by whole periods in the closed directions. The ends of a period stay where they
  /// are; open directions are left alone.
  Point2 wrap(const Point2& uv) const;
  /// Points and derivatives at any period.
  Point3 point(const Point2& uv) const { return evaluate(*surface_, wrap(uv)); }
  SurfaceJet<3> jet(const Point2& uv) const { return evaluate_jet(*surface_, wrap(uv)); }

  /// The parameters nearest to uv inside the rectangle, in the open directions only.
  Point2 clamp_open(const Point2& uv) const;
  /// Widths up to which parameters count as the same: TrimmedSurface::parameter_tolerance of the lengths.
  const Vector2& tolerance() const { return tolerance_; }

 private:
  const NurbsSurface<3>* surface_;
  std::array<Interval, 2> domain_;
  std::array<SideKind, 4> sides_{};
  std::array<Point3, 4> pole_points_;
  Vector2 tolerance_;
  double surface_size_ = 0.0;
};

/// The parameter that is constant along a side (0: u, 1: v) and its value there.
struct SideLine {
  int parameter = 0;
  double value = 0.0;
};
SideLine side_line(const ParameterRectangle& rectangle, int side);

}  // namespace isorim::geometry
