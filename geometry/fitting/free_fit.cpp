#include "geometry/fitting/free_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/curve_shape.h"
#include "geometry/fitting/knot_steps.h"
#include "geometry/fitting/peak_steps.h"

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

/// A span without data: its control points hang on neighbours that may be far away.
template <int Dim>
bool has_empty_span(const FitState<Dim>& state) {
  std::vector<double> sorted = state.parameters;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i + 1 < state.breakpoints.size(); ++i) {
    const auto next = std::lower_bound(sorted.begin(), sorted.end(), state.breakpoints[i]);
    if (next == sorted.end() || *next > state.breakpoints[i + 1]) return true;
  }
  return false;
}

/// Knots where the errors are: for four fifths of the control points uniform ones, or where the data are, if uniform
/// ones leave spans without any; the rest added.
template <int Dim>
FitState<Dim> grow_knots(const FitFrame<Dim>& frame, int control_points) {
  const int first = std::max(frame.fewest_control_points(), 4 * control_points / 5);
  FitState<Dim> state = frame.start(FitKnots::uniform, first);
  if (has_empty_span(state) || !frame.solve(state, {})) {
    state = frame.start(FitKnots::piegl_tiller, first);
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
  }
  while (true) {
    frame.correct_parameters(state, 1);
    const int have = frame.control_points(state.breakpoints);
    if (have == control_points) return state;
    if (!add_knots(frame, std::min(control_points - have, std::max(1, have / 4)), state)) refuse<Dim>(control_points);
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
  }
}

/// The fairness term that the options ask for at the present distances; it then stays, so that what is improved is one
/// and the same sum.
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

/// Lobes of curvature that are lower than the distances of the data are no shape but noise: the fairness term is made
/// stronger around them until they are gone. Where that costs too much distance, the higher half of them is kept
/// and the lower half tried again.
class LobeSmoother {
 public:
  LobeSmoother(const FitFrame<2>& frame, FitState<2>& state)
      : frame_(frame),
        state_(state),
        spans_(state.breakpoints.size() - 1),
        level_(std::sqrt(state.mean_squared)),
        most_(max_growth * state.max_distance),
        is_kept_(spans_, 0) {
    if (state_.fairness.factors.empty()) state_.fairness.factors.assign(spans_, 1.0);
  }

  void run() {
    std::vector<CurvatureLobe> lobes = low_lobes();
    for (std::size_t round = 0; round < 2 * spans_ && !lobes.empty(); ++round) {
      if (smooth(lobes)) {
        lobes = low_lobes();
        continue;
      }
      const std::size_t lower = lobes.size() / 2;
      for (std::size_t i = lower; i < lobes.size(); ++i) keep(lobes[i]);
      lobes.resize(lower);
      if (lobes.empty()) lobes = low_lobes();
    }
  }

 private:
  static constexpr double stronger = 32.0;
  static constexpr double strongest = 1e6;
  static constexpr double rms_growth = 1.2;
  static constexpr double max_growth = 1.05;

  std::size_t span_of(double u) const {
    if (u >= 1.0) u -= 1.0;
    const auto next = std::upper_bound(state_.breakpoints.begin() + 1, state_.breakpoints.end() - 1, u);
    return static_cast<std::size_t>(next - state_.breakpoints.begin()) - 1;
  }

  bool is_kept(const CurvatureLobe& lobe) const { return is_kept_[span_of(0.5 * (lobe.first + lobe.last))] != 0; }
  void keep(const CurvatureLobe& lobe) { is_kept_[span_of(0.5 * (lobe.first + lobe.last))] = 1; }

  /// The lowest first.
  std::vector<CurvatureLobe> low_lobes() const {
    std::vector<CurvatureLobe> lobes = curvature_lobes(frame_.curve(state_), frame_.options().closed);
    std::erase_if(lobes, [&](const CurvatureLobe& lobe) { return lobe.height >= level_ || is_kept(lobe); });
    std::sort(lobes.begin(), lobes.end(),
              [](const CurvatureLobe& a, const CurvatureLobe& b) { return a.height < b.height; });
    return lobes;
  }

  /// False, and nothing is changed, if it costs too much.
  bool smooth(const std::vector<CurvatureLobe>& lobes) {
    FitState<2> next = state_;
    std::vector<double>& factors = next.fairness.factors;
    std::vector<char> is_near(spans_, 0);
    for (const CurvatureLobe& lobe : lobes) {
      const std::size_t first = span_of(lobe.first);
      const std::size_t count = (span_of(lobe.last) + spans_ - first) % spans_ + 3;
      for (std::size_t i = 0; i < std::min(count, spans_); ++i) is_near[(first + spans_ - 1 + i) % spans_] = 1;
    }
    for (std::size_t i = 0; i < spans_; ++i)
      if (is_near[i] != 0) factors[i] = std::min(strongest, stronger * factors[i]);
    const bool is_solved = frame_.solve(next, next.fairness);
    state_.iterations = next.iterations;
    if (!is_solved) return false;
    frame_.correct_parameters(next, 1);
    if (std::sqrt(next.mean_squared) > rms_growth * level_ || next.max_distance > most_) return false;
    state_ = std::move(next);
    return true;
  }

  const FitFrame<2>& frame_;
  FitState<2>& state_;
  std::size_t spans_;
  double level_;
  double most_;
  std::vector<char> is_kept_;
};

/// A distance that is larger than the largest of as many normal deviations by more than one of them is not the data's
/// scatter: there the curve has not yet found its knots.
template <int Dim>
bool has_peak(const FitFrame<Dim>& frame, const FitState<Dim>& state) {
  const double expected = std::sqrt(2.0 * std::log(static_cast<double>(frame.point_count()))) + 1.0;
  return state.max_distance > expected * std::sqrt(state.mean_squared);
}

/// Knots, parameters and control points improved together.
template <int Dim>
FitState<Dim> find_knots(const FitFrame<Dim>& frame, int control_points) {
  FitState<Dim> state = frame.moves_knots() ? grow_knots(frame, control_points) : frame.first_fit(control_points, {});
  if (!frame.moves_knots()) frame.correct_parameters(state, 1);
  state.fairness = choose_fairness(frame, state);
  double damping = 1e-3;
  const int steps = frame.options().knot_steps;
  const int most_steps = steps > 0 ? steps + 2 : 0;
  for (int i = 0; i < most_steps; ++i) {
    if (i >= steps && !has_peak(frame, state)) break;
    if (!move_knots(frame, state, damping)) break;
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
    frame.correct_parameters(state, 2);
    if (!frame.solve(state, state.fairness)) refuse<Dim>(control_points);
  } else {
    state = find_knots(frame, control_points);
  }
  frame.correct_parameters(state, 1);
  if constexpr (Dim == 2)
    if (state.fairness.mu > 0.0 && state.fairness.derivative <= frame.degree()) LobeSmoother(frame, state).run();
  lower_peaks(frame, frame.options().peak_steps, state);
  return state;
}

template FitState<2> free_fit(const FitFrame<2>&, int);
template FitState<3> free_fit(const FitFrame<3>&, int);

}  // namespace isorim::geometry
