#include "geometry/fitting/section_uniformisation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/sweeps.h"

namespace isorim::geometry {
namespace {

void check(const UniformisationOptions& options) {
  if (options.inserted_knots < 1) {
    throw GeometryError(
        fmt::format("uniformisation: {} knots to insert, at least 1 is needed", options.inserted_knots));
  }
  if (!(options.tolerance >= 0.0) || !std::isfinite(options.tolerance)) {
    throw GeometryError(fmt::format("uniformisation: tolerance is {}, it must not be negative", options.tolerance));
  }
}

/// The inner knots of a clamped curve, with repetition.
std::vector<double> inner_knots(const NurbsCurve<3>& curve) {
  const std::span<const double> knots = curve.knots().knots();
  const auto p = static_cast<std::size_t>(curve.degree());
  return {knots.begin() + static_cast<std::ptrdiff_t>(p + 1), knots.end() - static_cast<std::ptrdiff_t>(p + 1)};
}

/// k / (n + 1), but for those at which the curve has a knot already (to rounding).
std::vector<double> even_knots(int count, const std::vector<double>& present) {
  std::vector<double> knots;
  for (int k = 1; k <= count; ++k) {
    const double u = static_cast<double>(k) / (count + 1);
    if (std::ranges::none_of(present, [&](double x) { return std::abs(x - u) <= 1e-14; })) knots.push_back(u);
  }
  return knots;
}

struct Thinned {
  NurbsCurve<3> curve;
  int removed = 0;
  double error_bound = 0.0;
};

/// Removes occurrences of `candidates`, always the one that moves the curve least, while the sum of the bounds stays
/// within the tolerance.
Thinned remove_cheapest(NurbsCurve<3> curve, std::vector<double> candidates, double tolerance) {
  Thinned result{std::move(curve), 0, 0.0};
  while (!candidates.empty()) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (i > 0 && candidates[i] == candidates[i - 1]) continue;
      const CurveKnotRemoval<3> removal =
          remove_knot(result.curve, candidates[i], 1, std::numeric_limits<double>::max());
      if (removal.removed == 0 || removal.error_bound >= least) continue;
      least = removal.error_bound;
      best = i;
    }
    if (result.error_bound + least > tolerance) break;
    result.curve = remove_knot(result.curve, candidates[best], 1, std::numeric_limits<double>::max()).curve;
    result.error_bound += least;
    ++result.removed;
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return result;
}

/// Of rounding: what a removal that undoes an insertion costs.
double rounding(const NurbsCurve<3>& curve) {
  return 1e-13 * curve.control_points().cwiseAbs().maxCoeff();
}

}  // namespace

UniformSections uniformise(std::span<const NurbsCurve<3>> sections, const UniformisationOptions& options) {
  check(options);
  UniformSections result;
  std::vector<NurbsCurve<3>> curves(sections.begin(), sections.end());
  int degree = 1;
  for (const NurbsCurve<3>& curve : curves) degree = std::max(degree, curve.degree());
  for (NurbsCurve<3>& curve : curves) {
    if (curve.degree() < degree) curve = elevate_degree(curve, degree - curve.degree());
    curve = reparametrise(clamp(curve), Interval{0.0, 1.0});
  }
  if (options.method == Uniformisation::insert_and_remove) {
    for (NurbsCurve<3>& curve : curves) {
      const std::vector<double> own = inner_knots(curve);
      const std::vector<double> even = even_knots(options.inserted_knots, own);
      std::vector<double> candidates = own;
      // Those that happen to lie on the new ones may stay.
      std::erase_if(candidates, [&](double x) {
        const double nearest = std::round(x * (options.inserted_knots + 1)) / (options.inserted_knots + 1);
        return std::abs(x - nearest) <= 1e-14;
      });
      Thinned thinned =
          remove_cheapest(refine_knots(curve, even), candidates, std::max(options.tolerance, rounding(curve)));
      curve = std::move(thinned.curve);
      result.inserted += static_cast<int>(even.size());
      result.removed += thinned.removed;
      result.error_bound = std::max(result.error_bound, thinned.error_bound);
    }
  }
  result.sections = make_compatible<3>(curves);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    result.inserted += result.sections[k].knots().basis_count() - curves[k].knots().basis_count();
  }
  if (!result.sections.empty()) result.control_points = result.sections.front().knots().basis_count();
  return result;
}

}  // namespace isorim::geometry
