#include "geometry/propeller/blade_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/spline/interpolation.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {
namespace {

bool is_point(const BladeSection& section) {
  return ((section.outline.colwise() - section.outline.col(0)).array() == 0.0).all();
}

/// Chord lengths along the outline, scaled to [0, 1]. Right-handed: the hand changes no length.
std::vector<double> chord_parameters(const BladeSection& section, std::size_t index) {
  const Points<3> points = outline_in_space(section);
  std::vector<double> parameters{0.0};
  for (Eigen::Index i = 1; i < points.cols(); ++i) {
    const double step = (points.col(i) - points.col(i - 1)).norm();
    if (!(step > 0.0))
      throw GeometryError(fmt::format("blade section {}: points {} and {} coincide", index + 1, i, i + 1));
    parameters.push_back(parameters.back() + step);
  }
  for (double& u : parameters) u /= parameters.back();
  parameters.back() = 1.0;
  return parameters;
}

void check_sections(std::span<const BladeSection> sections, int degree) {
  if (sections.size() < 2)
    throw GeometryError(fmt::format("blade: {} section(s), at least 2 are needed", sections.size()));
  const Eigen::Index count = sections.front().outline.cols();
  if (count <= degree)
    throw GeometryError(fmt::format("blade: sections of {} points cannot carry degree {}", count, degree));
  for (std::size_t k = 0; k < sections.size(); ++k) {
    if (!sections[k].outline.allFinite())
      throw GeometryError(fmt::format("blade section {}: a point is not finite", k + 1));
    if (sections[k].outline.cols() != count) {
      throw GeometryError(fmt::format("blade section {} has {} points, the first one {}; expected the same number",
                                      k + 1, sections[k].outline.cols(), count));
    }
    if (k > 0 && !(sections[k].station.radius > sections[k - 1].station.radius)) {
      throw GeometryError(fmt::format("blade section {}: the radius {} does not exceed {}, that of the one before",
                                      k + 1, sections[k].station.radius, sections[k - 1].station.radius));
    }
    if (k + 1 < sections.size() && is_point(sections[k]))
      throw GeometryError(fmt::format("blade section {} is one point; only the last one may be", k + 1));
  }
}

/// Chord lengths in space, the means over the sections that are not a point.
std::vector<double> outline_parameters(std::span<const BladeSection> sections) {
  std::vector<double> means;
  std::size_t count = 0;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    if (is_point(sections[k])) continue;
    const std::vector<double> own = chord_parameters(sections[k], k);
    means.resize(own.size(), 0.0);
    for (std::size_t i = 0; i < own.size(); ++i) means[i] += own[i];
    ++count;
  }
  for (double& u : means) u /= static_cast<double>(count);
  if (!means.empty()) means.back() = 1.0;
  return means;
}

NurbsCurve<3> interpolate_outline(const BladeSection& section, const std::vector<double>& parameters,
                                  const BladeSurfaceOptions& options) {
  const KnotVector knots = averaged_knots(options.degree, parameters);
  const BSpline spline = interpolate(knots, parameters, outline_in_space(section, options.hand));
  return NurbsCurve<3>::from_points(spline.knots, spline.coefficients);
}

/// The means over the points of the distances between neighbouring outlines, scaled to [0, 1].
std::vector<double> chord_lengths_across(std::span<const BladeSection> sections) {
  std::vector<double> parameters{0.0};
  for (std::size_t k = 1; k < sections.size(); ++k) {
    const Points<3> step = outline_in_space(sections[k]) - outline_in_space(sections[k - 1]);
    parameters.push_back(parameters.back() + step.colwise().norm().mean());
  }
  for (double& v : parameters) v /= parameters.back();
  parameters.back() = 1.0;
  return parameters;
}

std::vector<double> rounded_tip_parameters(std::span<const BladeSection> sections) {
  const double tip = sections.back().station.radius;
  const double root = sections.front().station.radius;
  std::vector<double> parameters;
  for (const BladeSection& section : sections)
    parameters.push_back(1.0 - std::sqrt((tip - section.station.radius) / (tip - root)));
  return parameters;
}

