#include "io/fit/fit_shape.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/contour_ordering.h"
#include "geometry/fitting/point_reduction.h"
#include "geometry/fitting/section_alignment.h"
#include "geometry/fitting/section_fit.h"
#include "geometry/fitting/section_solid.h"
#include "io/case/curve_builder.h"
#include "io/case/face_builder.h"
#include "io/fit/point_table.h"
#include "io/fit/section_plane.h"

namespace isorim::io {
namespace {

using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using Clock = std::chrono::steady_clock;

/// More points than this are reduced to no more before they are ordered.
constexpr int most_points_to_order = 6000;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The points of a contour in order, in the plane of its section.
struct ContourPoints {
  Points<2> points;
  /// One a point, or empty.
  std::vector<double> weights;
  bool closed = true;
};

/// A section as it was measured, and its contours.
struct MeasuredSection {
  /// What messages and results call it.
  std::string name;
  SectionPlane plane;
  Points<2> points;
  /// From the file; empty if it has none.
  std::vector<double> weights;
  std::vector<ContourPoints> contours;
};

/// Errors say which section they are about.
template <class Action>
auto named(const std::string& name, Action&& action) {
  try {
    return action();
  } catch (Error& error) {
    error.add_context(name);
    throw;
  }
}

class FitBuilder {
 public:
  explicit FitBuilder(const FitKeys& keys) : keys_(keys) {}

  FitShape build() {
    read();
    order();
    if (keys_.is_body()) align();
    fit_all();
    return {keys_.is_body() ? AnyBoundary(body()) : AnyBoundary(region()), std::move(facts_)};
  }

 private:
  // --- Reading ------------------------------------------------------------------------------------------------

  std::filesystem::path path_of(const std::string& name) const {
    const std::filesystem::path path(name);
    return path.is_absolute() ? path : keys_.folder / path;
  }

  void read() {
    if (keys_.slices) {
      read_cloud();
    } else if (keys_.is_body()) {
      for (std::size_t k = 0; k < keys_.sections.size(); ++k) read_section(k);
    } else {
      read_region();
    }
    if (is_weight_file()) {
      if (sections_.size() > 1)
        throw InputError("found a file of weights for several sections; expected a column of weights in each");
      sections_.front().weights = read_weights(path_of(keys_.weights));
      const auto count = static_cast<std::size_t>(sections_.front().points.cols());
      if (sections_.front().weights.size() != count) {
        throw InputError(fmt::format("{}: found {} weights for {} points; expected one each",
                                     path_of(keys_.weights).string(), sections_.front().weights.size(), count));
      }
    }
  }

  bool is_weight_file() const {
    return !keys_.weights.empty() && keys_.weights != "uniform" && keys_.weights != "curvature" &&
           keys_.weights != "counts";
  }

  void read_region() {
    PointTable table = read_points(path_of(keys_.points));
    facts_.points_read = static_cast<int>(table.points.cols());
    const double low = table.points.row(2).minCoeff();
    const double high = table.points.row(2).maxCoeff();
    const double size = (table.points.rowwise().maxCoeff() - table.points.rowwise().minCoeff()).norm();
    if (high - low > 1e-9 * size) {
      throw InputError(
          fmt::format("{}: found z from {} to {}; a contour lies in one plane: expected \"slices\" for a "
                      "cloud, or \"sections\" with a file for each",
                      table.name, low, high));
    }
    sections_.push_back({"contour", {}, table.points.topRows<2>(), std::move(table.weights), {}});
  }

  void read_section(std::size_t k) {
    PointTable table = read_points(path_of(keys_.sections[k]));
    facts_.points_read += static_cast<int>(table.points.cols());
    if (table.has_z && !keys_.heights.empty())
      throw InputError(fmt::format("{}: found x, y and z; \"heights\" are for files of x, y alone", table.name));
    MeasuredSection section;
    section.name = keys_.sections[k];
    section.weights = std::move(table.weights);
    if (table.has_z) {
      const PlaneOfPoints plane = named(table.name, [&] { return plane_of_points(table.points); });
      facts_.body.off_plane = std::max(facts_.body.off_plane, plane.off_plane);
      section.plane = plane.plane;
      section.points = plane.points;
    } else if (!keys_.heights.empty()) {
      section.plane.origin.z() = keys_.heights[k];
      section.points = table.points.topRows<2>();
    } else {
      throw InputError(fmt::format("{}: found x, y alone; expected x, y, z, or the key \"heights\"", table.name));
    }
    sections_.push_back(std::move(section));
  }

