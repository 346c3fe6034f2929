#pragma once

#include <span>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// Closed sections of a body made to run the same way round from corresponding places.
namespace isorim::geometry {

enum class StartRule {
  as_given,
  /// In the place nearest to the start of the section before.
  closest,
  /// Where the distances between points of equal parameters of this section and the one before, both moved to their
  /// centroids, have the least sum of squares: the surface between the two twists least.
  least_twist,
};

/// Whether the curve ends where it starts, to 1e-9 of its size.
bool is_closed(const NurbsCurve<3>& curve);

/// Half the integral of (C - C(first)) x C': the area that a closed curve encloses, times its normal. To quadrature
/// accuracy of the control polygon's refinement: meant for directions.
Vector3 vector_area(const NurbsCurve<3>& curve);

/// The same closed curve over [0, 1], clamped, started at the parameter u. A curve on a periodic knot vector stays as
/// smooth where it used to close; of others the two halves are joined. Throws GeometryError if the curve is not closed
/// or u outside its domain.
NurbsCurve<3> start_at(const NurbsCurve<3>& curve, double u);

/// Sections over [0, 1], clamped: each turned round if its vector area looks against that of the one before, and then
/// started by the rule. The first stays as it is. Sections that are points stay so, and are passed over. The error of
/// the start is below 1e-6 of the period. Throws GeometryError, naming the section (from 1), for one that is not
/// closed.
std::vector<NurbsCurve<3>> align_sections(std::span<const NurbsCurve<3>> sections, StartRule rule);

/// What align_polygons() did to a polygon: its order reversed, and point `first` of the reversed order put first.
struct PolygonAlignment {
  bool reversed = false;
  Eigen::Index first = 0;
};

/// The same for closed polygons, 3 x n each without the first point again: their order is reversed where necessary, and
/// another of their points becomes the first; least_twist compares points of equal parts of the polygons' lengths. What
/// is fitted to them afterwards can have the same knots. Returns what was done to each.
std::vector<PolygonAlignment> align_polygons(std::span<Points<3>> polygons, StartRule rule);

}  // namespace isorim::geometry
