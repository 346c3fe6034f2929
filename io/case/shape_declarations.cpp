#include <algorithm>
#include <cstddef>
#include <type_traits>

#include <fmt/format.h>

#include "io/cad/units.h"
#include "io/case/shape_keys.h"
#include "io/case/shape_schema.h"

/// The declarations of all shapes. Help and reference print the texts that stand here.
namespace isorim::io {
namespace {

template <class T>
Schema<T> with_kept_side(Schema<T> own) {
  using geometry::KeptSide;
  own.choice("keep", &T::keep, {{"inside", KeptSide::inside}, {"outside", KeptSide::outside}},
             {.text = "Which side of the tool is kept.", .presence = required});
  return own;
}

template <class T>
Schema<T> with_role(Schema<T> own) {
  own.choice("role", &T::role, {{"any", LoopRole::any}, {"outer", LoopRole::outer}, {"hole", LoopRole::hole}},
             {.text = "What the loop is meant to be. Holes are found by nesting; a role that contradicts it is an "
                      "error."});
  return own;
}

template <class T>
Schema<T> line_schema() {
  return with_common_keys(Schema<T>("line", "A straight segment.")
                              .key("from", &LineKeys::from, {.text = "Start.", .presence = required})
                              .key("to", &LineKeys::to, {.text = "End.", .presence = required}))
      .check([](const T& line, const KeyPlace&, Complaints& complaints) {
        check_dimensions({line.from, line.to}, 2, 3, complaints);
      });
}

template <class T>
Schema<T> polyline_schema() {
  return with_common_keys(Schema<T>("polyline", "Straight segments through the points, one curve of degree 1.")
                              .key("points", &PolylineKeys::points, {.text = "At least 2.", .presence = required}))
      .check([](const T& line, const KeyPlace& where, Complaints& complaints) {
        complain_few(line.points.size(), 2, "points", where, complaints);
        check_dimensions(line.points, 2, 3, complaints);
      });
}

template <class T>
Schema<T> arc_schema() {
  return with_common_keys(
      Schema<T>("arc", "A circular arc, exact as a rational quadratic.")
          .key("radius", &ArcKeys::radius, {.text = "Radius.", .range = Range::above(0), .presence = required})
          .key("centre", &ArcKeys::centre, {.text = "Centre."})
          .key("angles", &ArcKeys::angles,
               {.text = "Where the arc begins and ends, counter-clockwise from the x axis; falling angles run "
                        "clockwise.",
                .unit = "degrees"}));
}

template <class T>
Schema<T> ellipse_arc_schema() {
  return with_common_keys(
      Schema<T>("ellipse_arc", "An elliptic arc, exact as a rational quadratic.")
          .key("radii", &EllipseArcKeys::radii, {.text = "Semi-axes.", .range = Range::above(0), .presence = required})
          .key("centre", &EllipseArcKeys::centre, {.text = "Centre."})
          .key("rotation", &EllipseArcKeys::rotation,
               {.text = "Of the first semi-axis from the x axis, counter-clockwise.", .unit = "degrees"})
          .key("angles", &EllipseArcKeys::angles,
               {.text = "Where the arc begins and ends, in the parametric angle t of (a cos t, b sin t).",
                .unit = "degrees"}));
}

template <class T>
Schema<T> nurbs_curve_schema() {
  return with_common_keys(
             Schema<T>("nurbs", "A NURBS curve by degree, knots and control points.")
                 .key("degree", &NurbsCurveKeys::degree,
                      {.text = "Polynomial degree.", .range = Range::between(1, 30), .presence = required})
                 .key("knots", &NurbsCurveKeys::knots,
                      {.text = "Non-decreasing; as many as control points + degree + 1. With periodic = true the "
                               "breakpoints of one period: as many as control points + 1.",
                       .presence = required})
                 .key("points", &NurbsCurveKeys::points, {.text = "Control points (Cartesian)."})
                 .key("weights", &NurbsCurveKeys::weights,
                      {.text = "One a control point; all 1 if absent.", .range = Range::above(0)})
                 .key("homogeneous", &NurbsCurveKeys::homogeneous,
                      {.text = "Instead of points and weights: (w x, w y, [w z,] w)."})
                 .key("periodic", &NurbsCurveKeys::periodic,
                      {.text = "A closed curve, smooth at its seam: no control point is repeated."}))
      .check([](const T& curve, const KeyPlace& where, Complaints& complaints) {
        check_control_points(!curve.points.empty(), !curve.homogeneous.empty(), !curve.weights.empty(), where,
                             complaints);
        check_dimensions(curve.points, 2, 3, complaints);
        check_dimensions(curve.homogeneous, 3, 4, complaints);
        if (!curve.weights.empty() && !curve.points.empty() && curve.weights.size() != curve.points.size()) {
          complaints.add(where, fmt::format("found {} weights for {} points; expected one each", curve.weights.size(),
                                            curve.points.size()));
        }
      });
}

template <class T>
Schema<T> circle_schema() {
  return with_common_keys(
      Schema<T>("circle", "A circle, counter-clockwise.")
          .key("radius", &CircleKeys::radius, {.text = "Radius.", .range = Range::above(0), .presence = required})
          .key("centre", &CircleKeys::centre, {.text = "Centre."}));
}

template <class T>
Schema<T> ellipse_schema() {
  return with_common_keys(
      Schema<T>("ellipse", "An ellipse, counter-clockwise.")
          .key("radii", &EllipseKeys::radii, {.text = "Semi-axes.", .range = Range::above(0), .presence = required})
          .key("centre", &EllipseKeys::centre, {.text = "Centre."})
          .key("rotation", &EllipseKeys::rotation,
               {.text = "Of the first semi-axis from the x axis, counter-clockwise.", .unit = "degrees"}));
}

template <class T>
Schema<T> rectangle_schema() {
  return with_common_keys(
      Schema<T>("rectangle", "A rectangle along the axes.")
          .key("size", &RectangleKeys::size,
               {.text = "Lengths along x and y.", .range = Range::above(0), .presence = required})
          .key("corner", &RectangleKeys::corner, {.text = "The corner with the smallest coordinates."}));
}

template <class T>
Schema<T> polygon_schema() {
  return with_common_keys(Schema<T>("polygon", "A closed polygon; the last corner joins the first.")
                              .key("points", &PolygonKeys::points,
                                   {.text = "The corners, at least 3, none repeated.", .presence = required}))
      .check([](const T& polygon, const KeyPlace& where, Complaints& complaints) {
        complain_few(polygon.points.size(), 3, "corners", where, complaints);
        check_dimensions(polygon.points, 2, 2, complaints);
      });
}

template <class T>
Schema<T> path_schema() {
  return with_common_keys(Schema<T>("path",
                                    "Curves, each beginning where the one before ends, the last ending where the first "
                                    "begins. A loop with the key \"curves\" needs no type.")
                              .key("curves", &PathKeys::curves, {.text = "In order.", .presence = required}))
      .check([](const T& path, const KeyPlace& where, Complaints& complaints) {
        complain_few(path.curves.size(), 1, "curves", where, complaints);
      });
}

/// Of two keys of which exactly one must be given.
void check_profile(bool has_profile, bool has_region, const KeyPlace& where, Complaints& complaints) {
  if (has_profile == has_region) {
    complaints.add(where, fmt::format("found {}; expected exactly one of \"profile\" and \"region\"",
                                      has_profile ? "both" : "neither"));
  }
}

void check_direction(const Eigen::Vector3d& direction, std::string_view key, const KeyPlace& where,
                     Complaints& complaints) {
  if (direction.norm() == 0.0) {
    complaints.add(where, fmt::format("the key \"{}\" is [0, 0, 0]; expected a direction", key));
  }
}

Schema<LoftKeys> loft_schema() {
  return with_common_keys(
             Schema<LoftKeys>("loft", "The surface that interpolates sections (skinning).")
                 .key("sections", &LoftKeys::sections,
                      {.text = "Curves, at least 2, in order; made compatible by degree elevation and knot "
                               "insertion.",
                       .presence = required})
                 .key("degree", &LoftKeys::degree,
                      {.text = "Across the sections; lowered to their number minus 1.", .range = Range::between(1, 30)})
                 .choice("ends", &LoftKeys::ends, {{"open", SweepEnds::open}, {"caps", SweepEnds::caps}},
                         {.text = "Of closed sections: left open, or the first and last closed by flat caps."}))
      .check([](const LoftKeys& loft, const KeyPlace& where, Complaints& complaints) {
        complain_few(loft.sections.size(), 2, "sections", where, complaints);
      });
}

}  // namespace

// --- Moving ---------------------------------------------------------------------------------------------------

template <>
const Schema<RotationKeys>& schema<RotationKeys>() {
  static const auto declared =
      Schema<RotationKeys>("rotate", "A turn by the right hand.")
          .key("angle", &RotationKeys::angle,
               {.text = "Counter-clockwise in the plane.", .unit = "degrees", .presence = required})
          .key("axis", &RotationKeys::axis, {.text = "Direction of the axis, in space; z if absent."})
          .key("point", &RotationKeys::point, {.text = "A point that stays; the origin if absent."})
          .check([](const RotationKeys& rotation, const KeyPlace& where, Complaints& complaints) {
            if (rotation.axis) check_direction(*rotation.axis, "axis", where, complaints);
          });
  return declared;
}

template <>
const Schema<MirrorKeys>& schema<MirrorKeys>() {
  static const auto declared =
      Schema<MirrorKeys>("mirror", "The mirror image in a plane (in the plane: in a line).")
          .key("normal", &MirrorKeys::normal, {.text = "Normal of the mirror.", .presence = required})
          .key("point", &MirrorKeys::point, {.text = "A point of the mirror; the origin if absent."});
  return declared;
}

template <>
const Schema<TransformKeys>& schema<TransformKeys>() {
  static const auto declared =
      Schema<TransformKeys>("transform", "An affine map, applied in the order scale, mirror, rotate, translate.")
          .key("scale", &TransformKeys::scale, {.text = "A factor, or one a coordinate; not 0. About the origin."})
          .key("mirror", &TransformKeys::mirror, {.text = "Mirrors."})
          .key("rotate", &TransformKeys::rotate, {.text = "Turns."})
          .key("translate", &TransformKeys::translate, {.text = "Shifts by this vector."});
  return declared;
}

// --- Cutting ----------------------------------------------------------------------------------------------------

template <>
const Schema<PlaneClipKeys>& schema<PlaneClipKeys>() {
  static const auto declared =
      Schema<PlaneClipKeys>("clip_plane", "A plane. A tool with the key \"normal\" needs no type.")
          .key("normal", &PlaneClipKeys::normal,
               {.text = "Points to the side that is cut away; of any length.", .presence = required})
          .key("point", &PlaneClipKeys::point, {.text = "A point of the plane."})
          .check([](const PlaneClipKeys& plane, const KeyPlace& where, Complaints& complaints) {
            check_direction(plane.normal, "normal", where, complaints);
          });
  return declared;
}

template <>
const Schema<SphereClipKeys>& schema<SphereClipKeys>() {
  static const auto declared = with_kept_side(
      Schema<SphereClipKeys>("clip_sphere", "A sphere.")
          .key("radius", &SphereClipKeys::radius, {.text = "Radius.", .range = Range::above(0), .presence = required})
          .key("centre", &SphereClipKeys::centre, {.text = "Centre."}));
  return declared;
}

template <>
const Schema<CylinderClipKeys>& schema<CylinderClipKeys>() {
  static const auto declared =
      with_kept_side(Schema<CylinderClipKeys>("clip_cylinder", "A circular cylinder without ends.")
                         .key("radius", &CylinderClipKeys::radius,
                              {.text = "Radius.", .range = Range::above(0), .presence = required})
                         .key("point", &CylinderClipKeys::point, {.text = "A point of its axis."})
                         .key("axis", &CylinderClipKeys::axis, {.text = "Direction of its axis, of any length."}))
          .check([](const CylinderClipKeys& tool, const KeyPlace& where, Complaints& complaints) {
            check_direction(tool.axis, "axis", where, complaints);
          });
  return declared;
}

template <>
const Schema<ConeClipKeys>& schema<ConeClipKeys>() {
  static const auto declared =
      with_kept_side(Schema<ConeClipKeys>("clip_cone", "A circular cone without end, on one side of its apex.")
                         .key("half_angle", &ConeClipKeys::half_angle,
                              {.text = "Between axis and side.",
                               .unit = "degrees",
                               .range = {.least = 0, .most = 90, .least_is_open = true, .most_is_open = true},
                               .presence = required})
                         .key("apex", &ConeClipKeys::apex, {.text = "Its tip."})
                         .key("axis", &ConeClipKeys::axis, {.text = "From the tip into the cone, of any length."}))
          .check([](const ConeClipKeys& tool, const KeyPlace& where, Complaints& complaints) {
            check_direction(tool.axis, "axis", where, complaints);
          });
  return declared;
}

// --- Curves and regions ---------------------------------------------------------------------------------------

#define ISORIM_DECLARE(Keys, ...)             \
  template <>                                 \
  const Schema<Keys>& schema<Keys>() {        \
    static const auto declared = __VA_ARGS__; \
    return declared;                          \
  }

ISORIM_DECLARE(LineKeys, line_schema<LineKeys>())
ISORIM_DECLARE(PolylineKeys, polyline_schema<PolylineKeys>())
ISORIM_DECLARE(ArcKeys, arc_schema<ArcKeys>())
ISORIM_DECLARE(EllipseArcKeys, ellipse_arc_schema<EllipseArcKeys>())
ISORIM_DECLARE(NurbsCurveKeys, nurbs_curve_schema<NurbsCurveKeys>())
ISORIM_DECLARE(CircleKeys, circle_schema<CircleKeys>())
ISORIM_DECLARE(EllipseKeys, ellipse_schema<EllipseKeys>())
ISORIM_DECLARE(RectangleKeys, rectangle_schema<RectangleKeys>())
ISORIM_DECLARE(PolygonKeys, polygon_schema<PolygonKeys>())
ISORIM_DECLARE(PathKeys, path_schema<PathKeys>())
ISORIM_DECLARE(LoopOf<NurbsCurveKeys>, with_role(nurbs_curve_schema<LoopOf<NurbsCurveKeys>>()))
ISORIM_DECLARE(LoopOf<CircleKeys>, with_role(circle_schema<LoopOf<CircleKeys>>()))
ISORIM_DECLARE(LoopOf<EllipseKeys>, with_role(ellipse_schema<LoopOf<EllipseKeys>>()))
ISORIM_DECLARE(LoopOf<RectangleKeys>, with_role(rectangle_schema<LoopOf<RectangleKeys>>()))
ISORIM_DECLARE(LoopOf<PolygonKeys>, with_role(polygon_schema<LoopOf<PolygonKeys>>()))
ISORIM_DECLARE(LoopOf<PathKeys>, with_role(path_schema<LoopOf<PathKeys>>()))

template <>
const Schema<RegionKeys>& schema<RegionKeys>() {
  static const auto declared =
      with_common_keys(Schema<RegionKeys>("region",
                                          "A region of the plane by its loops. Loops inside others are "
                                          "holes, loops inside holes islands.")
                           .key("loops", &RegionKeys::loops,
                                {.text = "Closed shapes, or { curves = [..] } made of curves; each may have "
                                         "role = \"outer\" or \"hole\", which is checked against the nesting.",
                                 .presence = required}))
          .check([](const RegionKeys& region, const KeyPlace& where, Complaints& complaints) {
            complain_few(region.loops.size(), 1, "loops", where, complaints);
          });
  return declared;
}

// --- Solids ---------------------------------------------------------------------------------------------------

/// One patch, or as many as the other form of the shape has.
template <class T>
Schema<T> with_patches(Schema<T> own, int other, const std::string& text) {
  return own.key("patches", &T::patches, {.text = text})
      .check([other](const T& keys, const KeyPlace& where, Complaints& complaints) {
        if (keys.patches == 1 || keys.patches == other) return;
        complaints.add(where, fmt::format("found patches = {}; expected 1 or {}", keys.patches, other));
      });
}

template <>
const Schema<SphereKeys>& schema<SphereKeys>() {
  static const auto declared =
      with_patches(with_common_keys(Schema<SphereKeys>("sphere", "A sphere, exact.")
                                        .key("radius", &SphereKeys::radius,
                                             {.text = "Radius.", .range = Range::above(0), .presence = required})
                                        .key("centre", &SphereKeys::centre, {.text = "Centre."})),
                   6,
                   "1: a surface of revolution with two poles; 6: a cube's faces blown up, without poles, \"x_min\" to "
                   "\"z_max\", of degree 4.");
  return declared;
}

ISORIM_DECLARE(EllipsoidKeys,
               with_common_keys(Schema<EllipsoidKeys>("ellipsoid", "An ellipsoid along the axes.")
                                    .key("radii", &EllipsoidKeys::radii,
                                         {.text = "Semi-axes.", .range = Range::above(0), .presence = required})
                                    .key("centre", &EllipsoidKeys::centre, {.text = "Centre."})))

template <>
const Schema<TorusKeys>& schema<TorusKeys>() {
  static const auto declared = with_patches(
      with_common_keys(Schema<TorusKeys>("torus", "A ring torus about an axis parallel to z.")
                           .key("major_radius", &TorusKeys::major_radius,
                                {.text = "From the centre to the middle of the tube; above the minor radius.",
                                 .range = Range::above(0),
                                 .presence = required})
                           .key("minor_radius", &TorusKeys::minor_radius,
                                {.text = "Of the tube.", .range = Range::above(0), .presence = required})
                           .key("centre", &TorusKeys::centre, {.text = "Centre."}))
          .check([](const TorusKeys& torus, const KeyPlace& where, Complaints& complaints) {
            if (torus.minor_radius < torus.major_radius) return;
            complaints.add(where, fmt::format("found minor_radius = {} and major_radius = {}; expected minor_radius < "
                                              "major_radius, else the torus meets itself",
                                              torus.minor_radius, torus.major_radius));
          }),
      16, "1: closed in both directions; 16: its elements, \"torus_1_1\" to \"torus_4_4\".");
  return declared;
}

ISORIM_DECLARE(CylinderKeys,
               with_common_keys(Schema<CylinderKeys>("cylinder", "A solid circular cylinder along z.")
                                    .key("radius", &CylinderKeys::radius,
                                         {.text = "Radius.", .range = Range::above(0), .presence = required})
                                    .key("height", &CylinderKeys::height,
                                         {.text = "Height.", .range = Range::above(0), .presence = required})
                                    .key("base", &CylinderKeys::base, {.text = "Centre of the bottom disc."})))

template <>
const Schema<ConeKeys>& schema<ConeKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<ConeKeys>("cone", "A solid circular cone along z, or a frustum of one.")
              .key("radius", &ConeKeys::radius,
                   {.text = "Of the bottom disc; the top is the apex.", .range = Range::above(0)})
              .key("radii", &ConeKeys::radii,
                   {.text = "Instead of radius: of the bottom and the top disc; one may be 0.",
                    .range = Range::at_least(0)})
              .key("height", &ConeKeys::height, {.text = "Height.", .range = Range::above(0), .presence = required})
              .key("base", &ConeKeys::base, {.text = "Centre of the bottom disc."}))
          .check([](const ConeKeys& cone, const KeyPlace& where, Complaints& complaints) {
            if (cone.radius.has_value() == cone.radii.has_value()) {
              complaints.add(where, fmt::format("found {}; expected exactly one of \"radius\" and \"radii\"",
                                                cone.radius ? "both" : "neither"));
            } else if (cone.radii && cone.radii->maxCoeff() <= 0.0) {
              complaints.add(where, "found radii = [0, 0]; expected at least one radius > 0");
            }
          });
  return declared;
}