  void read_cloud() {
    const PointTable table = read_points(path_of(keys_.points));
    facts_.points_read = static_cast<int>(table.points.cols());
    if (!table.has_z) {
      throw InputError(fmt::format("{}: found x, y alone; expected x, y, z to cut slices from", table.name));
    }
    const int axis = keys_.slices->axis;
    for (geometry::Slice& slice : geometry::slice_cloud(table.points, axis, keys_.slices->thickness)) {
      MeasuredSection section;
      section.name = fmt::format("{} = {:.6g}", "xyz"[axis], slice.position);
      const auto at = [&](double x, double y) { return geometry::in_space({x, y}, axis, slice.position); };
      section.plane = {at(0.0, 0.0), at(1.0, 0.0) - at(0.0, 0.0), at(0.0, 1.0) - at(0.0, 0.0)};
      section.points = std::move(slice.points);
      if (!table.weights.empty()) {
        for (const int i : slice.indices) section.weights.push_back(table.weights[static_cast<std::size_t>(i)]);
      }
      sections_.push_back(std::move(section));
    }
  }

  // --- Order --------------------------------------------------------------------------------------------------

  void order() {
    const Clock::time_point start = Clock::now();
    for (MeasuredSection& section : sections_) {
      if (keys_.order == PointOrder::as_given) {
        facts_.points_reduced += static_cast<int>(section.points.cols());
        section.contours.push_back({section.points, section.weights, keys_.closed});
      } else {
        named(section.name, [&] { order_section(section); });
      }
    }
    for (const auto& [reason, count] : dropped_) facts_.dropped.emplace_back(reason, count);
    facts_.ordering_seconds = seconds_since(start);
  }

  void order_section(MeasuredSection& section) {
    if (!section.weights.empty()) {
      throw InputError(
          "found weights of single points, which have none left once they are put in order; expected files without "
          "weights, and weights = \"uniform\", \"counts\" or \"curvature\"");
    }
    geometry::ReducedPoints reduced = reduced_points(section.points);
    facts_.points_reduced += static_cast<int>(reduced.points.cols());
    geometry::OrderedContours ordered = ordered_contours(reduced);
    facts_.thinned = facts_.thinned || ordered.thinned;
    report_doubt(section.name, ordered);
    for (const geometry::DroppedPoint& point : ordered.dropped) {
      dropped_[drop_reason_name(point.reason)] += reduced.counts[static_cast<std::size_t>(point.index)];
    }
    for (geometry::Contour& contour : ordered.contours) {
      if (keys_.closed && !contour.closed) report_open(section.name, contour);
      std::vector<double> weights;
      if (keys_.weights == "counts") weights = std::move(contour.weights);
      section.contours.push_back({std::move(contour.points), std::move(weights), contour.closed});
    }
  }

  geometry::ReducedPoints reduced_points(const Points<2>& points) const {
    if (keys_.cell) return geometry::reduce_points(points, *keys_.cell);
    if (keys_.order == PointOrder::density || points.cols() > most_points_to_order)
      return geometry::reduce_points(points, geometry::automatic_cell_size(points, most_points_to_order));
    geometry::ReducedPoints all;
    all.points = points;
    all.counts.assign(static_cast<std::size_t>(points.cols()), 1);
    return all;
  }

  geometry::OrderedContours ordered_contours(const geometry::ReducedPoints& reduced) const {
    if (keys_.order == PointOrder::density) return geometry::order_by_density(reduced, {.reach = keys_.reach});
    geometry::OrderingOptions options;
    options.ends = keys_.closed ? geometry::ContourEnds::automatic : geometry::ContourEnds::open;
    options.largest_gap = keys_.largest_gap;
    options.least_points = keys_.least_points;
    return geometry::order_contours(reduced.points, reduced.counts, options);
  }

  void report_doubt(const std::string& name, const geometry::OrderedContours& ordered) {
    constexpr double negligible = 0.02;
    if (ordered.doubtful_share <= negligible) return;
    facts_.warnings.push_back(fmt::format(
        "{}: along {:.0f} % of the contours, about ({:.4g}, {:.4g}) for one, other parts of them are nearer "
        "than the noise lets tell apart; they may have been mixed up",
        name, 100.0 * ordered.doubtful_share, ordered.doubtful_place.x(), ordered.doubtful_place.y()));
  }

  void report_open(const std::string& name, const geometry::Contour& contour) {
    const Point2 first = contour.points.col(0);
    const Point2 last = contour.points.col(contour.points.cols() - 1);
    const std::string text =
        fmt::format("a contour of {} points is open: its ends ({:.6g}, {:.6g}) and ({:.6g}, {:.6g}) are {:.4g} apart",
                    contour.points.cols(), first.x(), first.y(), last.x(), last.y(), (first - last).norm());
    if (keys_.is_body()) throw InputError(text + "; expected closed ones, or a larger \"largest_gap\"");
    facts_.warnings.push_back(fmt::format("{}: {}", name, text));
  }

