#include "geometry/intersection/smooth_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/fitting/fit_problem.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

constexpr int degree = 5;

double length_of(const RunSamples& run) {
  return run.spans.back().s.last - run.spans.front().s.first;
}

/// The number of spans of error `allowed`, added up along the run: at the ends of its Hermite segments.
std::vector<double> cumulated_demand(const RunSamples& run, double allowed) {
  std::vector<double> shares;
  for (const RunSamples::Span& span : run.spans) shares.push_back(std::pow(span.error / allowed, 1.0 / 6.0));
  // Where the sixth derivative happens to vanish, or next to a peak of it, spans must not become too long.
  constexpr double least_ratio = 0.6;
  const std::size_t count = shares.size();
  const auto density = [&](std::size_t i) { return shares[i] / run.spans[i].s.length(); };
  const auto raise = [&](std::size_t i, std::size_t neighbour) {
    shares[i] = std::max(shares[i], least_ratio * density(neighbour) * run.spans[i].s.length());
  };
  for (int turn = 0; turn < (run.is_periodic ? 2 : 1); ++turn) {
    for (std::size_t i = 1; i < count; ++i) raise(i, i - 1);
    if (run.is_periodic) raise(0, count - 1);
    for (std::size_t i = count - 1; i > 0; --i) raise(i - 1, i);
    if (run.is_periodic) raise(count - 1, 0);
  }
  std::vector<double> sums{0.0};
  for (const double share : shares) sums.push_back(sums.back() + share);
  return sums;
}

/// Ends of `count` spans that all have the same demand.
std::vector<double> even_breaks(const RunSamples& run, const std::vector<double>& demand, int count) {
  std::vector<double> breaks{run.spans.front().s.first};
  std::size_t i = 0;
  for (int k = 1; k < count; ++k) {
    const double wanted = demand.back() * k / count;
    while (i + 1 < run.spans.size() && demand[i + 1] < wanted) ++i;
    const double share = demand[i + 1] - demand[i];
    const double part = share > 0.0 ? std::clamp((wanted - demand[i]) / share, 0.0, 1.0) : 0.5;
    breaks.push_back(run.spans[i].s.first + part * run.spans[i].s.length());
  }
  breaks.push_back(run.spans.back().s.last);
  return breaks;
}

/// Three control points at each end by position, tangent and curvature at unit speed.
FitConstraints<2> end_constraints(const RunSamples& run, const KnotVector& knots) {
  FitConstraints<2> constraints;
  if (run.is_periodic) return constraints;
  const int last = knots.basis_count() - 1;
  const auto fix_end = [&](const ArcJet& jet, double sign, int end, int inwards, double h1, double h2) {
    // h1: the first span, h2: the first two. C' = 5 (P1 - P0) / h1; C'' = 20 / h1 ((P2 - P1) / h2 - (P1 - P0) / h1).
    const Point2 first = jet.point + sign * h1 / degree * jet.tangent;
    const Point2 second = first + h2 * (h1 / (degree * (degree - 1)) * jet.bend + sign / degree * jet.tangent);
    constraints.fixed.push_back({end, jet.point});
    constraints.fixed.push_back({end + inwards, first});
    constraints.fixed.push_back({end + 2 * inwards, second});
  };
  fix_end(run.start, 1.0, 0, 1, knots[degree + 1] - knots[degree], knots[degree + 2] - knots[degree]);
  fix_end(run.end, -1.0, last, -1, knots[last + 1] - knots[last], knots[last + 1] - knots[last - 1]);
  return constraints;
}

std::vector<ArcSegment> segments_of(const KnotVector& knots, const Points<2>& control) {
  std::vector<ArcSegment> segments;
  for (const BezierSegment& segment : bezier_segments({knots, control}))
    segments.push_back({segment.domain, segment.coefficients});
  return segments;
}

/// The largest distance at the samples and, as long as it is no larger than allowed, between them.
double error_of(const BSpline& spline, const RunSamples& run, const std::vector<double>& breaks, double allowed,
                const std::function<Point2(double)>& at) {
  double error = 0.0;
  for (const RunSamples::Sample& sample : run.samples)
    error = std::max(error, (evaluate(spline, sample.s) - sample.point).norm());
  for (std::size_t i = 0; i + 1 < breaks.size() && error <= allowed; ++i)
    for (const double t : {0.23, 0.5, 0.77}) {
      const double s = breaks[i] + t * (breaks[i + 1] - breaks[i]);
      error = std::max(error, (evaluate(spline, s) - at(s)).norm());
    }
  return error;
}

}  // namespace

std::optional<RunSpline> smooth_run_spline(const RunSamples& run, double allowed,
                                           const std::function<Point2(double)>& at) {
  constexpr int most_trials = 5;
  const int hermite_count = 3 * static_cast<int>(run.spans.size());
  const int extra = run.is_periodic ? 0 : degree;
  const int fewest = run.is_periodic ? degree + 1 : 2;
  FitData<2> data{Points<2>(2, static_cast<Eigen::Index>(run.samples.size())),
                  std::vector<double>(run.samples.size(), 1.0)};
  std::vector<double> parameters;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    data.points.col(static_cast<Eigen::Index>(i)) = run.samples[i].point;
    parameters.push_back(run.samples[i].s);
  }
  const std::vector<double> demand = cumulated_demand(run, allowed);
  if (!(demand.back() > 0.0 && length_of(run) > 0.0)) return std::nullopt;
  int spans = std::max(fewest, static_cast<int>(std::ceil(demand.back())));
  for (int trial = 0; trial < most_trials && spans + extra < hermite_count; ++trial) {
    const std::vector<double> breaks = even_breaks(run, demand, spans);
    const KnotVector knots =
        run.is_periodic ? KnotVector::periodic(degree, breaks) : KnotVector::clamped(degree, breaks);
    const FitSpace space{knots, run.is_periodic ? degree : 0};
    const Points<2> control = solve_fit(space, data, parameters, Fairness{}, end_constraints(run, knots));
    double excess = 1.0;
    if (control.cols() > 0) {
      const double error = error_of({knots, control}, run, breaks, allowed, at);
      if (error <= allowed) return RunSpline{segments_of(knots, control), error};
      excess = std::pow(error / allowed, 1.0 / 6.0);
    }
    spans = std::max(spans + 1, static_cast<int>(std::ceil(std::clamp(excess, 1.05, 2.0) * spans)));
  }
  return std::nullopt;
}

}  // namespace isorim::geometry
