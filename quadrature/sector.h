#pragma once

#include <utility>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/element_sums.h"

/// The radial integration method in the unit cell of a cut element: with a pole c
///
///   int_D g dx dy = sum over the boundary's curves of int int_0^1 g(c + t (C(s) - c)) t dt (C - c) x C' ds.
///
/// Where the kept part is star-shaped about the pole all points lie in it. That is what integrands need that are
/// defined there only; for all others region_moments.h is far cheaper.
namespace isorim::quadrature {

/// What one curve spans with the pole, or a part of that.
struct Sector {
  geometry::Point2 pole;
  /// 3 x (degree + 1) homogeneous points.
  std::vector<double> curve;
  int degree = 1;
  /// The part of [0, 1] of t.
  geometry::Interval radial;
};

/// The sectors of a region about a pole from which all of it is seen; about the middle of its cell if there is none.
std::vector<Sector> sectors_of(const geometry::TrimmedRegion& region);

/// The halves along the curve (direction 0) or along the rays (1).
std::pair<Sector, Sector> bisect(const Sector& sector, int direction);

/// Points of the unit cell and their weights.
struct SectorRule {
  std::vector<geometry::Point2> places;
  std::vector<double> weights;
};
/// The tensor Gauss-Legendre rule with orders[0] points along the curve and orders[1] along each ray.
SectorRule sector_rule(const Sector& sector, const Orders<2>& orders);

}  // namespace isorim::quadrature