ISORIM_DECLARE(
    BoxKeys,
    with_common_keys(Schema<BoxKeys>("box", "A box along the axes, six bilinear patches.")
                         .key("size", &BoxKeys::size,
                              {.text = "Lengths along x, y, z.", .range = Range::above(0), .presence = required})
                         .key("corner", &BoxKeys::corner, {.text = "The corner with the smallest coordinates."})))

template <>
const Schema<AxisKeys>& schema<AxisKeys>() {
  static const auto declared = Schema<AxisKeys>("axis", "A straight line in space.")
                                   .key("point", &AxisKeys::point, {.text = "A point of the axis."})
                                   .key("direction", &AxisKeys::direction, {.text = "Its direction, of any length."})
                                   .check([](const AxisKeys& axis, const KeyPlace& where, Complaints& complaints) {
                                     check_direction(axis.direction, "direction", where, complaints);
                                   });
  return declared;
}

template <>
const Schema<RevolveKeys>& schema<RevolveKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<RevolveKeys>("revolve", "A surface or solid of revolution, exact.")
              .key("profile", &RevolveKeys::profile,
                   {.text = "Curves to turn; those of the plane lie in z = 0. They may end on the axis."})
              .key("region", &RevolveKeys::region,
                   {.text = "Instead of a profile: a region of the plane z = 0, beside the axis, which must lie in "
                            "that plane. A part of a turn is closed by the region at both ends."})
              .key("axis", &RevolveKeys::axis, {.text = "The axis of revolution.", .presence = required})
              .key("angle", &RevolveKeys::angle,
                   {.text = "By the right hand about the axis.",
                    .unit = "degrees",
                    .range = {.least = 0, .most = 360, .least_is_open = true}})
              .choice("ends", &RevolveKeys::ends, {{"open", SweepEnds::open}, {"caps", SweepEnds::caps}},
                      {.text = "Of a profile that turns by less than 360 degrees: left open, or closed by flat caps "
                               "into a solid (a profile that ends on the axis is closed along it)."}))
          .check([](const RevolveKeys& revolve, const KeyPlace& where, Complaints& complaints) {
            check_profile(!revolve.profile.empty(), revolve.region.has_value(), where, complaints);
          });
  return declared;
}

