#include "geometry/fitting/fit_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/section_rules.h"

namespace isorim::geometry {

namespace {

template <int Dim>
void require_points(const Points<Dim>& points) {
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (int d = 0; d < Dim; ++d)
      if (!std::isfinite(points(d, i)))
        throw GeometryError(fmt::format("curve fit: coordinate {} of point {} is {}", "xyz"[d], i, points(d, i)));
  if (points.cols() < 2)
    throw GeometryError(fmt::format("curve fit: {} point(s) given; expected 2 or more", points.cols()));
}

template <int Dim>
void require_weights(const CurveFitOptions<Dim>& options, Eigen::Index count) {
  if (options.weights != FitWeights::given) {
    if (!options.point_weights.empty())
      throw GeometryError("curve fit: weights of points are given, but another rule for weights is asked for");
    return;
  }
  if (options.point_weights.size() != static_cast<std::size_t>(count))
    throw GeometryError(
        fmt::format("curve fit: {} weights for {} points; expected one each", options.point_weights.size(), count));
  for (std::size_t i = 0; i < options.point_weights.size(); ++i)
    if (!(options.point_weights[i] > 0.0 && std::isfinite(options.point_weights[i])))
      throw GeometryError(
          fmt::format("curve fit: weight {} of point {} is not positive and finite", options.point_weights[i], i));
}

template <int Dim>
bool by_curvature(const CurveFitOptions<Dim>& options) {
  const bool result = options.weights == FitWeights::curvature_radius ||
                      (options.weights == FitWeights::automatic && options.method == FitMethod::pereira);
  if (result && !options.closed)
    throw GeometryError("curve fit: weights by the radius of curvature are for closed curves only");
  return result;
}

/// Leaves out points equal to their predecessor (and, of a closed curve, a last one equal to the first).
template <int Dim>
std::vector<Eigen::Index> distinct_points(const Points<Dim>& points, bool closed, std::vector<int>& index) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (kept.empty() || points.col(i) != points.col(kept.back())) kept.push_back(i);
    index[static_cast<std::size_t>(i)] = static_cast<int>(kept.size()) - 1;
  }
  while (closed && kept.size() > 1 && points.col(kept.back()) == points.col(kept.front())) {
    const int dropped = static_cast<int>(kept.size()) - 1;
    kept.pop_back();
    std::replace(index.begin(), index.end(), dropped, 0);
  }
  if (kept.size() < 2)
    throw GeometryError(fmt::format("curve fit: all {} points are the same; expected a curve", points.cols()));
  return kept;
}

/// Points at which the polygon turns by more than the angle; the ends of an open one are none.
template <int Dim>
std::vector<int> find_corners(const Points<Dim>& points, const CurveFitOptions<Dim>& options) {
  if (options.corner_angle == 0.0) return {};
  const double largest_cosine = std::cos(options.corner_angle * std::numbers::pi / 180.0);
  const Eigen::Index count = points.cols();
  struct Turn {
    double cosine;
    int point;
  };
  std::vector<Turn> turns;
  for (Eigen::Index i = options.closed ? 0 : 1; i < (options.closed ? count : count - 1); ++i) {
    const Vector<Dim> in = points.col(i) - points.col((i + count - 1) % count);
    const Vector<Dim> out = points.col((i + 1) % count) - points.col(i);
    const double cosine = in.dot(out) / (in.norm() * out.norm());
    if (cosine < largest_cosine) turns.push_back({cosine, static_cast<int>(i)});
  }
  // The sharpest first. From one corner to the next there must be as many steps as the degree: noise makes two of one.
  std::stable_sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) { return a.cosine < b.cosine; });
  std::vector<int> corners;
  for (const Turn& turn : turns) {
    const bool is_near = std::any_of(corners.begin(), corners.end(), [&](int corner) {
      const int steps = std::abs(turn.point - corner);
      return std::min(steps, options.closed ? static_cast<int>(count) - steps : steps) < options.degree;
    });
    if (!is_near) corners.push_back(turn.point);
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

template <int Dim>
void turn_to(int start, PreparedPoints<Dim>& prepared) {
  if (start == 0) return;
  Points<Dim>& points = prepared.data.points;
  const int count = static_cast<int>(points.cols());
  const Points<Dim> head = points.leftCols(start);
  const Points<Dim> tail = points.rightCols(count - start);
  points << tail, head;
  std::vector<double>& weights = prepared.data.weights;
  std::rotate(weights.begin(), weights.begin() + start, weights.end());
  for (int& i : prepared.index) i = (i + count - start) % count;
  for (int& corner : prepared.corners) corner -= start;
}

double step_of(double chord, FitParameters rule) {
  switch (rule) {
    case FitParameters::chord_length:
      return chord;
    case FitParameters::centripetal:
      return std::sqrt(chord);
    case FitParameters::uniform:
      return 1.0;
  }
  return chord;
}

/// Parameters by the rule, and the length of the polygon.
template <int Dim>
void give_parameters(FitParameters rule, PreparedPoints<Dim>& prepared) {
  const Points<Dim>& points = prepared.data.points;
  const std::size_t count = static_cast<std::size_t>(points.cols());
  std::vector<double>& parameters = prepared.parameters;
  parameters.assign(count, 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < (prepared.closed ? count : count - 1); ++i) {
    parameters[i] = sum;
    const Eigen::Index here = static_cast<Eigen::Index>(i);
    const double chord = (points.col((here + 1) % points.cols()) - points.col(here)).norm();
    prepared.length += chord;
    sum += step_of(chord, rule);
  }
  if (!prepared.closed) parameters.back() = sum;
  if (!(sum > 0.0 && std::isfinite(sum))) throw GeometryError("curve fit: the points span no length that can be told");
  for (double& u : parameters) u /= sum;
}

}  // namespace

template <int Dim>
PreparedPoints<Dim> prepare_points(const Points<Dim>& points, const CurveFitOptions<Dim>& options) {
  require_points(points);
  require_weights(options, points.cols());
  PreparedPoints<Dim> prepared;
  prepared.closed = options.closed;
  prepared.index.resize(static_cast<std::size_t>(points.cols()));
  const std::vector<Eigen::Index> kept = distinct_points(points, options.closed, prepared.index);
  prepared.data.points = points(Eigen::all, kept);
  std::vector<double>& weights = prepared.data.weights;
  weights.assign(kept.size(), 0.0);
  for (std::size_t i = 0; i < prepared.index.size(); ++i)
    weights[static_cast<std::size_t>(prepared.index[i])] +=
        options.weights == FitWeights::given ? options.point_weights[i] : 1.0;
  if (by_curvature(options)) weights = curvature_weights(circle_radii(prepared.data.points));
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  for (double& weight : weights) weight /= mean;
  prepared.corners = find_corners(prepared.data.points, options);
  if (options.closed && !prepared.corners.empty()) turn_to(prepared.corners.front(), prepared);
  give_parameters(options.parameters, prepared);
  return prepared;
}

template PreparedPoints<2> prepare_points(const Points<2>&, const CurveFitOptions<2>&);
template PreparedPoints<3> prepare_points(const Points<3>&, const CurveFitOptions<3>&);

}  // namespace isorim::geometry
