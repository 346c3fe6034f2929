#include "quadrature/sector.h"

#include <array>
#include <cstddef>

#include "geometry/bezier/subdivision.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/shapes/star_kernel.h"
#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::quadrature {

std::vector<Sector> sectors_of(const geometry::TrimmedRegion& region) {
  std::vector<geometry::PlanePiece> pieces;
  for (const geometry::HomogeneousPoints<2>& curve : region.curves) pieces.emplace_back(curve);
  const geometry::Point2 pole = geometry::kernel_point(pieces).value_or(geometry::Point2(0.5, 0.5));
  std::vector<Sector> sectors;
  for (const geometry::HomogeneousPoints<2>& curve : region.curves)
    sectors.push_back({pole, {curve.data(), curve.data() + curve.size()}, static_cast<int>(curve.cols()) - 1, {}});
  return sectors;
}

std::pair<Sector, Sector> bisect(const Sector& sector, int direction) {
  std::pair<Sector, Sector> halves{sector, sector};
  if (direction == 1) {
    halves.first.radial.last = halves.second.radial.first = sector.radial.middle();
  } else {
    auto [first, second] = geometry::subdivide(sector.curve, 3, std::array<int, 1>{sector.degree}, 0);
    halves.first.curve = std::move(first);
    halves.second.curve = std::move(second);
  }
  return halves;
}

SectorRule sector_rule(const Sector& sector, const Orders<2>& orders) {
  const BernsteinTable& basis = bernstein_table(sector.degree, orders[0]);
  const Rule& along = gauss_legendre(orders[0]);
  const Rule& radial = gauss_legendre(orders[1]);
  SectorRule rule;
  for (int node = 0; node < orders[0]; ++node) {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    Eigen::Vector3d derivative = Eigen::Vector3d::Zero();
    for (int i = 0; i <= sector.degree; ++i) {
      const Eigen::Map<const Eigen::Vector3d> point(sector.curve.data() + 3 * static_cast<std::ptrdiff_t>(i));
      value += basis.values_at(node)[i] * point;
      derivative += basis.derivatives_at(node)[i] * point;
    }
    const geometry::Point2 place = value.head<2>() / value[2];
    const geometry::Vector2 tangent = (derivative.head<2>() - derivative[2] * place) / value[2];
    const geometry::Vector2 d = place - sector.pole;
    const double flux = (d[0] * tangent[1] - d[1] * tangent[0]) * along.weights[static_cast<std::size_t>(node)];
    for (std::size_t k = 0; k < radial.nodes.size(); ++k) {
      const double t = sector.radial.first + radial.nodes[k] * sector.radial.length();
      rule.places.emplace_back(sector.pole + t * d);
      rule.weights.push_back(flux * t * radial.weights[k] * sector.radial.length());
    }
  }
  return rule;
}

}  // namespace isorim::quadrature
