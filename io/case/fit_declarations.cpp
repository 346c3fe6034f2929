#include "io/case/shape_schema.h"

/// The declarations of shapes that are fitted to measured points.
namespace isorim::io {
namespace {

using geometry::BodyEnds;
using geometry::FitKnots;
using geometry::FitMethod;
using geometry::FitParameters;
using geometry::StartRule;
using geometry::Uniformisation;

void check_source(const FitKeys& fit, const KeyPlace& where, Complaints& complaints) {
  if (fit.points.empty() == fit.sections.empty()) {
    complaints.add(where, fmt::format("found {}; expected exactly one of \"points\" and \"sections\"",
                                      fit.points.empty() ? "neither" : "both"));
  }
  if (fit.slices && !fit.sections.empty()) {
    complaints.add(fit.slices->where, "found \"slices\" beside \"sections\"; slices are cut from a cloud, \"points\"");
  }
  if (!fit.heights.empty() && fit.heights.size() != fit.sections.size()) {
    complaints.add(where, fmt::format("found {} heights for {} sections; expected one each", fit.heights.size(),
                                      fit.sections.size()));
  }
}

void check_curves(const FitKeys& fit, const KeyPlace& where, Complaints& complaints) {
  if (fit.control_points && fit.tolerance) {
    complaints.add(where, "found both \"control_points\" and \"tolerance\"; expected at most one of them");
  }
  if (fit.control_points && *fit.control_points <= fit.degree) {
    complaints.add(where, fmt::format("found control_points = {} for degree {}; expected at least {}",
                                      *fit.control_points, fit.degree, fit.degree + 1));
  }
  if (fit.method == FitMethod::pereira && (!fit.closed || fit.degree != 3)) {
    complaints.add(where, "found method = \"pereira\"; it makes closed curves of degree 3 alone");
  }
  if (fit.order == PointOrder::as_given && fit.cell) {
    complaints.add(where,
                   "found \"cell\"; the order of the centroids of cells has to be found: expected order = "
                   "\"contours\" or \"density\" beside it");
  }
  if (fit.weights == "counts" && fit.order == PointOrder::as_given) {
    complaints.add(where,
                   "found weights = \"counts\" with points as given, which have none; expected order = "
                   "\"contours\" or \"density\" beside it");
  }
}

void check_body(const FitKeys& fit, const KeyPlace& where, Complaints& complaints) {
  if (!fit.is_body()) {
    if (fit.start_tip || fit.end_tip || fit.ends == BodyEnds::closed || !fit.heights.empty()) {
      complaints.add(where,
                     "found a key of bodies (ends, start_tip, end_tip, heights) without sections: expected "
                     "\"sections\" or \"slices\"");
    }
    return;
  }
  if (!fit.closed) complaints.add(where, "found closed = false; the sections of a body are closed");
  if (fit.slices && fit.order == PointOrder::as_given) {
    complaints.add(where,
                   "found \"slices\" with points as given; the points of a slice have no order: expected order "
                   "= \"contours\" or \"density\"");
  }
  if (fit.ends == BodyEnds::closed && (fit.start_tip || fit.end_tip)) {
    complaints.add(where, "found a tip and ends = \"closed\"; a closed body has no tips");
  }
  if (fit.ends == BodyEnds::closed && fit.degree_across % 2 == 0) {
    complaints.add(where, fmt::format("found degree_across = {}; closed bodies need an odd one", fit.degree_across));
  }
}

}  // namespace

template <>
const Schema<SliceKeys>& schema<SliceKeys>() {
  static const auto declared =
      Schema<SliceKeys>("slices", "How a cloud is cut into sections.")
          .choice("axis", &SliceKeys::axis, {{"x", 0}, {"y", 1}, {"z", 2}}, {.text = "The slices lie across it."})
          .key("thickness", &SliceKeys::thickness,
               {.text = "Of a slice; its points are taken to lie in one plane, at their mean height.",
                .unit = "length",
                .range = Range::above(0),
                .presence = required});
  return declared;
}

template <>
const Schema<FitKeys>& schema<FitKeys>() {
  static const auto declared = with_common_keys(
      Schema<FitKeys>("fit",
                      "B-spline curves fitted to measured points: a region of the plane, or, with sections or slices, "
                      "the body through them. Files hold lines of x, y or x, y, z, and a weight if there is one: a "
                      "first line of names may say which column is what.")
          .key("points", &FitKeys::points, {.text = "The file of points of a contour, or of a cloud."})
          .key("sections", &FitKeys::sections, {.text = "The files of the sections of a body, in their order."})
          .key("heights", &FitKeys::heights,
               {.text = "The z of each section, for files of x, y alone.", .unit = "length"})
          .key("slices", &FitKeys::slices, {.text = "Cuts a cloud (\"points\") into the sections of a body."})
          .choice("order", &FitKeys::order,
                  {{"as_given", PointOrder::as_given},
                   {"contours", PointOrder::contours},
                   {"density", PointOrder::density}},
                  {.text = "contours: points in no order, noisy or not, are put into that of the contours (shortest "
                           "tours). density: by the rule of counts and distances, from cell to cell."})
          .key("cell", &FitKeys::cell,
               {.text = "The sizes dx, dy of the cells whose points are replaced by their centroid. Without it, more "
                        "than 6000 points are reduced to no more.",
                .unit = "length",
                .range = Range::above(0)})
          .key("largest_gap", &FitKeys::largest_gap,
               {.text = "order = \"contours\": ends are joined across gaps up to this part of the contour's length.",
                .range = Range::between(0, 1)})
          .key("least_points", &FitKeys::least_points,
               {.text = "order = \"contours\": groups of fewer points are left out.", .range = Range::at_least(3)})
          .key("reach", &FitKeys::reach,
               {.text = "order = \"density\": how many cells the next one may be away.",
                .unit = "cells",
                .range = Range::at_least(1)})
          .key("closed", &FitKeys::closed, {.text = "The last point is followed by the first."})
          .key("degree", &FitKeys::degree, {.text = "Of the curves.", .range = Range::between(1, 15)})
          .key("control_points", &FitKeys::control_points,
               {.text = "Number of distinct ones of each curve. Without it and without a tolerance: the number of "
                        "changes of the curvature's sign, but at least half as many as points.",
                .range = Range::at_least(2)})
          .key("tolerance", &FitKeys::tolerance,
               {.text = "The largest distance of a point from its curve; as few control points as it takes.",
                .unit = "length",
                .range = Range::above(0)})
          .key("weights", &FitKeys::weights,
               {.text = "\"uniform\", \"curvature\" (large where the curve bends), \"counts\" (of the cells), or a "
                        "file with one weight a line. If absent, the column of weights of the file of points, else "
                        "uniform."})
          .choice("method", &FitKeys::method,
                  {{"free", FitMethod::free}, {"fixed_knots", FitMethod::fixed_knots}, {"pereira", FitMethod::pereira}},
                  {.text = "free: parameters and knots are improved. fixed_knots: linear least squares. pereira: as in "
                           "the dissertation of L. R. Pereira (2014). Sections of a body, of one contour each, share "
                           "their knots. Default: free."})
          .choice("parameters", &FitKeys::parameters,
                  {{"chord_length", FitParameters::chord_length},
                   {"centripetal", FitParameters::centripetal},
                   {"uniform", FitParameters::uniform}},
                  {.text = "Of the points, at first."})
          .choice(
              "knots", &FitKeys::knots,
              {{"uniform", FitKnots::uniform},
               {"averaging", FitKnots::averaging},
               {"piegl_tiller", FitKnots::piegl_tiller}},
              {.text =
                   "Of the curves. uniform: the knots that method = \"free\" starts from, and moves. On the others it "
                   "improves the parameters alone."})
          .key("corrections", &FitKeys::corrections,
               {.text = "method = \"fixed_knots\": how often parameters move to the nearest points of the curve.",
                .range = Range::between(0, 1000)})
          .key("knot_steps", &FitKeys::knot_steps,
               {.text = "method = \"free\": steps in which knots, parameters and control points are improved together. "
                        "More of them bring the curve nearer.",
                .range = Range::between(0, 1000)})
          .key("peak_steps", &FitKeys::peak_steps,
               {.text = "method = \"free\": steps in which the largest distance is lowered at little cost of the "
                        "others. 8, with knot_steps = 8, take four to six times the time.",
                .range = Range::between(0, 1000)})
          .key("fairness", &FitKeys::fairness,
               {.text = "Factor of the integral of the squared third derivative over the parameters 0 to 1, which is "
                        "added to the mean squared distance. 0: method = \"free\" chooses one, the others take none.",
                .range = Range::at_least(0)})
          .key("corner_angle", &FitKeys::corner_angle,
               {.text = "Points at which the data turn by more become corners; 0: none.",
                .unit = "degrees",
                .range = Range::between(0, 180)})
          .choice("ends", &FitKeys::ends, {{"caps", BodyEnds::caps}, {"closed", BodyEnds::closed}},
                  {.text = "Of a body. caps: plane caps on the first and the last section. closed: the last section is "
                           "followed by the first, as of a ring."})
          .key("start_tip", &FitKeys::start_tip, {.text = "A body begins in this point instead of a cap."})
          .key("end_tip", &FitKeys::end_tip, {.text = "A body ends in this point instead of a cap."})
          .key("degree_across", &FitKeys::degree_across,
               {.text = "Of a body, across its sections.", .range = Range::between(1, 15)})
          .choice("start", &FitKeys::start,
                  {{"least_twist", StartRule::least_twist},
                   {"closest", StartRule::closest},
                   {"as_given", StartRule::as_given}},
                  {.text = "Where the sections of a body start: where neighbours twist least, nearest to the one "
                           "before, or in the first point."})
          .choice("uniformisation", &FitKeys::uniformisation,
                  {{"merge", Uniformisation::merge}, {"insert_and_remove", Uniformisation::insert_and_remove}},
                  {.text = "How the sections of a body come to the same knots: all those of all sections, or even ones "
                           "and what cannot be removed."})
          .key("inserted_knots", &FitKeys::inserted_knots,
               {.text = "uniformisation = \"insert_and_remove\": number of even knots.", .range = Range::at_least(1)})
          .key("removal_tolerance", &FitKeys::removal_tolerance,
               {.text = "uniformisation = \"insert_and_remove\": by how much it may move any point of a section.",
                .unit = "length",
                .range = Range::at_least(0)})
          .check(check_source)
          .check(check_curves)
          .check(check_body));
  return declared;
}

}  // namespace isorim::io