  // --- Curves -------------------------------------------------------------------------------------------------

  /// Sections of one contour each start in corresponding points, so that equal knots suit all of them.
  void align() {
    for (const MeasuredSection& section : sections_) {
      if (section.contours.size() != 1) return;
    }
    std::vector<Points<3>> polygons;
    for (const MeasuredSection& section : sections_) {
      const Points<2>& points = section.contours.front().points;
      Points<3> polygon(3, points.cols());
      for (Eigen::Index i = 0; i < points.cols(); ++i) polygon.col(i) = section.plane.place(points.col(i));
      polygons.push_back(std::move(polygon));
    }
    const std::vector<geometry::PolygonAlignment> done = geometry::align_polygons(polygons, keys_.start);
    for (std::size_t k = 0; k < sections_.size(); ++k) apply(done[k], sections_[k].contours.front());
    aligned_ = true;
  }

  static void apply(const geometry::PolygonAlignment& alignment, ContourPoints& contour) {
    std::vector<int> order(static_cast<std::size_t>(contour.points.cols()));
    std::iota(order.begin(), order.end(), 0);
    if (alignment.reversed) std::ranges::reverse(order);
    std::rotate(order.begin(), order.begin() + alignment.first, order.end());
    contour.points = contour.points(Eigen::all, order).eval();
    if (contour.weights.empty()) return;
    const std::vector<double> given = contour.weights;
    for (std::size_t i = 0; i < order.size(); ++i) contour.weights[i] = given[static_cast<std::size_t>(order[i])];
  }

  geometry::CurveFitOptions<2> options_for(const ContourPoints& contour) const {
    geometry::CurveFitOptions<2> options;
    options.method = keys_.method.value_or(geometry::FitMethod::free);
    options.closed = contour.closed;
    options.degree = keys_.degree;
    options.control_points = keys_.control_points.value_or(0);
    options.tolerance = keys_.tolerance.value_or(0.0);
    options.parameters = keys_.parameters;
    // Uniform ones are where the methods start by themselves.
    if (keys_.knots != geometry::FitKnots::uniform) options.knots = keys_.knots;
    if (keys_.weights == "curvature") {
      options.weights = geometry::FitWeights::curvature_radius;
    } else if (!contour.weights.empty() && keys_.weights != "uniform") {
      options.weights = geometry::FitWeights::given;
      options.point_weights = contour.weights;
    }
    options.parameter_corrections = keys_.corrections;
    options.knot_steps = keys_.knot_steps;
    options.peak_steps = keys_.peak_steps;
    // 0 leaves it to the method.
    if (keys_.fairness > 0.0) options.fairness = keys_.fairness;
    options.corner_angle = keys_.corner_angle;
    return options;
  }

  void fit_all() {
    const Clock::time_point start = Clock::now();
    if (aligned_) {
      fit_together();
    } else {
      for (const MeasuredSection& section : sections_) fit_contours(section);
    }
    if (keys_.tolerance)
      for (FittedCurve& curve : facts_.curves)
        curve.fit.tolerance_met = curve.fit.quality.max_distance <= *keys_.tolerance;
    facts_.seconds = seconds_since(start);
    const FitSummary all = summarise(facts_);
    if (!all.tolerance_met) {
      facts_.warnings.push_back(fmt::format("the tolerance {} is not met: a point of {} is {:.4g} from its curve",
                                            *keys_.tolerance, facts_.curves[all.worst_curve].name, all.max_distance));
    }
  }

  void fit_contours(const MeasuredSection& section) {
    for (std::size_t i = 0; i < section.contours.size(); ++i) {
      const ContourPoints& contour = section.contours[i];
      const std::string name = section.contours.size() == 1 ? section.name : fmt::format("{}_{}", section.name, i + 1);
      geometry::CurveFit<2> fit =
          named(name, [&] { return geometry::fit_points<2>(contour.points, options_for(contour)); });
      facts_.curves.push_back({name, section.plane, contour.closed, contour.points, std::move(fit)});
    }
  }

  /// Sections of one contour each get the same knots.
  void fit_together() {
    std::vector<geometry::SectionPoints> points;
    for (const MeasuredSection& section : sections_) {
      const ContourPoints& contour = section.contours.front();
      points.push_back({section.name, contour.points, options_for(contour)});
    }
    std::vector<geometry::CurveFit<2>> fits = geometry::fit_sections(points);
    for (std::size_t k = 0; k < sections_.size(); ++k) {
      const MeasuredSection& section = sections_[k];
      facts_.curves.push_back({section.name, section.plane, section.contours.front().closed,
                               section.contours.front().points, std::move(fits[k])});
    }
  }