template <>
const Schema<ExtrudeKeys>& schema<ExtrudeKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<ExtrudeKeys>("extrude", "What a region or a profile sweeps along a vector.")
              .key("region", &ExtrudeKeys::region, {.text = "A region of the plane z = 0: a solid with both ends."})
              .key("profile", &ExtrudeKeys::profile, {.text = "Instead of a region: curves; the sides alone."})
              .key("vector", &ExtrudeKeys::vector, {.text = "The sweep.", .presence = required}))
          .check([](const ExtrudeKeys& extrude, const KeyPlace& where, Complaints& complaints) {
            check_profile(!extrude.profile.empty(), extrude.region.has_value(), where, complaints);
            check_direction(extrude.vector, "vector", where, complaints);
          });
  return declared;
}

template <>
const Schema<RuledKeys>& schema<RuledKeys>() {
  static const auto declared =
      with_common_keys(Schema<RuledKeys>("ruled",
                                         "The surface of straight lines between two curves at equal "
                                         "parameters.")
                           .key("curves", &RuledKeys::curves, {.text = "Two.", .presence = required}))
          .check([](const RuledKeys& ruled, const KeyPlace& where, Complaints& complaints) {
            if (ruled.curves.size() == 2) return;
            complaints.add(where, fmt::format("found {} curves; expected 2", ruled.curves.size()));
          });
  return declared;
}

