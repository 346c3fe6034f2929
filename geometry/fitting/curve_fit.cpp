#include "geometry/fitting/curve_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/curve_shape.h"
#include "geometry/fitting/fit_frame.h"
#include "geometry/fitting/free_fit.h"
#include "geometry/fitting/pereira_fit.h"
#include "geometry/fitting/section_rules.h"

namespace isorim::geometry {

namespace {

template <int Dim>
FitState<Dim> fixed_knot_fit(const FitFrame<Dim>& frame, int control_points) {
  constexpr int steps = 2;
  const Fairness fairness{frame.options().fairness.value_or(0.0), frame.options().fairness_derivative};
  FitState<Dim> state = frame.first_fit(control_points, fairness);
  for (int i = 0; i < frame.options().parameter_corrections; ++i) {
    FitState<Dim> next = state;
    frame.correct_parameters(next, steps);
    if (!frame.solve(next, fairness)) break;
    state = std::move(next);
  }
  return state;
}

template <int Dim>
CurveFit<Dim> finish(const FitFrame<Dim>& frame, const FitState<Dim>& state, const Points<Dim>& points) {
  const SegmentedCurve<Dim> segments = frame.curve(state);
  CurveFit<Dim> fit{NurbsCurve<Dim>::from_points(frame.space(state.breakpoints).knots, state.control)};
  fit.quality = shape_quality(segments, frame.options().closed);
  const PreparedPoints<Dim>& prepared = frame.prepared();
  fit.parameters.resize(prepared.index.size());
  fit.distances.resize(prepared.index.size());
  for (std::size_t i = 0; i < prepared.index.size(); ++i) {
    const double guess = state.parameters[static_cast<std::size_t>(prepared.index[i])];
    const ClosestCurvePoint<Dim> nearest = segments.nearest(points.col(static_cast<Eigen::Index>(i)), guess);
    fit.parameters[i] = nearest.u;
    fit.distances[i] = nearest.distance;
  }
  add_distances<Dim>(fit.distances, fit.quality);
  fit.control_points = frame.control_points(state.breakpoints);
  fit.iterations = state.iterations;
  for (std::size_t i = 0; i < prepared.index.size(); ++i)
    if (std::binary_search(prepared.corners.begin(), prepared.corners.end(), prepared.index[i]))
      fit.corners.push_back(static_cast<int>(i));
  return fit;
}

template <int Dim>
CurveFit<Dim> fit_with(const FitFrame<Dim>& frame, const Points<Dim>& points, int control_points) {
  const FitState<Dim> state = frame.options().method == FitMethod::free ? free_fit(frame, control_points)
                                                                        : fixed_knot_fit(frame, control_points);
  return finish(frame, state, points);
}

/// The smallest number of control points that meets the tolerance, found by growing steps and bisection.
template <int Dim>
CurveFit<Dim> fit_to_tolerance(const FitFrame<Dim>& frame, const Points<Dim>& points) {
  const double tolerance = frame.options().tolerance;
  const int most = frame.most_control_points();
  int too_few = frame.fewest_control_points() - 1;
  frame.require_count(too_few + 1);
  CurveFit<Dim> best = fit_with(frame, points, too_few + 1);
  while (best.quality.max_distance > tolerance && best.control_points < most) {
    too_few = best.control_points;
    best = fit_with(frame, points, std::min(most, too_few + std::max(1, too_few / 2)));
  }
  best.tolerance_met = best.quality.max_distance <= tolerance;
  while (best.tolerance_met && best.control_points - too_few > 1) {
    const int middle = (best.control_points + too_few) / 2;
    CurveFit<Dim> fit = fit_with(frame, points, middle);
    if (fit.quality.max_distance <= tolerance)
      best = std::move(fit);
    else
      too_few = middle;
  }
  return best;
}

template <int Dim>
int count_by_rule(const FitFrame<Dim>& frame) {
  const Points<Dim>& points = frame.prepared().data.points;
  const int wanted = points.cols() < 3        ? 0
                     : frame.options().closed ? inversion_control_points(points)
                                              : open_inversion_control_points(points);
  return std::clamp(wanted, frame.fewest_control_points(),
                    std::max(frame.fewest_control_points(), frame.most_control_points()));
}

void require_pereira(const CurveFitOptions<2>& options) {
  if (!options.closed || options.degree != 3)
    throw GeometryError(
        fmt::format("curve fit: Pereira's method fits closed curves of degree 3, not {} ones of degree {}",
                    options.closed ? "closed" : "open", options.degree));
  if (options.tolerance > 0.0) throw GeometryError("curve fit: Pereira's method takes no tolerance");
  if (options.corner_angle > 0.0) throw GeometryError("curve fit: Pereira's method knows no corners");
}

CurveFit<2> fit_by_pereira(const FitFrame<2>& frame, const Points<2>& points) {
  require_pereira(frame.options());
  FitData<2> data = frame.prepared().data;
  const int given = frame.options().control_points;
  const std::vector<PereiraStart> starts = pereira_starts(data.points, data.weights, given);
  const auto nearest = [](const PereiraStart& a, const PereiraStart& b) { return a.sum() < b.sum(); };
  const int start = starts.empty() ? 0 : std::min_element(starts.begin(), starts.end(), nearest)->point;
  const Eigen::Index rest = data.points.cols() - start;
  const Points<2> head = data.points.leftCols(start);
  const Points<2> tail = data.points.rightCols(rest);
  data.points << tail, head;
  std::rotate(data.weights.begin(), data.weights.begin() + start, data.weights.end());
  const int count = given > 0 ? given : inversion_control_points(data.points);
  const PereiraFit pereira = pereira_fit(data.points, data.weights, count);

  CurveFit<2> fit{pereira.curve};
  const SegmentedCurve<2> segments(fit.curve.knots(), fit.curve.control_points(), true);
  fit.quality = shape_quality(segments, true);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const ClosestCurvePoint<2> nearest_point = segments.nearest(points.col(i), fit.curve.domain().first);
    fit.parameters.push_back(nearest_point.u);
    fit.distances.push_back(nearest_point.distance);
  }
  add_distances<2>(fit.distances, fit.quality);
  fit.control_points = count;
  fit.iterations = 1;
  return fit;
}

}  // namespace

template <int Dim>
CurveFit<Dim> fit_points(const Points<Dim>& points, const CurveFitOptions<Dim>& options) {
  const FitFrame<Dim> frame(points, options);
  if (options.method == FitMethod::pereira) {
    if constexpr (Dim == 2) return fit_by_pereira(frame, points);
    throw GeometryError("curve fit: Pereira's method fits plane curves, not curves in space");
  }
  if (options.tolerance > 0.0) return fit_to_tolerance(frame, points);
  int count = options.control_points > 0 ? options.control_points : count_by_rule(frame);
  if (options.knots == FitKnots::given) count = frame.control_points(options.breakpoints);
  if (options.knots == FitKnots::given && options.control_points > 0 && options.control_points != count)
    throw GeometryError(fmt::format("curve fit: {} control points asked for, but the breakpoints make {}",
                                    options.control_points, count));
  frame.require_count(count);
  return fit_with(frame, points, count);
}

template CurveFit<2> fit_points(const Points<2>&, const CurveFitOptions<2>&);
template CurveFit<3> fit_points(const Points<3>&, const CurveFitOptions<3>&);

}  // namespace isorim::geometry
