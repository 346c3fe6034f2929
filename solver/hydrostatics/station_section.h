#pragma once

#include <optional>

#include "geometry/bezier/element_table.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/vocabulary.h"
#include "quadrature/estimate.h"
#include "solver/hydrostatics/floating_body.h"

/// Transverse sections of a body and their immersed areas.
namespace isorim::solver {

/// The region in which the plane x = const cuts a body, by the Bézier curves around it, in the coordinates (y, z).
struct StationSection {
  double x = 0.0;
  /// Empty if the plane misses the body.
  geometry::ElementTable<2> curves;
};

/// Throws GeometryError if the boundary cannot be cut, or does not close there.
StationSection station_section(const geometry::PlaneCutter& cutter, double x);

struct ImmersedSection {
  quadrature::Estimate area;
  /// (y, z); absent without area.
  std::optional<geometry::Point2> centroid;
};

/// The part of a section under a water plane, by radial integration with the pole on the waterline: the parts of the
/// curves under water are enough. Relative tolerance.
ImmersedSection immersed_section(const StationSection& section, const WaterPlane& plane, double tolerance = 1e-12);

}  // namespace isorim::solver
