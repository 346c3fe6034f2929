#include "geometry/fitting/free_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/curve_shape.h"
#include "geometry/fitting/knot_steps.h"

namespace isorim::geometry {

namespace {

/// A span that could take one more knot.
struct Candidate {
  double error = 0.0;
  double knot = 0.0;
};

/// The spans with two data or more, with the sum of their squared errors and a knot in the middle of their data.
template <int Dim>
std::vector<Candidate> find_candidates(const FitFrame<Dim>& frame, const FitState<Dim>& state) {
  const std::vector<double>& breakpoints = state.breakpoints;
  const FitData<Dim>& data = frame.prepared().data;
  const SegmentedCurve<Dim> curve = frame.curve(state);
  struct Datum {
    double u;
    double error;
  };
  std::vector<Datum> sorted(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double u = state.parameters[i];
    const Point<Dim> point = data.points.col(static_cast<Eigen::Index>(i));
    sorted[i] = {u, data.weights[i] * (curve.jet(u).point - point).squaredNorm()};
  }
  std::sort(sorted.begin(), sorted.end(), [](const Datum& a, const Datum& b) { return a.u < b.u; });
  std::vector<Candidate> candidates;
  auto first = sorted.begin();
  for (std::size_t s = 0; s + 1 < breakpoints.size(); ++s) {
    if (!(breakpoints[s] < breakpoints[s + 1])) continue;
    const bool is_last = s + 2 == breakpoints.size();
    const auto last = std::find_if(first, sorted.end(),
                                   [&](const Datum& datum) { return !is_last && datum.u >= breakpoints[s + 1]; });
    const auto count = last - first;
    if (count >= 2) {
      Candidate candidate;
      for (auto datum = first; datum != last; ++datum) candidate.error += datum->error;
      const auto middle = first + count / 2;
      candidate.knot = count % 2 == 1 ? middle->u : 0.5 * ((middle - 1)->u + middle->u);
      if (candidate.knot > breakpoints[s] && candidate.knot < breakpoints[s + 1]) candidates.push_back(candidate);
    }
    first = last;
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.error > b.error; });
  return candidates;
}

/// Adds up to `count` knots where the errors are largest; false if no span can take one.
template <int Dim>
bool add_knots(const FitFrame<Dim>& frame, int count, FitState<Dim>& state) {
  const std::vector<Candidate> candidates = find_candidates(frame, state);
  for (std::size_t i = 0; i < candidates.size() && i < static_cast<std::size_t>(count); ++i)
    state.breakpoints.push_back(candidates[i].knot);
  std::sort(state.breakpoints.begin(), state.breakpoints.end());
  return !candidates.empty();
}

template <int Dim>
[[noreturn]] void refuse(int control_points) {
  throw GeometryError(
      fmt::format("curve fit: the points do not determine all {} control points; give fewer", control_points));
}

/// Knots where the errors are: starting from uniform ones for seven tenths of the control points.
template <int Dim>
FitState<Dim> grow_knots(const FitFrame<Dim>& frame, int control_points) {
  const int first = std::max(frame.fewest_control_points(), 7 * control_points / 10);
  FitState<Dim> state = frame.start(FitKnots::uniform, first);
  if (!frame.solve(state, {})) {
    state = frame.start(FitKnots::piegl_tiller, first);
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
  }
  while (true) {
    frame.correct_parameters(state, 1);
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
    const int have = frame.control_points(state.breakpoints);
    if (have == control_points) return state;
    if (!add_knots(frame, std::min(control_points - have, std::max(1, have / 4)), state)) refuse<Dim>(control_points);
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
  }
}

/// The fairness term that the options ask for at the present distances.
template <int Dim>
Fairness choose_fairness(const FitFrame<Dim>& frame, const FitState<Dim>& state) {
  const CurveFitOptions<Dim>& options = frame.options();
  Fairness fairness{0.0, options.fairness_derivative, {}};
  if (options.fairness) {
    fairness.mu = *options.fairness;
  } else {
    const double rough = roughness(frame, fairness, state);
    if (rough > 0.0) fairness.mu = options.fairness_share * state.mean_squared / rough;
  }
  return fairness;
}

/// Lobes of curvature that are lower than half the distances of the data are no shape but noise: the fairness term is
/// made stronger around them, the lowest first, until they are gone; what costs too much distance is undone.
void smooth_low_lobes(const FitFrame<2>& frame, Fairness fairness, FitState<2>& state) {
  constexpr double stronger = 8.0;
  constexpr double strongest = 1e6;
  constexpr double low = 0.5;
  constexpr double rms_growth = 1.2;
  constexpr double max_growth = 1.05;
  if (!(fairness.mu > 0.0) || fairness.derivative > frame.degree()) return;
  const double level = std::sqrt(state.mean_squared);
  const double most = max_growth * state.max_distance;
  const std::size_t spans = state.breakpoints.size() - 1;
  fairness.factors.assign(spans, 1.0);
  const auto span_of = [&](double u) {
    if (u >= 1.0) u -= 1.0;
    const auto next = std::upper_bound(state.breakpoints.begin() + 1, state.breakpoints.end() - 1, u);
    return static_cast<std::size_t>(next - state.breakpoints.begin()) - 1;
  };
  std::vector<char> is_kept(spans, 0);
  for (std::size_t round = 0; round < 2 * spans; ++round) {
    const CurvatureLobe* lowest = nullptr;
    const std::vector<CurvatureLobe> lobes = curvature_lobes(frame.curve(state), frame.options().closed);
    for (const CurvatureLobe& lobe : lobes)
      if (lobe.height < low * level && (lowest == nullptr || lobe.height < lowest->height) &&
          is_kept[span_of(0.5 * (lobe.first + lobe.last))] == 0)
        lowest = &lobe;
    if (lowest == nullptr) return;
    const std::size_t first = span_of(lowest->first);
    const std::size_t count = (span_of(lowest->last) + spans - first) % spans + 3;
    FitState<2> next = state;
    Fairness next_fairness = fairness;
    for (std::size_t i = 0; i < std::min(count, spans); ++i) {
      double& factor = next_fairness.factors[(first + spans - 1 + i) % spans];
      factor = std::min(strongest, stronger * factor);
    }
    bool is_good = frame.solve(next, next_fairness);
    if (is_good) frame.correct_parameters(next, 1);
    is_good = is_good && std::sqrt(next.mean_squared) <= rms_growth * level && next.max_distance <= most;
    if (is_good) {
      state = std::move(next);
      fairness = std::move(next_fairness);
    } else {
      state.iterations = next.iterations;
      is_kept[span_of(0.5 * (lowest->first + lowest->last))] = 1;
    }
  }
}

/// Knots and parameters improved by turns.
template <int Dim>
FitState<Dim> find_knots(const FitFrame<Dim>& frame, int control_points) {
  constexpr int corrections = 4;
  FitState<Dim> state = grow_knots(frame, control_points);
  double damping = 1e-4;
  for (int i = 0; i < frame.options().knot_steps; ++i) {
    frame.correct_parameters(state, 1);
    const Fairness fairness = choose_fairness(frame, state);
    if (!frame.solve(state, fairness)) refuse<Dim>(control_points);
    if (!move_knots(frame, fairness, state, damping)) break;
  }
  for (int i = 0; i < corrections; ++i) {
    frame.correct_parameters(state, 1);
    if (!frame.solve(state, choose_fairness(frame, state))) refuse<Dim>(control_points);
  }
  return state;
}

/// Takes the parameters of the frame's points from those of some of them: what correction has changed is interpolated.
template <int Dim>
void spread_parameters(const FitFrame<Dim>& frame, const FitFrame<Dim>& few, FitState<Dim>& state) {
  const std::vector<double>& before = few.prepared().parameters;
  const auto change = [&](std::size_t i) {
    const double moved = state.parameters[i] - before[i];
    return frame.options().closed ? moved - std::round(moved) : moved;
  };
  std::vector<double> parameters = frame.prepared().parameters;
  std::size_t i = 0;
  for (double& u : parameters) {
    while (i + 1 < before.size() && before[i + 1] <= u) ++i;
    const std::size_t next = i + 1 < before.size() ? i + 1 : (frame.options().closed ? 0 : i);
    const double width = next > i ? before[next] - before[i] : 1.0 - before[i];
    const double share = width > 0.0 ? std::clamp((u - before[i]) / width, 0.0, 1.0) : 0.0;
    u += (1.0 - share) * change(i) + share * change(next);
    if (frame.options().closed) u -= std::floor(u);
    u = std::clamp(u, 0.0, 1.0);
  }
  state.parameters = std::move(parameters);
}

}  // namespace

template <int Dim>
FitState<Dim> free_fit(const FitFrame<Dim>& frame, int control_points) {
  // Knots are found from as many points; more tell no more about them.
  constexpr int points_per_knot = 20;
  const int stride = frame.point_count() / (points_per_knot * control_points);
  FitState<Dim> state;
  if (stride >= 2) {
    const FitFrame<Dim> few = frame.thinned(stride);
    state = find_knots(few, control_points);
    spread_parameters(frame, few, state);
  } else {
    state = find_knots(frame, control_points);
  }
  frame.correct_parameters(state, 2);
  const Fairness fairness = choose_fairness(frame, state);
  if (!frame.solve(state, fairness)) refuse<Dim>(control_points);
  frame.correct_parameters(state, 1);
  if constexpr (Dim == 2) smooth_low_lobes(frame, fairness, state);
  return state;
}

template FitState<2> free_fit(const FitFrame<2>&, int);
template FitState<3> free_fit(const FitFrame<3>&, int);

}  // namespace isorim::geometry