ISORIM_DECLARE(LoftKeys, loft_schema())

template <>
const Schema<DiscKeys>& schema<DiscKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<DiscKeys>("disc", "A flat circular disc.")
              .key("radius", &DiscKeys::radius, {.text = "Radius.", .range = Range::above(0), .presence = required})
              .key("centre", &DiscKeys::centre, {.text = "Centre."})
              .key("normal", &DiscKeys::normal, {.text = "Normal of its plane."}))
          .check([](const DiscKeys& disc, const KeyPlace& where, Complaints& complaints) {
            check_direction(disc.normal, "normal", where, complaints);
          });
  return declared;
}

template <>
const Schema<QuadrilateralKeys>& schema<QuadrilateralKeys>() {
  static const auto declared =
      with_common_keys(Schema<QuadrilateralKeys>("quadrilateral", "The bilinear patch of four corners.")
                           .key("corners", &QuadrilateralKeys::corners,
                                {.text = "Four points of space, in order round the patch.", .presence = required}))
          .check([](const QuadrilateralKeys& patch, const KeyPlace& where, Complaints& complaints) {
            if (patch.corners.size() != 4) {
              complaints.add(where, fmt::format("found {} corners; expected 4", patch.corners.size()));
            }
            check_dimensions(patch.corners, 3, 3, complaints);
          });
  return declared;
}

