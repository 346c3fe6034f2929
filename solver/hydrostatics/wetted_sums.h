#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/element_piece.h"
#include "quadrature/options.h"

/// The integrals over a part of a boundary from which all hydrostatics follow.
namespace isorim::solver {

/// Where each integral stands. With n the outward normal, x0 a fixed point and y = x - x0:
///   area             int dS
///   normal + j       int n_j dS
///   first + 3 i + j  int y_i n_j dS
///   second + 3 k + j int y_a y_b n_j dS, k the place of (a, b) in xx, yy, zz, xy, xz, yz
struct WettedLayout {
  static constexpr int area = 0;
  static constexpr int normal = 1;
  static constexpr int first = 4;
  static constexpr int second = 13;
  static constexpr int count = 31;

  static constexpr int first_index(int i, int j) { return first + 3 * i + j; }
  static constexpr int second_index(int a, int b, int j) { return second + 3 * (a == b ? a : a + b + 2) + j; }
};

using WettedArray = Eigen::Array<double, WettedLayout::count, 1>;

/// Sums over pieces of a boundary.
struct WettedSums {
  WettedArray value = WettedArray::Zero();
  /// Estimated absolute errors, without rounding.
  WettedArray error = WettedArray::Zero();
  /// Sums of absolute values: what rounding is relative to.
  WettedArray magnitude = WettedArray::Zero();
  /// Points at which the boundary was evaluated.
  std::int64_t evaluations = 0;
  /// Pieces on which the tolerance was not reached.
  std::int64_t unfinished = 0;

  WettedSums& operator+=(const WettedSums& other);
};

/// What the tolerance is relative to: rough integrals over the whole boundary.
struct WettedScales {
  double area = 0.0;
  double volume = 0.0;
  /// The largest distance of a control point from x0.
  double radius = 0.0;
  /// The largest absolute coordinate of a control point: positions are known to a rounding of it.
  double coordinate = 0.0;
  std::size_t elements = 1;
};

/// Whether the area is wanted to the tolerance as well. It alone is not a polynomial on polynomial elements.
enum class WettedScope { moments, moments_and_area };

/// The integrals over one element or what is left of it. Elements with unit weights: exact but for rounding, by one
/// rule (all but the area); others adaptively, to the tolerance relative to the scales. One thread.
WettedSums integrate_piece(const quadrature::ElementPiece<3>& piece, const geometry::Point3& x0,
                           const WettedScales& scales, WettedScope scope, double tolerance);

/// The same by three Gauss points in each direction, for the scales.
WettedArray rough_integrals(const quadrature::ElementPiece<3>& piece, const geometry::Point3& x0);

}  // namespace isorim::solver
