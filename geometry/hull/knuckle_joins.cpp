#include "geometry/hull/knuckle_joins.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

constexpr int cubic = 3;
/// How often a border vertex is added.
constexpr int extra = 2;

/// 0, 1, 2, ...
KnotVector uniform_knots(int functions) {
  std::vector<double> knots;
  for (int i = 0; i < functions + cubic + 1; ++i) knots.push_back(i);
  return {cubic, std::move(knots)};
}

}  // namespace

NurbsSurface<3> join_bands(const NurbsSurface<3>& lower, const NurbsSurface<3>& upper) {
  const KnotVector& low = lower.knots_v();
  const KnotVector& high = upper.knots_v();
  if (!(lower.knots_u() == upper.knots_u()) || low.degree() != high.degree() || !low.is_clamped() || !high.is_clamped())
    throw GeometryError("join of bands: their knots along the knuckle or their degrees differ");
  const Eigen::Index width = lower.count_u();
  if (lower.homogeneous().rightCols(width) != upper.homogeneous().leftCols(width))
    throw GeometryError("join of bands: they have different control points along the knuckle");
  const double shift = low.domain().last - high.domain().first;
  // Degree times at the join: one knot less of the lower band, whose end function is the upper one's first.
  std::vector<double> knots(low.knots().begin(), low.knots().end() - 1);
  for (int i = high.degree() + 1; i < static_cast<int>(high.knots().size()); ++i) knots.push_back(high[i] + shift);
  HomogeneousPoints<3> net(4, lower.homogeneous().cols() + upper.homogeneous().cols() - width);
  net << lower.homogeneous(), upper.homogeneous().rightCols(upper.homogeneous().cols() - width);
  return {lower.knots_u(), KnotVector(low.degree(), std::move(knots)), std::move(net)};
}

NurbsSurface<3> triple_vertex_surface(const Points<3>& net, int count_u, int count_v) {
  if (count_u < 2 || count_v < 2 || net.cols() != Eigen::Index{count_u} * count_v) {
    throw GeometryError(
        fmt::format("triple vertex surface: {} points for a net of {} x {}; expected at least 2 x 2, one "
                    "point for each vertex",
                    net.cols(), count_u, count_v));
  }
  const int wide = count_u + 2 * extra;
  const int high = count_v + 2 * extra;
  Points<3> tripled(3, Eigen::Index{wide} * high);
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < wide; ++i) {
      const int from_u = std::clamp(i - extra, 0, count_u - 1);
      const int from_v = std::clamp(j - extra, 0, count_v - 1);
      tripled.col(i + Eigen::Index{j} * wide) = net.col(from_u + Eigen::Index{from_v} * count_u);
    }
  }
  return NurbsSurface<3>::from_points(uniform_knots(wide), uniform_knots(high), tripled);
}

}  // namespace isorim::geometry
