#pragma once

#include <vector>

#include "geometry/intersection/plane_section.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

namespace isorim::geometry {

/// The lifted curve t -> S(c(t)) (c over [0, 1]), which lies in the plane, in the coordinates of the plane, end to
/// start. Along lines of constant u or v it is the isoparametric curve, exactly; elsewhere polynomials that meet it to
/// 4e-15 of `size`, the length that coordinates are of. Throws GeometryError, with the place, if it is not smooth
/// enough for that.
std::vector<NurbsCurve<2>> plane_image(const NurbsSurface<3>& surface, const NurbsCurve<2>& curve,
                                       const PlaneFrame& frame, double size);

}  // namespace isorim::geometry
