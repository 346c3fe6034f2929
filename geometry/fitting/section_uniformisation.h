#pragma once

#include <span>
#include <vector>

#include "geometry/nurbs/curve.h"

namespace isorim::geometry {

enum class Uniformisation {
  /// The union of all knots: exact, but of as many control points as all sections together have knots.
  merge,
  /// Equally spaced knots are put into every section, its own ones removed where the tolerance allows, and those that
  /// stay given to all (seed: thesis on propeller sections, section 5.2).
  insert_and_remove,
};

struct UniformisationOptions {
  Uniformisation method = Uniformisation::merge;
  /// insert_and_remove: how many knots k / (n + 1) are inserted, at least 1.
  int inserted_knots = 25;
  /// insert_and_remove: no point of a section moves by more than this, in the unit of the sections, however many of its
  /// knots are removed; 0 removes only what costs nothing but rounding.
  double tolerance = 0.0;
};

/// Sections on one knot vector, and what that took.
struct UniformSections {
  std::vector<NurbsCurve<3>> sections;
  /// Control points of each.
  int control_points = 0;
  /// Occurrences of knots inserted (the common ones included) and removed, all sections together.
  int inserted = 0;
  int removed = 0;
  /// A bound on how far any point of any section moved.
  double error_bound = 0.0;
};

/// Degrees raised to the largest, domains brought to [0, 1], clamped, knots made the same by the method. Throws
/// GeometryError if the options are out of range.
UniformSections uniformise(std::span<const NurbsCurve<3>> sections, const UniformisationOptions& options = {});

}  // namespace isorim::geometry