template <>
const Schema<NurbsPatchKeys>& schema<NurbsPatchKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<NurbsPatchKeys>("nurbs", "A tensor-product NURBS surface by degrees, knots and control net.")
              .key("degrees", &NurbsPatchKeys::degrees,
                   {.text = "In u and v.", .range = Range::between(1, 30), .presence = required})
              .key("knots_u", &NurbsPatchKeys::knots_u,
                   {.text = "Non-decreasing; as many as points in u + degree + 1.", .presence = required})
              .key("knots_v", &NurbsPatchKeys::knots_v,
                   {.text = "Non-decreasing; as many as points in v + degree + 1.", .presence = required})
              .key("points", &NurbsPatchKeys::points,
                   {.text = "The control net (Cartesian), u fastest: one list, or a list of rows in each of which u "
                            "runs."})
              .key("weights", &NurbsPatchKeys::weights,
                   {.text = "One a control point, in the order of the points; all 1 if absent."})
              .key("homogeneous", &NurbsPatchKeys::homogeneous,
                   {.text = "Instead of points and weights: (w x, w y, w z, w)."}))
          .check([](const NurbsPatchKeys& patch, const KeyPlace& where, Complaints& complaints) {
            check_control_points(!patch.points.points.empty(), !patch.homogeneous.points.empty(),
                                 !patch.weights.values.empty(), where, complaints);
            check_dimensions(patch.points.points, 3, 3, complaints);
            check_dimensions(patch.homogeneous.points, 4, 4, complaints);
          });
  return declared;
}

