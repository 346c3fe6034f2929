#include "geometry/spline/knot_vector.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {

namespace {

void require_degree(int degree) {
  if (degree < 1 || degree > KnotVector::max_degree)
    throw GeometryError(
        fmt::format("knot vector: degree {} is out of range; expected 1 to {}", degree, KnotVector::max_degree));
}

void require_breakpoints(std::span<const double> breakpoints) {
  if (breakpoints.size() < 2)
    throw GeometryError(fmt::format("knot vector: {} breakpoint(s) given; at least 2 are needed to bound a domain",
                                    breakpoints.size()));
}

void require_finite_and_sorted(std::span<const double> knots) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i]))
      throw GeometryError(fmt::format("knot vector: knots[{}] = {} is not finite", i, knots[i]));
    if (i > 0 && knots[i] < knots[i - 1])
      throw GeometryError(fmt::format("knot vector: knots[{}] = {} is smaller than knots[{}] = {}; knots must not fall",
                                      i, knots[i], i - 1, knots[i - 1]));
  }
}

void require_multiplicities(int degree, std::span<const double> knots) {
  for (std::size_t i = 0; i < knots.size();) {
    std::size_t end = i;
    while (end < knots.size() && knots[end] == knots[i]) ++end;
    if (end - i > static_cast<std::size_t>(degree) + 1)
      throw GeometryError(
          fmt::format("knot vector: knot {} occurs {} times, from knots[{}]; degree {} allows at most {}", knots[i],
                      end - i, i, degree, degree + 1));
    i = end;
  }
}

}  // namespace

KnotVector::KnotVector(int degree, std::vector<double> knots) : degree_(degree), knots_(std::move(knots)) {
  require_degree(degree_);
  const std::size_t needed = 2 * (static_cast<std::size_t>(degree_) + 1);
  if (knots_.size() < needed)
    throw GeometryError(
        fmt::format("knot vector: {} knots given; degree {} needs at least {}", knots_.size(), degree_, needed));
  require_finite_and_sorted(knots_);
  require_multiplicities(degree_, knots_);
  const Interval range = domain();
  if (!(range.first < range.last))
    throw GeometryError(fmt::format("knot vector: the domain from knots[{}] = {} to knots[{}] = {} is empty", degree_,
                                    range.first, basis_count(), range.last));
  if (!std::isfinite(knots_.back() - knots_.front()))
    throw GeometryError(fmt::format("knot vector: the range from {} to {} overflows", knots_.front(), knots_.back()));
}

KnotVector KnotVector::clamped_uniform(int degree, int spans) {
  if (spans < 1) throw GeometryError(fmt::format("knot vector: {} spans asked for; expected at least 1", spans));
  std::vector<double> breakpoints(static_cast<std::size_t>(spans) + 1);
  for (int i = 0; i <= spans; ++i) breakpoints[static_cast<std::size_t>(i)] = static_cast<double>(i) / spans;
  return clamped(degree, breakpoints);
}

KnotVector KnotVector::clamped(int degree, std::span<const double> breakpoints) {
  require_degree(degree);
  require_breakpoints(breakpoints);
  std::vector<double> knots(static_cast<std::size_t>(degree), breakpoints.front());
  knots.insert(knots.end(), breakpoints.begin(), breakpoints.end());
  knots.insert(knots.end(), static_cast<std::size_t>(degree), breakpoints.back());
  return {degree, std::move(knots)};
}

KnotVector KnotVector::periodic(int degree, std::span<const double> breakpoints) {
  require_degree(degree);
  require_breakpoints(breakpoints);
  const std::size_t intervals = breakpoints.size() - 1;
  const std::size_t p = static_cast<std::size_t>(degree);
  const double first = breakpoints.front();
  const double last = breakpoints.back();
  const double period = last - first;
  std::vector<double> knots(breakpoints.size() + 2 * p);
  std::copy(breakpoints.begin(), breakpoints.end(), knots.begin() + degree);
  // The i-th knot beyond an end lies some whole periods and the distance to one breakpoint away from it: distances
  // of repeated breakpoints are equal bit for bit, so multiplicities survive the seam.
  for (std::size_t i = 1; i <= p; ++i) {
    const std::size_t whole_periods = (i - 1) / intervals;
    const double whole = static_cast<double>(whole_periods) * period;
    const std::size_t step = (i - 1) % intervals + 1;
    knots[p - i] = first - (whole + (last - breakpoints[intervals - step]));
    knots[p + intervals + i] = last + (whole + (breakpoints[step] - first));
  }
  return {degree, std::move(knots)};
}

bool KnotVector::is_clamped() const {
  const Interval range = domain();
  return knots_.front() == range.first && knots_.back() == range.last;
}

std::vector<double> KnotVector::breakpoints() const {
  std::vector<double> result(knots_.begin() + degree_, knots_.begin() + basis_count() + 1);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

int KnotVector::multiplicity(double u) const {
  const auto [lower, upper] = std::equal_range(knots_.begin(), knots_.end(), u);
  return static_cast<int>(upper - lower);
}

int KnotVector::find_span(double u) const {
  const Interval range = domain();
  const auto begin = knots_.begin() + degree_;
  const auto end = knots_.begin() + basis_count() + 1;
  // The negation also sends NaN to a valid span, where it stays visible in the value.
  if (!(u < range.last)) return static_cast<int>(std::lower_bound(begin, end, range.last) - knots_.begin()) - 1;
  return static_cast<int>(std::upper_bound(begin, end, std::max(u, range.first)) - knots_.begin()) - 1;
}

std::vector<double> KnotVector::greville_abscissae() const {
  std::vector<double> result(static_cast<std::size_t>(basis_count()));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto start = knots_.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    // Offsets from the first of them: p equal knots give that knot exactly, so abscissae never leave the domain.
    double sum = 0.0;
    for (auto knot = start; knot != start + degree_; ++knot) sum += *knot - *start;
    result[i] = *start + sum / degree_;
  }
  return result;
}

}  // namespace isorim::geometry
