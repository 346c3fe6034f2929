#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// Surfaces given by Bézier extraction: what a T-spline is once its T-mesh has been worked out, and all that `.iga`,
/// `.be` and BEXT files say of one.
namespace isorim::geometry {

/// One Bézier element of an extracted surface.
struct ExtractionElement {
  /// 1 to KnotVector::max_degree.
  std::array<std::int8_t, 2> degree{};
  /// Indices of the functions that live on the element.
  std::vector<std::int32_t> functions;
  /// functions.size() x (p + 1)(q + 1): row k holds function k's coefficients in the Bernstein basis of the element's
  /// unit cell, the first parameter fastest. Rows need not be positive, and their sum need not be one.
  Eigen::MatrixXd rows;
  /// The element's cell in the parameters of its T-mesh; the unit square where none is known.
  std::array<Interval, 2> domain;
};

/// A surface S = sum w_a N_a P_a / sum w_a N_a by its functions N_a, element by element; valid from construction on.
///
/// Elements meet along their edges, or along parts of them (T-junctions make one edge face several). The natural normal
/// is S_s x S_t of every element; all elements look to the same side. (orient() finds out whether
/// they do.)
class ExtractedSurface {
 public:
  /// homogeneous: 4 x n, columns (w x, w y, w z, w). Throws GeometryError, naming element or function, for a weight
  /// that is not positive, a number that is not finite, a degree or an index out of range, a function twice in one
  /// element, a row of wrong length, an empty domain, a Bézier weight (bezier_net) that is not positive or more than
  /// 1e10 times smaller than another of its element, or no elements.
  ExtractedSurface(HomogeneousPoints<3> homogeneous, std::vector<ExtractionElement> elements);

  const HomogeneousPoints<3>& homogeneous() const { return homogeneous_; }
  const std::vector<ExtractionElement>& elements() const { return elements_; }
  int function_count() const { return static_cast<int>(homogeneous_.cols()); }

 private:
  HomogeneousPoints<3> homogeneous_;
  std::vector<ExtractionElement> elements_;
};

/// Sums of functions that differ from one by no more than this many times the magnitude of their coefficients (at least
/// 1) do so for rounding alone.
inline constexpr double partition_rounding = 16.0 * std::numeric_limits<double>::epsilon();

/// The largest |sum of the functions - 1| on each element, from the column sums of its rows (a bound that is reached at
/// corners): zero but for rounding for analysis-suitable T-splines.
std::vector<double> partition_defects(const ExtractedSurface& surface);

/// 4 x (p + 1)(q + 1) homogeneous Bézier points Q = (w P, w) C of an element, the first parameter fastest.
///
/// Where the weights of all functions on the element are equal, bit for bit, and the functions sum to one but for
/// rounding, so are the weights of Q: rounding does not make a polynomial element rational.
HomogeneousPoints<3> bezier_net(const ExtractedSurface& surface, int element);

/// The element as a surface of its own, with its Bézier points, over the unit square.
NurbsSurface<3> bezier_surface(const ExtractedSurface& surface, int element);

/// A map with negative determinant turns the natural normal round.
ExtractedSurface transform(const ExtractedSurface& surface, const AffineMap<3>& map);

}  // namespace isorim::geometry