template <>
const Schema<PatchesKeys>& schema<PatchesKeys>() {
  static const auto declared =
      with_common_keys(Schema<PatchesKeys>("patches",
                                           "Surfaces of several kinds that make one boundary. They may be "
                                           "turned either way: the outward side is found.")
                           .key("patches", &PatchesKeys::patches, {.text = "Surfaces.", .presence = required}))
          .check([](const PatchesKeys& patches, const KeyPlace& where, Complaints& complaints) {
            complain_few(patches.patches.size(), 1, "patches", where, complaints);
          });
  return declared;
}

template <>
const Schema<NurbsKeys>& schema<NurbsKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<NurbsKeys>("nurbs", "A boundary of NURBS: curves of the plane or patches in space.")
              .key("curves", &NurbsKeys::curves, {.text = "Curves of the plane, open or closed, in any order."})
              .key("patches", &NurbsKeys::patches, {.text = "Surfaces, turned either way."}))
          .check([](const NurbsKeys& nurbs, const KeyPlace& where, Complaints& complaints) {
            if (nurbs.curves.empty() != nurbs.patches.empty()) return;
            complaints.add(where, fmt::format("found {}; expected exactly one of \"curves\" and \"patches\"",
                                              nurbs.curves.empty() ? "neither" : "both"));
          });
  return declared;
}

