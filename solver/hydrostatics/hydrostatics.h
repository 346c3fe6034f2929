#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/intersection/plane_section.h"
#include "geometry/vocabulary.h"
#include "quadrature/estimate.h"
#include "solver/hydrostatics/floating_body.h"
#include "solver/hydrostatics/immersed_body.h"
#include "solver/hydrostatics/station_section.h"

/// Hydrostatics of a body at a given draught, trim and heel. Conventions: solver/hydrostatics/README.md.
namespace isorim::solver {

/// How a body is measured as a ship. x forward, y to port, z up.
struct ShipFrame {
  /// z of the baseline: draughts and heights are measured from it.
  double baseline = 0.0;
  /// x and y of the place at which the draught is measured; its station is the midship section.
  geometry::Point2 origin = geometry::Point2::Zero();
};

/// The baseline through the lowest point of the body, the origin in the middle of its box.
ShipFrame default_frame(const FloatingBody& body);

/// Where a body lies in the water.
struct Attitude {
  /// From the baseline to the water plane at the frame's origin, along the body's z axis.
  double draught = 0.0;
  /// Angle between the body's x axis and the water plane, radians in [-pi/2, pi/2]: positive by the stern (bow up).
  double trim = 0.0;
  /// Turn about the body's x axis, radians: positive to starboard (starboard side down).
  double heel = 0.0;
};

/// The direction that is up, in the coordinates of the body: (sin trim, cos trim sin heel, cos trim cos heel).
geometry::Vector3 up_direction(double trim, double heel);
WaterPlane water_plane(const ShipFrame& frame, const Attitude& attitude);

/// The attitude of a plane. The draught is not finite where the body's z axis lies in the plane.
Attitude attitude_of(const ShipFrame& frame, const WaterPlane& plane);

struct Hydrostatics {
  Attitude attitude;
  ImmersedBody immersed;
  quadrature::Estimate wetted_surface;
  /// Centre of buoyancy: x, y, and the height over the baseline along the body's z axis.
  quadrature::Estimate lcb;
  quadrature::Estimate tcb;
  quadrature::Estimate vcb;
  /// x and y of the centroid of the waterplane.
  quadrature::Estimate lcf;
  quadrature::Estimate tcf;
  /// Second moments of the waterplane about its own axes: about the longitudinal one, the transverse one, and mixed.
  quadrature::Estimate it;
  quadrature::Estimate il;
  quadrature::Estimate itl;
  /// Metacentric radii IT / V and IL / V, and heights of the metacentres over the baseline (at the frame's origin),
  /// along up.
  quadrature::Estimate bmt;
  quadrature::Estimate bml;
  quadrature::Estimate kmt;
  quadrature::Estimate kml;
  /// Extents of the waterplane along the body's x and y axes; absent without a waterplane.
  std::optional<double> waterline_length;
  std::optional<double> waterline_beam;
  /// Those that the coefficients use: as given, or else of the waterplane.
  std::optional<double> length;
  std::optional<double> beam;
  /// Immersed area of the section at the frame's origin.
  quadrature::Estimate midship_area;
  /// V / (L B T), V / (A_m L), A_m / (B T), A_w / (L B); absent without L, B, T or A_m.
  std::optional<quadrature::Estimate> cb;
  std::optional<quadrature::Estimate> cp;
  std::optional<quadrature::Estimate> cm;
  std::optional<quadrature::Estimate> cwp;
  int cut_elements = 0;
  int immersed_elements = 0;
  /// Pieces on which the tolerance was not reached.
  std::int64_t unfinished = 0;
};

struct HydrostaticOptions {
  /// For the coefficients, instead of the waterplane's extents.
  std::optional<double> length;
  std::optional<double> beam;
};

/// `midship` is station_section() at the frame's origin. Throws GeometryError if the boundary cannot be cut.
Hydrostatics hydrostatics(const FloatingBody& body, const StationSection& midship, const ShipFrame& frame,
                          const Attitude& attitude, const HydrostaticOptions& options = {});

}  // namespace isorim::solver
