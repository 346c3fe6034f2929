#include "geometry/fitting/peak_steps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "geometry/fitting/curve_shape.h"
#include "geometry/fitting/knot_steps.h"

namespace isorim::geometry {

namespace {

/// No weight falls below this part of the mean, so that no point is lost.
constexpr double least_weight = 1e-6;

template <int Dim>
void raise_weights_of_peaks(const FitFrame<Dim>& frame, const FitState<Dim>& state, std::vector<double>& weights) {
  const SegmentedCurve<Dim> curve = frame.curve(state);
  const Points<Dim>& points = frame.prepared().data.points;
  const double largest = state.max_distance * state.max_distance;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Vector<Dim> d = curve.jet(state.parameters[i]).point - points.col(static_cast<Eigen::Index>(i));
    weights[i] *= 1.0 + d.squaredNorm() / largest;
  }
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  for (double& weight : weights) weight = std::max(least_weight, weight / mean);
}

template <int Dim>
int sign_changes(const FitFrame<Dim>& frame, const FitState<Dim>& state) {
  if constexpr (Dim == 2) return curvature_sign_changes(frame.curve(state), frame.options().closed);
  return 0;
}

template <int Dim>
double product_of_distances(const FitState<Dim>& state) {
  return state.max_distance * std::sqrt(state.mean_squared);
}

}  // namespace

template <int Dim>
void lower_peaks(const FitFrame<Dim>& frame, int rounds, FitState<Dim>& state) {
  constexpr double rms_growth = 1.1;
  constexpr int corrections = 2;
  FitState<Dim> next = state;
  frame.correct_parameters(next, corrections);
  const double most_squared = rms_growth * rms_growth * next.mean_squared;
  const int most_sign_changes = sign_changes(frame, state);
  double best = product_of_distances(next);
  std::vector<double> weights = frame.prepared().data.weights;
  double damping = 1e-3;
  for (int round = 0; round < rounds && next.max_distance > 0.0; ++round) {
    raise_weights_of_peaks(frame, next, weights);
    const FitFrame<Dim> weighted = frame.reweighted(weights);
    if (!weighted.solve(next, next.fairness)) break;
    // A step that fails on these weights may succeed on the next ones.
    if (!move_knots(weighted, next, damping)) damping = std::min(damping, 1.0);
    frame.correct_parameters(next, corrections);
    state.iterations = next.iterations;
    if (next.mean_squared > most_squared) break;
    if (product_of_distances(next) >= best || sign_changes(frame, next) > most_sign_changes) continue;
    best = product_of_distances(next);
    state = next;
  }
}

template void lower_peaks(const FitFrame<2>&, int, FitState<2>&);
template void lower_peaks(const FitFrame<3>&, int, FitState<3>&);

}  // namespace isorim::geometry
