#pragma once

#include <array>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

/// Faces: surfaces of which a part is kept, bounded by curves in their parameter space.
namespace isorim::geometry {

/// A closed chain of curves in the parameter space of a surface ("pcurves"): each ends where the next one starts, the
/// last where the first starts. What is kept lies on the left: outer loops run counter-clockwise, holes clockwise.
struct TrimLoop {
  std::vector<NurbsCurve<2>> curves;
};

/// A surface and the loops that bound the part of it that is kept; valid from construction on.
///
/// The surface and the curves stay as they were given. Ends that do not meet to the last bit are joined by straight
/// lines wherever the region is integrated or drawn. The loops may touch themselves and one another, run along the
/// edges of the domain and along knot lines; they may not cross.
class TrimmedSurface {
 public:
  /// How far loops may be open or leave the domain, relative to the domain's length in each parameter.
  static constexpr double parameter_tolerance = 1e-6;

  /// Throws GeometryError if there is no loop or a loop without curves; if a curve ends farther from the next one's
  /// start, or runs farther outside the surface's domain, than parameter_tolerance; or if the loops enclose no positive
  /// area. The message names loop and curve (counted from 1) and the place.
  TrimmedSurface(NurbsSurface<3> surface, std::vector<TrimLoop> loops);

  const NurbsSurface<3>& surface() const { return surface_; }
  const std::vector<TrimLoop>& loops() const { return loops_; }

 private:
  NurbsSurface<3> surface_;
  std::vector<TrimLoop> loops_;
};

/// The rectangle of a surface's domain as a loop: along v = first, up u = last, back along v = last, down u = first
/// (the sides in the order of boundary_curves(), all running counter-clockwise).
TrimLoop domain_loop(const NurbsSurface<3>& surface);

/// The same part of the mapped surface. A map with negative determinant turns the natural normal round.
TrimmedSurface transform(const TrimmedSurface& face, const AffineMap<3>& map);

}  // namespace isorim::geometry
