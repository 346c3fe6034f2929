#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "geometry/intersection/bernstein_polynomial.h"
#include "geometry/vocabulary.h"

/// The zero set of a polynomial on one Bézier element: its topology for certain, its points to rounding.
namespace isorim::geometry {

/// The sides of the unit square in the order of boundary_curves().
enum class Side { bottom = 0, right = 1, top = 2, left = 3 };

/// A polynomial on the unit square, freed of the sides on which it vanishes: f = u^a (1 - u)^b v^c (1 - v)^d g.
struct ElementFunction {
  /// f with the coefficients that count as zero left as they are.
  BernsteinGrid whole;
  /// g, with the signs of f inside.
  BernsteinGrid grid;
  /// How often each side was divided out.
  std::array<int, 4> multiplicity{};
  /// f counts as zero everywhere.
  bool vanishes = false;
  /// To which values of g are known.
  double noise = 0.0;
  /// |g| up to this counts as zero at a singular point.
  double coincidence = 0.0;

  /// sum |c_ij| B_i B_j of g: what rounding at a point is relative to. Where weights differ it varies by orders.
  BernsteinGrid magnitude;

  /// To which g is known at a point of the unit square.
  double noise_at(const Point2& point) const { return 1e-15 * evaluate(magnitude, point); }

  bool vanishes_on(Side side) const { return multiplicity[static_cast<std::size_t>(side)] > 0; }
};

/// Divides out the sides along which all coefficients are at most `coincidence` (a degenerate side is one point in
/// space: there f may vanish of a higher order than along an ordinary side).
ElementFunction divide_out_sides(const BernsteinGrid& grid, double coincidence);

/// A stretch of the zero set: points along it, dense enough to tell it from its surroundings, each to rounding; g is
/// negative on its left. It ends on the square's sides or at singular points, or is closed.
struct ZeroChain {
  std::vector<Point2> points;
};

/// Sign charts of the four sides, where the neighbouring element has made them already.
using SideCharts = std::array<std::optional<SignChart>, 4>;

/// The zero set of g on the unit square.
///
/// The square is bisected until in each cell g has no zero, or one derivative has one sign and bounds the other (there
/// the zero set is a graph), or all of the zero set are the two branches through one singular point (a saddle of g with
/// |g| <= coincidence, around which the Hessian varies little). Signs along a line between cells are told once, for
/// both of its sides, so the pieces always fit together. Points and curves where g touches zero without changing its
/// sign (by at most `coincidence`) are passed over. `charts` are those of g along the sides; missing ones are filled
/// in.
///
/// Throws GeometryError, with the place in the unit square, if the sign changes about a singular point that is not an
/// ordinary double point (a cusp, a curve along which two surfaces touch and cross).
std::vector<ZeroChain> zero_chains(const ElementFunction& function, SideCharts& charts);

}  // namespace isorim::geometry
