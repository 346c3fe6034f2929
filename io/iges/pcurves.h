#pragma once

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"
#include "io/iges/parameter_map.h"

namespace isorim::io::iges {

/// How far a fitted curve may lie from the mapped one, relative to the lengths of the surface's parameters.
inline constexpr double pcurve_tolerance = 1e-13;

struct MappedPcurve {
  geometry::NurbsCurve<2> curve;
  /// 0 if the curve is exactly the given one; else the largest distance found, relative to the domain's lengths.
  double deviation = 0.0;
};

/// A curve in the parameters that IGES gives a surface, in those of the NURBS.
///
/// Exact where both maps are affine along the curve: bit for bit where they are the identity. A curve that keeps one
/// parameter and runs through the other in one direction becomes the straight line between the mapped ends: the same
/// set of points at another speed. All others have no rational image; they are fitted to pcurve_tolerance, split where
/// the maps change.
///
/// domain_u, domain_v: those of the NURBS surface.
MappedPcurve map_pcurve(const geometry::NurbsCurve<2>& pcurve, const ParameterMap& map_u, const ParameterMap& map_v,
                        geometry::Interval domain_u, geometry::Interval domain_v);

}  // namespace isorim::io::iges
