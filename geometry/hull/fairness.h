#pragma once

#include <span>

#include "geometry/hull/hull_surface.h"
#include "geometry/hull/offset_table.h"

namespace isorim::geometry {

/// How fair a hull's surface is.
struct HullFairness {
  /// Of the port half: the integral of k1^2 + k2^2, the squared principal curvatures, over its area. By Gauss-Legendre
  /// rules of 5 points a knot span and direction; parts where the surface is degenerate to a line are left out.
  double bending_energy = 0.0;
  /// How often the curvature of the stations and of the waterlines of the table changes its sign, in all. Curvatures
  /// below 1e-6 over half the beam (for waterlines, over the length) count as none.
  int station_sign_changes = 0;
  int waterline_sign_changes = 0;
};

HullFairness measure_fairness(const OffsetTable& table, std::span<const NurbsSurface<3>> bands);

/// The largest distance of a point of the table from the surface.
double largest_offset_distance(std::span<const HullSection> sections, std::span<const NurbsSurface<3>> bands);

}  // namespace isorim::geometry