/// The polynomial surface through curves on one knot vector, at parameters across them.
NurbsSurface<3> skin(std::span<const NurbsCurve<3>> curves, const std::vector<double>& parameters, int degree) {
  const KnotVector across = averaged_knots(std::min(degree, static_cast<int>(curves.size()) - 1), parameters);
  const Eigen::Index width = 3 * curves.front().control_points().cols();
  Eigen::MatrixXd rows(width, static_cast<Eigen::Index>(curves.size()));
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Points<3> points = curves[k].control_points();
    rows.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::VectorXd>(points.data(), width);
  }
  const BSpline net = interpolate(across, parameters, rows);
  const Eigen::Map<const Points<3>> points(net.coefficients.data(), 3, net.coefficients.size() / 3);
  return NurbsSurface<3>::from_points(curves.front().knots(), across, points);
}

/// Between the back and the face along one edge of the blade's surface.
NurbsSurface<3> ruled_across(const NurbsCurve<3>& outline, double leading_edge) {
  const auto [back, face] = split(outline, leading_edge);
  return ruled(back, reverse(face));
}

/// Relative to the coordinates: what interpolation leaves of equal points.
constexpr double same_point = 1e-12;

bool is_point(const NurbsCurve<3>& edge) {
  const Points<3> points = edge.control_points();
  return (points.colwise() - points.col(0)).cwiseAbs().maxCoeff() <= same_point * points.cwiseAbs().maxCoeff();
}

bool coincide(const NurbsCurve<3>& a, const NurbsCurve<3>& b) {
  const Points<3> points = a.control_points();
  return (points - b.control_points()).cwiseAbs().maxCoeff() <= same_point * points.cwiseAbs().maxCoeff();
}

}  // namespace

std::vector<double> parameters_across(std::span<const BladeSection> sections) {
  check_sections(sections, 1);
  return is_point(sections.back()) ? rounded_tip_parameters(sections) : chord_lengths_across(sections);
}

BladeSkin skin_blade(std::span<const BladeSection> sections, const BladeSurfaceOptions& options) {
  check_sections(sections, options.degree);
  const std::vector<double> common = outline_parameters(sections);
  const bool has_own = options.fit == BladeFit::own_parameters;
  std::vector<NurbsCurve<3>> outlines;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const bool takes_own = has_own && !is_point(sections[k]);
    outlines.push_back(
        interpolate_outline(sections[k], takes_own ? chord_parameters(sections[k], k) : common, options));
  }
  apply_edits(options.edits, outlines);
  BladeKnots knots;
  if (has_own) {
    UniformSections uniform = uniformise(outlines, options.uniformisation);
    knots.merged_control_points = options.uniformisation.method == Uniformisation::merge
                                      ? uniform.control_points
                                      : uniformise(outlines, {}).control_points;
    knots.inserted = uniform.inserted;
    knots.removed = uniform.removed;
    knots.removal_error = uniform.error_bound;
    outlines = std::move(uniform.sections);
  }
  NurbsSurface<3> surface = skin(outlines, parameters_across(sections), options.degree);
  knots.control_points_round = surface.count_u();
  knots.control_points_across = surface.count_v();
  if (!has_own) knots.merged_control_points = knots.control_points_round;
  return {std::move(surface), knots};
}

NurbsSurface<3> blade_surface(std::span<const BladeSection> sections, const BladeSurfaceOptions& options) {
  return skin_blade(sections, options).surface;
}

double leading_edge_parameter(std::span<const BladeSection> sections) {
  return outline_parameters(sections)[static_cast<std::size_t>(sections.front().leading_edge_point)];
}

Boundary<3> close_blade(const NurbsSurface<3>& surface, double leading_edge) {
  const std::array<NurbsCurve<3>, 4> edges = boundary_curves(surface);
  Boundary<3> blade{{{"blade", surface}, {"root", ruled_across(edges[0], leading_edge)}}};
  if (!is_point(edges[2])) blade.patches.push_back({"tip", ruled_across(edges[2], leading_edge)});
  if (!coincide(edges[1], edges[3])) blade.patches.push_back({"trailing_edge", ruled(edges[3], edges[1])});
  OrientedBoundary<3> oriented = orient(blade);
  require_closed(oriented);
  return std::move(oriented.boundary);
}

Boundary<3> blade_solid(std::span<const BladeSection> sections, const BladeSurfaceOptions& options) {
  return close_blade(blade_surface(sections, options), leading_edge_parameter(sections));
}

}  // namespace isorim::geometry
