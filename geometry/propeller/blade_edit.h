#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/nurbs/curve.h"

/// Changes of a section's curve by hand, between its interpolation and the surface: those of Garcia 1999 (EdCurv).
namespace isorim::geometry {

struct BladeEdit {
  enum class Kind {
    /// Along the shaft (X), by `by`.
    move_along_shaft,
    /// In Y by `by`, on the control point's own cylinder about the shaft: Z follows.
    move_on_cylinder,
    /// The control point moves to where the curve's highest derivative that jumps at the knot in the middle of the
    /// point's support (of a cubic the third) jumps no more: the knot could be removed then (Farin & Sapidis 1990;
    /// Garcia 1999, eqs. 6-1 to 6-3).
    smooth_at_knot,
  };
  Kind kind = Kind::move_along_shaft;
  /// Numbers from 0. The first and the last control point, the trailing edge, cannot be edited.
  std::size_t section = 0;
  int point = 0;
  double by = 0.0;
};

/// The curve of a section with one control point moved. Polynomial curves only. Throws GeometryError, naming section
/// and control point, if there is no such point or it is the trailing edge; if `by` is not finite or leads off the
/// cylinder; for smooth_at_knot if the degree is even, or the knot is an end of the curve or a multiple one.
NurbsCurve<3> edited(const NurbsCurve<3>& curve, const BladeEdit& edit);

/// One edit after the other. Throws GeometryError as above, and if there is no such section.
void apply_edits(std::span<const BladeEdit> edits, std::vector<NurbsCurve<3>>& sections);

}  // namespace isorim::geometry
