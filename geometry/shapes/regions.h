#pragma once

#include <span>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// Regions of the plane by their boundaries: exact curves that run counter-clockwise around the material (holes
/// clockwise), so natural normals point outward. Angles in radians. All throw GeometryError naming the parameter and
/// its value: radii and sizes must be positive, numbers finite, neighbouring points distinct.
namespace isorim::geometry {

/// One patch "circle".
Boundary<2> disc(double radius, const Point2& centre = Point2::Zero());

/// One patch "ellipse"; `rotation` turns the first radius away from the x axis.
Boundary<2> elliptic_disc(const Vector2& radii, const Point2& centre = Point2::Zero(), double rotation = 0.0);

/// Patches "bottom", "right", "top", "left"; `corner` is the lower left one.
Boundary<2> rectangle(const Vector2& size, const Point2& corner = Point2::Zero());

/// The polygon through the points (columns, at least three), closed by itself; a last point equal to the first is
/// dropped. Patches "side_1", "side_2", ... in the order given; points given clockwise are run backwards. Throws also
/// if neighbours coincide. Whether sides cross is for orient() to say.
Boundary<2> polygon(const Points<2>& points);

/// `sides` >= 3 corners at the distance `circumradius` from the centre, the first at the angle `rotation`.
Boundary<2> regular_polygon(int sides, double circumradius, const Point2& centre = Point2::Zero(),
                            double rotation = 0.0);

/// Which part of an ellipse: parametric angles, see ellipse_arc(). from > to is the same part as from < to.
struct EllipsePart {
  Vector2 radii = Vector2::Ones();
  Point2 centre = Point2::Zero();
  double rotation = 0.0;
  double from = 0.0;
  double to = 0.0;
};
/// Between an arc and its chord: patches "arc", "chord". Throws if the arc is a full turn.
Boundary<2> ellipse_segment(const EllipsePart& part);
/// Between an arc and the radii to its ends: patches "arc", "last_radius", "first_radius". Throws if the arc is a full
/// turn.
Boundary<2> ellipse_sector(const EllipsePart& part);

/// The region bounded by loops, each a list of curves in any order and direction: outer loops, holes, islands in holes
/// by their nesting. Curves keep their direction; the patches' orientations say how they are run through. Patches
/// "loop_1", "loop_2", ... or, in a loop of several curves, "loop_1_curve_1", ... Throws also where a loop is open
/// (with the places of its ends and the size of the gap), encloses nothing, or crosses itself or another.
Boundary<2> region(std::span<const std::vector<NurbsCurve<2>>> loops);

}  // namespace isorim::geometry
