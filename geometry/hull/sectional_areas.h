#pragma once

#include <span>
#include <vector>

#include "geometry/hull/hull_surface.h"
#include "geometry/hull/offset_table.h"

namespace isorim::geometry {

/// The areas of a hull's sections up to a height (both sides), along the ship.
struct SectionalAreas {
  /// x, rising; the sections of the table, its contours among them with the area 0.
  std::vector<double> places;
  std::vector<double> areas;
  /// Of the curve through them: as smooth as the areas allow (SmoothestSpline), straight where three or more are equal.
  double volume = 0.0;
  /// Of the volume, x.
  double centroid = 0.0;
  double largest = 0.0;
};

/// The area below `height` within a section: 2 int y dz over the lines u = constant of the bands, to rounding. They
/// must rise along v.
double section_area(std::span<const NurbsSurface<3>> bands, double u, double height);

SectionalAreas sectional_areas(const OffsetTable& table, const HullSurfaceOptions& options = {});

/// Volume over length between perpendiculars times largest area.
double prismatic_coefficient(const SectionalAreas& areas, const OffsetTable& table);
/// Of the volume's centroid: forward of the middle between perpendiculars, over their distance.
double buoyancy_centre(const SectionalAreas& areas, const OffsetTable& table);

struct SectionShift {
  double prismatic = 0.0;
  /// As buoyancy_centre(): positive forward.
  double centre = 0.0;
};

/// The hull with its sections moved along the ship until the curve of its sectional areas up to the design draught has
/// the prismatic coefficient and the centre of buoyancy asked for (both to 1e-12): a section at the part s of the way
/// from amidships to the end of the curve, outside the parallel middle body (s > p), moves by c (1 - s)(s - p) of that
/// way, with one c forward and one aft. H. Lackenby, On the systematic geometrical variation of ship forms, Trans. INA
/// 92 (1950) 289-316; c by Newton's method instead of his formulas of first order.
///
/// Throws GeometryError if the shift would change the order of the stations, or there is none.
OffsetTable shift_sections(const OffsetTable& table, const SectionShift& target,
                           const HullSurfaceOptions& options = {});

}  // namespace isorim::geometry
