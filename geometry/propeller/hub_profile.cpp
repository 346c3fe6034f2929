#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/propeller/bracketed_root.h"
#include "geometry/propeller/generatrix.h"
#include "geometry/propeller/propeller.h"
#include "geometry/propeller/radial_law.h"

namespace isorim::geometry {
namespace {

Point2 start_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().first);
}
Point2 end_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().last);
}

/// Straight curves leg by leg.
std::vector<NurbsCurve<2>> legs_of(const std::vector<NurbsCurve<2>>& profile) {
  std::vector<NurbsCurve<2>> legs;
  for (const NurbsCurve<2>& curve : profile) {
    if (curve.degree() > 1) {
      legs.push_back(curve);
      continue;
    }
    const std::vector<double> ends = curve.knots().breakpoints();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) legs.push_back(restrict_to(curve, {ends[i], ends[i + 1]}));
  }
  return legs;
}

std::vector<NurbsCurve<2>> reversed(const std::vector<NurbsCurve<2>>& curves) {
  std::vector<NurbsCurve<2>> result;
  std::transform(curves.rbegin(), curves.rend(), std::back_inserter(result),
                 [](const NurbsCurve<2>& curve) { return reverse(curve); });
  return result;
}

void check_profile(const std::vector<NurbsCurve<2>>& legs) {
  if (legs.empty()) throw GeometryError("propeller hub: the profile has no curves");
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Points<2> points = legs[i].control_points();
    const double size = points.cwiseAbs().maxCoeff();
    if (points.row(1).minCoeff() < -1e-12 * size)
      throw GeometryError(
          fmt::format("propeller hub: the profile reaches the radius {:.6g}; expected (X, radius) on one "
                      "side of the shaft",
                      points.row(1).minCoeff()));
    if (i == 0) continue;
    const Point2 gap = start_of(legs[i]) - end_of(legs[i - 1]);
    if (gap.norm() > 1e-9 * size)
      throw GeometryError(fmt::format("propeller hub: the profile has a gap of {:.3g} at ({:.6g}, {:.6g})", gap.norm(),
                                      start_of(legs[i]).x(), start_of(legs[i]).y()));
  }
}

/// The longest straight piece parallel to the shaft, if there is one.
std::optional<std::size_t> cylinder_of(const std::vector<NurbsCurve<2>>& legs) {
  std::optional<std::size_t> best;
  double longest = 0.0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Eigen::ArrayXd radii = legs[i].control_points().row(1).transpose().array();
    if (!(radii[0] > 0.0) || (radii - radii[0]).abs().maxCoeff() > 1e-12 * radii[0]) continue;
    const double length = end_of(legs[i]).x() - start_of(legs[i]).x();
    if (length <= longest) continue;
    longest = length;
    best = i;
  }
  return best;
}

}  // namespace

Hub hub_by_profile(const std::vector<NurbsCurve<2>>& profile) {
  std::vector<NurbsCurve<2>> legs = legs_of(profile);
  check_profile(legs);
  if (start_of(legs.front()).x() > end_of(legs.back()).x()) legs = reversed(legs);
  const Generatrix standing(legs);
  Hub hub;
  hub.profile = legs;
  const std::optional<std::size_t> cylinder = cylinder_of(legs);
  if (!cylinder) return hub;
  const auto middle = legs.begin() + static_cast<std::ptrdiff_t>(*cylinder);
  hub.radius = start_of(*middle).y();
  hub.aft = start_of(*middle).x();
  hub.forward = end_of(*middle).x();
  hub.beyond_aft = reversed({legs.begin(), middle});
  hub.beyond_forward = {middle + 1, legs.end()};
  return hub;
}

double radius_at_generator_line(const Hub& hub, std::span<const BladeSection> sections) {
  if (hub.radius > 0.0 || hub.profile.empty()) return hub.radius;
  std::vector<double> radii;
  std::vector<double> rakes;
  for (const BladeSection& section : sections) {
    radii.push_back(section.station.radius);
    rakes.push_back(section.station.rake);
  }
  const double tip = radii.back();
  const RadialLaw rake("rake", std::move(radii), std::move(rakes));
  const Generatrix profile(hub.profile);
  return bracketed_root([&](double r) { return r - profile.radius(-rake(r)); }, {0.0, tip});
}

}  // namespace isorim::geometry
