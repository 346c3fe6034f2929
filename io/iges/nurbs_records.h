#pragma once

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "io/iges/entity_list.h"

/// Parameters of the entities 126 and 128.
///
/// The files hold Cartesian points and weights, we hold w x. Knots, weights and ranges come back with the same bits,
/// and so does every w x that is the rounded product of w and a double: all coordinates of shapes that were read from a
/// file, and those whose weights are powers of two (polynomial ones with weights 1 among them). Of the others, where
/// the doubles are too sparse for that, the nearest product is written, at most one unit in the last place of w x away.
namespace isorim::io::iges {

/// The double x for which the rounded product w x is `product`, or comes nearest to it. Throws GeometryError if it is
/// beyond the range of doubles.
double cartesian_coordinate(double product, double weight);

/// 126 in space: whether it is planar and closed is told as it is.
Record curve_record(const geometry::NurbsCurve<3>& curve);
/// 126 in the plane z = 0: curves of the plane, and parameter curves.
Record curve_record(const geometry::NurbsCurve<2>& curve);
/// 128.
Record surface_record(const geometry::NurbsSurface<3>& surface);

}  // namespace isorim::io::iges