template <>
const Schema<FileKeys>& schema<FileKeys>() {
  std::vector<std::pair<std::string, std::string>> units;
  for (const LengthUnit& unit : length_units) units.emplace_back(unit.name, unit.name);
  static const auto declared = with_common_keys(
      Schema<FileKeys>("file",
                       "The boundary in a CAD file: " + cad_formats() +
                           ". Faces make a solid, turned outward whatever the file says of their sides; a drawing's "
                           "curves make a region of the plane. isorim check FILE tells what a file holds.")
          .key("path", &FileKeys::path,
               {.text = "The file; a relative path begins at the folder of the case file.", .presence = required})
          .choice("units", &FileKeys::units, units,
                  {.text = "Unit of all lengths of the case and of its results: the shape is converted into it. That "
                           "of the file if absent."})
          .key("dimension", &FileKeys::dimension,
               {.text = "3: a solid bounded by the faces. 2: a region of the plane, bounded by the curves or, where "
                        "there are faces, by the edges of these, which must be flat. 3 if absent and the file has "
                        "faces, else 2.",
                .range = Range::between(2, 3)})
          .choice("blanked", &FileKeys::blanked,
                  {{"skip", BlankedEntities::skip}, {"include", BlankedEntities::include}},
                  {.text = "What becomes of faces and curves that are switched off in the file."})
          .key("repair", &FileKeys::repair,
               {.text =
                    "IGES alone: OpenCASCADE reads the file, repairs it and sews faces within this distance, instead "
                    "of isorim, which alters nothing. For files that are refused or open otherwise.",
                .unit = "mm",
                .range = Range::above(0)})
          .key("names", &FileKeys::names, {.text = "Only faces and curves that the file gives these names."})
          .key("levels", &FileKeys::levels, {.text = "Only faces and curves on these levels (layers)."}));
  return declared;
}

