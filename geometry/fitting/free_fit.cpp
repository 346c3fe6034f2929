#include "geometry/fitting/free_fit.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"

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

template <int Dim>
double curve_roughness(const FitFrame<Dim>& frame, const FitState<Dim>& state) {
  const SegmentedCurve<Dim> curve = frame.curve(state);
  double sum = 0.0;
  for (int s = 0; s < curve.segment_count(); ++s) {
    const Interval part = curve.segment_domain(s);
    for (const double x : {0.2113248654051871, 0.7886751345948129})
      sum += 0.5 * part.length() * curve.jet(part.first + x * part.length()).duu.squaredNorm();
  }
  return sum;
}

}  // namespace

template <int Dim>
FitState<Dim> free_fit(const FitFrame<Dim>& frame, int control_points) {
  constexpr int corrections_per_stage = 2;
  constexpr int last_corrections = 12;
  const int fewest = frame.fewest_control_points();
  FitState<Dim> state = frame.start(FitKnots::uniform, std::max(fewest, control_points / 2));
  if (!frame.solve(state, {})) {
    state = frame.start(FitKnots::piegl_tiller, std::max(fewest, control_points / 2));
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
  }
  while (true) {
    for (int i = 0; i < corrections_per_stage; ++i) {
      frame.correct_parameters(state, 1);
      if (!frame.solve(state, {})) refuse<Dim>(control_points);
    }
    const int missing = control_points - frame.control_points(state.breakpoints);
    if (missing == 0) break;
    if (!add_knots(frame, std::min(missing, std::max(1, frame.control_points(state.breakpoints) / 4)), state))
      refuse<Dim>(control_points);
    if (!frame.solve(state, {})) refuse<Dim>(control_points);
  }
  for (int i = 0; i < last_corrections; ++i) {
    frame.correct_parameters(state, 1);
    const double roughness = curve_roughness(frame, state);
    const double mu = frame.options().fairness.value_or(
        roughness > 0.0 ? frame.options().fairness_share * state.mean_squared / roughness : 0.0);
    if (!frame.solve(state, {mu, 2})) refuse<Dim>(control_points);
  }
  return state;
}

template FitState<2> free_fit(const FitFrame<2>&, int);
template FitState<3> free_fit(const FitFrame<3>&, int);

}  // namespace isorim::geometry
