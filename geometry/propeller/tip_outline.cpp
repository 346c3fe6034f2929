#include "geometry/propeller/tip_outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/interpolation.h"

namespace isorim::geometry {
namespace {

double root_of_distance(double radius_ratio) {
  return std::sqrt(std::max(0.0, 1.0 - radius_ratio));
}

void check_rows(std::span<const double> radii, std::span<const OutlineEdges> edges) {
  if (radii.size() != edges.size())
    throw GeometryError(fmt::format("blade outline: {} rows for {} radii", edges.size(), radii.size()));
  if (radii.size() < 2)
    throw GeometryError(fmt::format("blade outline: {} row(s), at least 2 are needed", radii.size()));
  for (std::size_t k = 0; k < radii.size(); ++k) {
    if (!(radii[k] < 1.0) || (k > 0 && !(radii[k] > radii[k - 1])))
      throw GeometryError(
          fmt::format("blade outline: r/R is {} in row {}; the radii have to rise, below 1", radii[k], k + 1));
  }
}

/// At r / R = 1, Lagrange's polynomial of the middle of the chord.
double tip_place(std::span<const double> radii, std::span<const OutlineEdges> edges) {
  const std::size_t first = radii.size() - std::min<std::size_t>(4, radii.size());
  double sum = 0.0;
  for (std::size_t i = first; i < radii.size(); ++i) {
    double term = 0.5 * (edges[i].leading + edges[i].trailing);
    for (std::size_t j = first; j < radii.size(); ++j)
      if (j != i) term *= (1.0 - radii[j]) / (radii[i] - radii[j]);
    sum += term;
  }
  return sum;
}

/// Knots in the data but for those next to the ends, where the third derivative is continuous.
KnotVector interior_knots(const std::vector<double>& parameters) {
  constexpr int degree = 3;
  std::vector<double> knots(degree + 1, parameters.front());
  knots.insert(knots.end(), parameters.begin() + 2, parameters.end() - 2);
  knots.insert(knots.end(), degree + 1, parameters.back());
  return {degree, knots};
}

BSpline outline_spline(std::span<const double> radii, std::span<const OutlineEdges> edges) {
  check_rows(radii, edges);
  const std::size_t rows = radii.size();
  std::vector<double> parameters(2 * rows + 1);
  Eigen::MatrixXd places(1, static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t k = 0; k < rows; ++k) {
    const double s = root_of_distance(radii[k]);
    const std::size_t mirrored = 2 * rows - k;
    parameters[k] = -s;
    parameters[mirrored] = s;
    places(0, static_cast<Eigen::Index>(k)) = edges[k].trailing;
    places(0, static_cast<Eigen::Index>(mirrored)) = edges[k].leading;
  }
  parameters[rows] = 0.0;
  places(0, static_cast<Eigen::Index>(rows)) = tip_place(radii, edges);
  return interpolate(interior_knots(parameters), parameters, places);
}

}  // namespace

RoundedOutline::RoundedOutline(std::span<const double> radius_ratios, std::span<const OutlineEdges> edges)
    : spline_(outline_spline(radius_ratios, edges)) {}

OutlineEdges RoundedOutline::operator()(double radius_ratio) const {
  const double s = root_of_distance(radius_ratio);
  return {evaluate(spline_, s)(0), evaluate(spline_, -s)(0)};
}

std::vector<double> tip_radii(double last_radius_ratio) {
  constexpr int steps = 3;
  std::vector<double> radii;
  for (int k = steps - 1; k >= 0; --k) {
    const double part = static_cast<double>(k) / steps;
    radii.push_back(1.0 - part * part * (1.0 - last_radius_ratio));
  }
  return radii;
}

double tip_thickness_factor(double radius_ratio, double last_radius_ratio, double tip_thickness) {
  const double reach = std::sqrt(tip_thickness);
  return std::tanh(root_of_distance(radius_ratio) / reach) / std::tanh(root_of_distance(last_radius_ratio) / reach);
}

}  // namespace isorim::geometry
