#include "geometry/propeller/radial_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

void check_table(std::string_view quantity, const std::vector<double>& radii, const std::vector<double>& values) {
  if (radii.empty()) throw GeometryError(fmt::format("{}: the table has no rows", quantity));
  if (radii.size() != values.size()) {
    throw GeometryError(
        fmt::format("{}: {} values for {} radii; expected one a radius", quantity, values.size(), radii.size()));
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (!std::isfinite(radii[i]) || !std::isfinite(values[i]))
      throw GeometryError(
          fmt::format("{}: row {} is ({}, {}); expected numbers", quantity, i + 1, radii[i], values[i]));
    if (i > 0 && radii[i] <= radii[i - 1]) {
      throw GeometryError(fmt::format("{}: r/R is {} in row {} after {}; the radii have to rise", quantity, radii[i],
                                      i + 1, radii[i - 1]));
    }
  }
}

/// The slope at an end from the parabola through three rows, limited so that the cubic turns nowhere.
double end_slope(double near_step, double far_step, double near_rise, double far_rise) {
  const double slope = ((2.0 * near_step + far_step) * near_rise - near_step * far_rise) / (near_step + far_step);
  if (slope * near_rise <= 0.0) return 0.0;
  if (near_rise * far_rise < 0.0 && std::abs(slope) > 3.0 * std::abs(near_rise)) return 3.0 * near_rise;
  return slope;
}

/// Inside: the weighted harmonic mean of the neighbouring secants, 0 at an extremum.
std::vector<double> limited_slopes(const std::vector<double>& radii, const std::vector<double>& values) {
  const std::size_t n = radii.size();
  if (n == 1) return {0.0};
  std::vector<double> step(n - 1);
  std::vector<double> rise(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    step[i] = radii[i + 1] - radii[i];
    rise[i] = (values[i + 1] - values[i]) / step[i];
  }
  if (n == 2) return {rise[0], rise[0]};
  std::vector<double> slopes(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (rise[i - 1] * rise[i] <= 0.0) continue;
    const double before = 2.0 * step[i] + step[i - 1];
    const double after = step[i] + 2.0 * step[i - 1];
    slopes[i] = (before + after) / (before / rise[i - 1] + after / rise[i]);
  }
  slopes.front() = end_slope(step[0], step[1], rise[0], rise[1]);
  slopes.back() = end_slope(step[n - 2], step[n - 3], rise[n - 2], rise[n - 3]);
  return slopes;
}

}  // namespace

RadialLaw::RadialLaw(std::string_view quantity, std::vector<double> radii, std::vector<double> values)
    : radii_(std::move(radii)), values_(std::move(values)) {
  check_table(quantity, radii_, values_);
  slopes_ = limited_slopes(radii_, values_);
}

double RadialLaw::operator()(double radius_ratio) const {
  if (radius_ratio <= radii_.front()) return values_.front() + slopes_.front() * (radius_ratio - radii_.front());
  if (radius_ratio >= radii_.back()) return values_.back() + slopes_.back() * (radius_ratio - radii_.back());
  const auto above = std::ranges::upper_bound(radii_, radius_ratio);
  const auto i = static_cast<std::size_t>(above - radii_.begin()) - 1;
  const double step = radii_[i + 1] - radii_[i];
  const double t = (radius_ratio - radii_[i]) / step;
  const double s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * values_[i] + t * step * slopes_[i]) +
         t * t * ((1.0 + 2.0 * s) * values_[i + 1] - s * step * slopes_[i + 1]);
}

}  // namespace isorim::geometry