  // --- Shapes -------------------------------------------------------------------------------------------------

  BuiltBoundary<2> region() const {
    BuiltBoundary<2> built;
    for (const FittedCurve& curve : facts_.curves) built.boundary.patches.push_back({curve.name, curve.fit.curve});
    built.boundary = finished<2>(std::move(built.boundary), keys_);
    if (!keys_.clip.items.empty()) refuse(keys_.where, "found \"clip\"; a shape of the plane cannot be clipped");
    return built;
  }

  static NurbsCurve<3> lifted(const NurbsCurve<2>& curve, const SectionPlane& plane) {
    geometry::HomogeneousPoints<3> net(4, curve.homogeneous().cols());
    for (Eigen::Index i = 0; i < net.cols(); ++i) {
      const Eigen::Vector3d point = curve.homogeneous().col(i);
      net.col(i) << point(2) * plane.origin + point(0) * plane.first + point(1) * plane.second, point(2);
    }
    return {curve.knots(), std::move(net)};
  }

  BuiltBoundary<3> body() {
    std::vector<geometry::BodySection> sections;
    if (keys_.start_tip) sections.push_back({"start_tip", {geometry::point_section(*keys_.start_tip)}});
    auto curve = facts_.curves.begin();
    for (const MeasuredSection& section : sections_) {
      geometry::BodySection& added = sections.emplace_back();
      added.name = section.name;
      for (std::size_t i = 0; i < section.contours.size(); ++i, ++curve) {
        added.loops.push_back(lifted(curve->fit.curve, curve->plane));
      }
    }
    if (keys_.end_tip) sections.push_back({"end_tip", {geometry::point_section(*keys_.end_tip)}});
    geometry::BodyOptions options;
    options.start = aligned_ ? geometry::StartRule::as_given : keys_.start;
    options.knots = {keys_.uniformisation, keys_.inserted_knots, keys_.removal_tolerance};
    options.degree = keys_.degree_across;
    options.ends = keys_.ends;
    geometry::Body body = geometry::body_of_sections(sections, options);
    facts_.body = {static_cast<int>(sections.size()),
                   body.control_points_along,
                   body.control_points_across,
                   body.knots_inserted,
                   body.knots_removed,
                   body.uniformisation_error,
                   facts_.body.off_plane};
    return {placed(std::move(body.boundary)), {}};
  }

  geometry::Boundary<3> placed(geometry::Boundary<3> solid) const {
    ShapeKeys moving;
    moving.transform = keys_.transform;
    ShapeKeys naming;
    naming.name = keys_.name;
    solid = finished<3>(std::move(solid), moving);
    if (!keys_.clip.items.empty()) solid = clipped(solid, keys_.clip, keys_.where);
    return finished<3>(std::move(solid), naming);
  }

  const FitKeys& keys_;
  FitFacts facts_;
  std::vector<MeasuredSection> sections_;
  /// By reason.
  std::map<std::string, int> dropped_;
  bool aligned_ = false;
};

}  // namespace

FitShape build_fit_shape(const FitKeys& keys) {
  const std::string where = fmt::format("{}: {}", keys.where.place.describe(), keys.where.path);
  try {
    return FitBuilder(keys).build();
  } catch (const GeometryError& error) {
    throw InputError(fmt::format("{}: {}", where, error.what()));
  } catch (InputError& error) {
    // What is refused by place has it already.
    if (!std::string_view(error.what()).starts_with(keys.where.place.describe())) error.add_context(where);
    throw;
  }
}

FitSummary summarise(const FitFacts& facts) {
  FitSummary all;
  double squares = 0.0;
  for (std::size_t k = 0; k < facts.curves.size(); ++k) {
    const FittedCurve& curve = facts.curves[k];
    const geometry::FitQuality<2>& quality = curve.fit.quality;
    const auto count = static_cast<int>(curve.points.cols());
    all.control_points += curve.fit.control_points;
    all.points += count;
    squares += count * quality.rms_distance * quality.rms_distance;
    all.bending_energy += quality.bending_energy;
    all.curvature_sign_changes += quality.curvature_sign_changes;
    all.tolerance_met = all.tolerance_met && curve.fit.tolerance_met;
    if (k > 0 && quality.max_distance <= all.max_distance) continue;
    all.max_distance = quality.max_distance;
    all.worst_curve = k;
    all.worst_point = quality.worst_point;
    all.worst_place = curve.plane.place(curve.points.col(quality.worst_point));
  }
  all.rms_distance = all.points > 0 ? std::sqrt(squares / all.points) : 0.0;
  return all;
}

}  // namespace isorim::io