#undef ISORIM_DECLARE

// --- The names of the types -----------------------------------------------------------------------------------

template <>
const TypeTags& type_tags<CurveKeys>() {
  static const TypeTags tags{
      {"line", "polyline", "arc", "ellipse_arc", "nurbs", "circle", "ellipse", "rectangle", "polygon"},
      {"fit", "file"},
      "",
      ""};
  return tags;
}

template <>
const TypeTags& type_tags<LoopKeys>() {
  static const TypeTags tags{
      {"path", "circle", "ellipse", "rectangle", "polygon", "nurbs"}, {"fit", "file"}, "curves", "path"};
  return tags;
}

template <>
const TypeTags& type_tags<ClipKeys>() {
  static const TypeTags tags{{"plane", "sphere", "cylinder", "cone"}, {}, "normal", "plane"};
  return tags;
}

template <>
const TypeTags& type_tags<PlaneRegionKeys>() {
  static const TypeTags tags{
      {"region", "circle", "ellipse", "rectangle", "polygon", "path"}, {"fit", "file"}, "loops", "region"};
  return tags;
}

template <>
const TypeTags& type_tags<NurbsSurfaceKeys>() {
  static const TypeTags tags{{"nurbs", "quadrilateral", "disc", "revolve", "extrude", "ruled", "loft", "sphere",
                              "ellipsoid", "torus", "cylinder", "cone", "box"},
                             {"file", "fit"},
                             "",
                             "",
                             {{"skin", "loft"}}};
  return tags;
}

template <>
const TypeTags& type_tags<SurfaceKeys>() {
  static const TypeTags tags{{"nurbs", "quadrilateral", "disc", "revolve", "extrude", "ruled", "loft", "sphere",
                              "ellipsoid", "torus", "cylinder", "cone", "box", "tspline"},
                             {"file", "fit"},
                             "",
                             "",
                             {{"skin", "loft"}}};
  return tags;
}

template <>
const TypeTags& type_tags<GeometryKeys>() {
  static const TypeTags tags{
      {"circle",    "ellipse", "ellipse_arc", "rectangle", "polygon", "region",  "nurbs",   "sphere",
       "ellipsoid", "torus",   "cylinder",    "cone",      "box",     "revolve", "extrude", "ruled",
       "loft",      "patches", "tspline",     "propeller", "file",    "fit",     "hull"},
      {},
      "",
      "",
      {{"skin", "loft"}}};
  return tags;
}

}  // namespace isorim::io
