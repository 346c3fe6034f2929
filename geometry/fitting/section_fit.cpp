#include "geometry/fitting/section_fit.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "geometry/errors.h"

namespace isorim::geometry {

namespace {

CurveFit<2> fit_section(const SectionPoints& section, const CurveFitOptions<2>& options) {
  try {
    return fit_points<2>(section.points, options);
  } catch (Error& error) {
    error.add_context(section.name);
    throw;
  }
}

/// As fit_points() takes them.
std::vector<double> breakpoints(const CurveFit<2>& fit, int degree) {
  const std::span<const double> knots = fit.curve.knots().knots();
  const Interval domain = fit.curve.domain();
  std::vector<double> result;
  for (std::size_t i = static_cast<std::size_t>(degree); i + static_cast<std::size_t>(degree) < knots.size(); ++i)
    if (knots[i] >= domain.first && knots[i] <= domain.last) result.push_back(knots[i]);
  return result;
}

/// The means of the sections' breakpoints; nothing if they do not correspond.
std::optional<std::vector<double>> mean_breakpoints(const std::vector<CurveFit<2>>& fits, int degree) {
  std::vector<double> sum = breakpoints(fits.front(), degree);
  const std::vector<int>& corners = fits.front().corners;
  // A corner at the start alone is at the same place in all.
  if (corners.size() > 1 || (corners.size() == 1 && corners.front() != 0)) return std::nullopt;
  for (std::size_t k = 1; k < fits.size(); ++k) {
    const std::vector<double> knots = breakpoints(fits[k], degree);
    if (knots.size() != sum.size() || fits[k].corners != corners) return std::nullopt;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += knots[i];
  }
  for (double& u : sum) u /= static_cast<double>(fits.size());
  sum.front() = 0.0;
  sum.back() = 1.0;
  return sum;
}

/// Curves of this many control points, on common knots where there are such.
std::vector<CurveFit<2>> fit_on_common_knots(const std::vector<SectionPoints>& sections, int control_points) {
  std::vector<CurveFit<2>> fits;
  for (const SectionPoints& section : sections) {
    CurveFitOptions<2> options = section.options;
    options.tolerance = 0.0;
    options.control_points = control_points;
    fits.push_back(fit_section(section, options));
  }
  const CurveFitOptions<2>& common = sections.front().options;
  if (common.method != FitMethod::free || common.knots != FitKnots::automatic) return fits;
  const std::optional<std::vector<double>> knots = mean_breakpoints(fits, common.degree);
  if (!knots) return fits;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    CurveFitOptions<2> options = sections[k].options;
    options.tolerance = 0.0;
    options.control_points = 0;
    options.knots = FitKnots::given;
    options.breakpoints = *knots;
    fits[k] = fit_section(sections[k], options);
  }
  return fits;
}

double largest_distance(const std::vector<CurveFit<2>>& fits) {
  double largest = 0.0;
  for (const CurveFit<2>& fit : fits) largest = std::max(largest, fit.quality.max_distance);
  return largest;
}

}  // namespace

std::vector<CurveFit<2>> fit_sections(const std::vector<SectionPoints>& sections) {
  if (sections.empty()) return {};
  const CurveFitOptions<2>& common = sections.front().options;
  int count = common.control_points;
  int most = std::numeric_limits<int>::max();
  if (count == 0) {
    for (const SectionPoints& section : sections) {
      count = std::max(count, fit_section(section, section.options).control_points);
      most = std::min(most, static_cast<int>(section.points.cols()));
    }
    count = std::min(count, most);
  }
  std::vector<CurveFit<2>> fits = fit_on_common_knots(sections, count);
  if (common.tolerance > 0.0) {
    while (largest_distance(fits) > common.tolerance && count < most) {
      count = std::min(most, count + std::max(1, count / 10));
      fits = fit_on_common_knots(sections, count);
    }
    for (CurveFit<2>& fit : fits) fit.tolerance_met = fit.quality.max_distance <= common.tolerance;
  }
  return fits;
}

}  // namespace isorim::geometry
