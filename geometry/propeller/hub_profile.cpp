#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/propeller/propeller.h"

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

/// The longest straight piece parallel to the shaft.
std::size_t cylinder_of(const std::vector<NurbsCurve<2>>& legs) {
  std::size_t best = legs.size();
  double longest = 0.0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Eigen::ArrayXd radii = legs[i].control_points().row(1).transpose().array();
    if (!(radii[0] > 0.0) || (radii - radii[0]).abs().maxCoeff() > 1e-12 * radii[0]) continue;
    const double length = std::abs(end_of(legs[i]).x() - start_of(legs[i]).x());
    if (length <= longest) continue;
    longest = length;
    best = i;
  }
  if (best == legs.size())
    throw GeometryError(
        "propeller hub: no piece of the profile is parallel to the shaft; expected one, on which the "
        "blades stand");
  return best;
}

}  // namespace

Hub hub_by_profile(const std::vector<NurbsCurve<2>>& profile) {
  std::vector<NurbsCurve<2>> legs = legs_of(profile);
  check_profile(legs);
  if (start_of(legs.front()).x() > end_of(legs.back()).x()) legs = reversed(legs);
  const std::size_t cylinder = cylinder_of(legs);
  const Point2 aft = start_of(legs[cylinder]);
  const Point2 forward = end_of(legs[cylinder]);
  if (!(aft.x() < forward.x()))
    throw GeometryError(fmt::format("propeller hub: the profile turns back on its cylinder, from X = {:.6g} to {:.6g}",
                                    aft.x(), forward.x()));
  const auto middle = legs.begin() + static_cast<std::ptrdiff_t>(cylinder);
  Hub hub{aft.y(), aft.x(), forward.x()};
  hub.beyond_aft = reversed({legs.begin(), middle});
  hub.beyond_forward = {middle + 1, legs.end()};
  return hub;
}

}  // namespace isorim::geometry
