#pragma once

#include <span>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/fitting/section_uniformisation.h"
#include "geometry/nurbs/surface.h"
#include "geometry/propeller/blade_edit.h"
#include "geometry/propeller/blade_section.h"

namespace isorim::geometry {

/// How the sections' points become one surface.
enum class BladeFit {
  /// One set of parameters for all sections, the mean of their own: as many control points round the section as it has
  /// points. Default.
  common_parameters,
  /// Each section at its own chord lengths; then their knot vectors are made the same.
  own_parameters,
};

struct BladeSurfaceOptions {
  BladeFit fit = BladeFit::common_parameters;
  /// Of own_parameters. Insertion and removal is the way of Garcia 1999, section 5.2; his 104 control points round the
  /// section of the 500 mm Ka blade go with a tolerance of about 0.1 mm.
  UniformisationOptions uniformisation = {};
  int degree = 3;
  Hand hand = Hand::right;
  /// Of the sections' curves, before their knots are made the same.
  std::vector<BladeEdit> edits = {};
};

/// The parameters v of the sections on the surface, from 0 to 1: mean chord lengths between the outlines in space.
/// Where the last section is one point, the blade's tip is round in outline, and the parameters are 1 - s with s =
/// sqrt(1 - r / R) scaled to 1 at the first section, in which such a blade is smooth (see tip_outline.h). Throws
/// GeometryError as blade_surface() does.
std::vector<double> parameters_across(std::span<const BladeSection> sections);

/// How a blade's surface came by its knots round the sections.
struct BladeKnots {
  int control_points_round = 0;
  int control_points_across = 0;
  /// Of own_parameters: control points round the section if all knots of all sections were merged; else
  /// control_points_round.
  int merged_control_points = 0;
  /// Occurrences of knots, all sections together, and a bound on how far any point of a section moved for it.
  int inserted = 0;
  int removed = 0;
  double removal_error = 0.0;
};

struct BladeSkin {
  NurbsSurface<3> surface;
  BladeKnots knots;
};

/// The surface through the outlines of the sections (at least two, from the root to the tip, of one number of points):
/// u from the trailing edge along the back to the leading edge and along the face back, v from the first section to the
/// last. Interpolation at chord-length parameters with averaged knots, first along the sections, then across at
/// parameters_across() (Piegl & Tiller, sections 9.2.5 and 10.3).
///
/// The leading edge is smooth, the trailing edge is where the surface's sides u = first and u = last meet. All points
/// are met; between them the surface leaves the sections' cylinders by little (0.04 mm on the Ka blade of 500 mm). The
/// natural normal points into a right-handed blade, out of a left-handed one.
///
/// Throws GeometryError, naming the section, for fewer than two sections, different numbers of points, radii that do
/// not rise, or points that coincide along an outline (but for a last section that is one point).
BladeSkin skin_blade(std::span<const BladeSection> sections, const BladeSurfaceOptions& options = {});
NurbsSurface<3> blade_surface(std::span<const BladeSection> sections, const BladeSurfaceOptions& options = {});

/// Closes a blade's surface at its edges: "blade"; "root" at v = first and, unless that edge is a point, "tip" at v =
/// last, both ruled from the back to the face, which the leading edge's parameter u divides; "trailing_edge" where the
/// sides u = first and u = last do not coincide. Oriented outward. Throws GeometryError if that leaves it open.
Boundary<3> close_blade(const NurbsSurface<3>& surface, double leading_edge);

/// The surface through the sections, closed.
Boundary<3> blade_solid(std::span<const BladeSection> sections, const BladeSurfaceOptions& options = {});

/// The parameter u of the leading edge on the surface of the sections: that of its point with common_parameters, near
/// it with others.
double leading_edge_parameter(std::span<const BladeSection> sections);

}  // namespace isorim::geometry
