#include "io/case/shape_schema.h"

/// The declarations of T-splines.
namespace isorim::io {
namespace {

/// Either NURBS to convert, or a T-mesh with control points.
void check_tspline(const TSplineKeys& tspline, const KeyPlace& where, Complaints& complaints) {
  const bool has_mesh = !tspline.knots_u.empty() || !tspline.knots_v.empty();
  const bool has_lines = !tspline.lines_u.empty() || !tspline.lines_v.empty();
  const bool has_points = !tspline.points.empty() || !tspline.homogeneous.empty() || !tspline.weights.empty();
  if (!tspline.from.items.empty()) {
    if (has_mesh || has_lines || has_points)
      complaints.add(where,
                     "found \"from\" beside a T-mesh; expected either NURBS to convert or knots, lines and points");
    return;
  }
  if (!tspline.degrees) complaints.add(where, "the key \"degrees\" is missing; expected it with knots");
  if (tspline.knots_u.empty() || tspline.knots_v.empty())
    complaints.add(where, "found no \"from\", and \"knots_u\" or \"knots_v\" is missing; expected one or the other");
  check_control_points(!tspline.points.empty(), !tspline.homogeneous.empty(), !tspline.weights.empty(), where,
                       complaints);
  check_dimensions(tspline.points, 3, 3, complaints);
  check_dimensions(tspline.homogeneous, 4, 4, complaints);
}

void check_region(const RefineKeys& refine, const KeyPlace& where, Complaints& complaints) {
  if (!refine.box.empty()) {
    if (refine.box.size() != 2)
      complaints.add(where, fmt::format("found a box of {} corners; expected 2", refine.box.size()));
    check_dimensions(refine.box, 3, 3, complaints);
  }
  for (const auto& [name, range] : {std::pair{"u", refine.u}, std::pair{"v", refine.v}})
    if (range && !((*range)(0) < (*range)(1)))
      complaints.add(
          where, fmt::format("found {} = [{}, {}]; expected the smaller value first", name, (*range)(0), (*range)(1)));
}

}  // namespace

template <>
const Schema<PartialLineKeys>& schema<PartialLineKeys>() {
  static const auto declared =
      Schema<PartialLineKeys>("line_part", "A part of a knot line of a T-mesh.")
          .key("at", &PartialLineKeys::at, {.text = "The knot whose line it is.", .presence = required})
          .key("from", &PartialLineKeys::from,
               {.text = "Where the part begins: a knot of the other parameter.", .presence = required})
          .key("to", &PartialLineKeys::to, {.text = "Where it ends: a larger one.", .presence = required});
  return declared;
}

template <>
const Schema<RefineKeys>& schema<RefineKeys>() {
  using geometry::Bisection;
  static const auto declared =
      Schema<RefineKeys>(
          "refine",
          "Divides the faces of a T-mesh of which a part lies in a region (as 5 x 5 points in each Bézier "
          "element tell), and as few others as it takes to stay analysis-suitable. The surface stays "
          "the same. Without a condition all faces are divided; of several all must hold.")
          .key("where", &RefineKeys::condition,
               {.text = "An expression in x, y, z, such as \"z > 0.5\"; places are those before the transform of the "
                        "shape."})
          .key("box", &RefineKeys::box, {.text = "Two opposite corners of a box along the axes."})
          .key("u", &RefineKeys::u, {.text = "A range of the first parameter."})
          .key("v", &RefineKeys::v, {.text = "A range of the second parameter."})
          .key("levels", &RefineKeys::levels,
               {.text = "How often; each time the faces are chosen anew.", .range = Range::between(1, 20)})
          .choice("direction", &RefineKeys::direction,
                  {{"both", Bisection::both}, {"u", Bisection::u}, {"v", Bisection::v}},
                  {.text = "The direction in which faces are halved."})
          .check(check_region);
  return declared;
}

template <>
const Schema<TSplineKeys>& schema<TSplineKeys>() {
  static const auto declared =
      with_common_keys(
          Schema<TSplineKeys>("tspline",
                              "T-splines: one by its T-mesh, or those of NURBS patches; geometry/tspline/README.md "
                              "explains them. [output] svg = true draws the T-meshes with numbered anchors.")
              .key("from", &TSplineKeys::from,
                   {.text = "NURBS surfaces or solids, each patch of which becomes a T-spline, exactly."})
              .key("degrees", &TSplineKeys::degrees,
                   {.text = "In u and v. With \"from\": the degree is raised to these where it is lower.",
                    .range = Range::between(1, 30)})
              .key("knots_u", &TSplineKeys::knots_u,
                   {.text = "All knots that lines of the T-mesh have, as for NURBS: with degree + 1 equal ones at both "
                            "ends of a surface that begins and ends at control points."})
              .key("knots_v", &TSplineKeys::knots_v, {.text = "The same in v."})
              .key("lines_u", &TSplineKeys::lines_u,
                   {.text = "Lines u = at that do not run through, by the parts that are there; lines that are not "
                            "listed run from side to side."})
              .key("lines_v", &TSplineKeys::lines_v, {.text = "The same for lines v = at."})
              .key("points", &TSplineKeys::points,
                   {.text = "One control point (Cartesian) for each anchor: vertices of the T-mesh for odd degrees, "
                            "faces for even ones, edges for mixed ones; by rising v, for equal v by rising u."})
              .key("weights", &TSplineKeys::weights,
                   {.text = "One a control point; all 1 if absent.", .range = Range::above(0)})
              .key("homogeneous", &TSplineKeys::homogeneous,
                   {.text = "Instead of points and weights: (w x, w y, w z, w)."})
              .key("refine", &TSplineKeys::refine, {.text = "Local refinement; a list is applied in its order."}))
          .check(check_tspline);
  return declared;
}

}  // namespace isorim::io
