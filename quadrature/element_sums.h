#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "geometry/vocabulary.h"

/// The innermost loop of all geometric properties: every sum that perimeter, area, volume, centroid and inertia need,
/// over one element and for one rule, in one pass.
namespace isorim::quadrature {

/// Where each sum stands. With n the outward normal, dS the length or area element, x0 the pole and d = x - x0:
///   measure        int dS
///   normal + i     int n_i dS
///   content        int d.n dS                 (= Dim times the enclosed measure)
///   first + i      int (d.n) d_i dS           (= (Dim + 1) times the first moment about x0)
///   second + k     int (d.n) d_i d_j dS       (= (Dim + 2) times the second moment about x0), k as in second_index
template <int Dim>
struct SumLayout {
  static constexpr int measure = 0;
  static constexpr int normal = 1;
  static constexpr int content = 1 + Dim;
  static constexpr int first = 2 + Dim;
  static constexpr int second = 2 + 2 * Dim;
  static constexpr int count = second + Dim * (Dim + 1) / 2;

  /// xx, yy, [zz,] xy, [xz, yz].
  static constexpr int second_index(int i, int j) { return i == j ? second + i : second + Dim + i + j - 1; }
};

template <int Dim>
using ElementSums = Eigen::Array<double, SumLayout<Dim>::count, 1>;

/// Number of points of the Gauss-Legendre rule in each direction.
template <int Directions>
using Orders = std::array<int, Directions>;

/// How many elements are evaluated side by side (one in each lane of a vector register).
inline constexpr int kernel_lanes = 4;

struct RegionMoments;

/// Up to kernel_lanes elements of the same kind.
template <int Dim>
struct ElementBatch {
  /// Their nets, each stored as in ElementTable::nets.
  std::array<const double*, kernel_lanes> nets{};
  int size = 0;
  std::array<int, Dim - 1> degree{};
  /// All weights are 1.
  bool polynomial = false;
  /// For cut elements: what is kept of each. Cut and whole elements do not mix; curves are never cut.
  std::array<const RegionMoments*, kernel_lanes> regions{};
};

/// The sums over each element of the batch by the tensor Gauss-Legendre rule (over cut elements by the weights of
/// region_moments.h at its nodes, of which both numbers are even), with respect to the element's natural
/// normal (BezierElement::orientation is left to the caller). sums holds batch.size entries. Sum factorisation: for
/// n x n points and degree p about 2 (p + 1) multiply-adds a coordinate and point, whatever the number of elements.
/// Compiled for two instruction sets, chosen at run time; the sums of an element do not depend on its lane.
template <int Dim>
void sum_over_elements(const ElementBatch<Dim>& batch, const geometry::Point<Dim>& pole, const Orders<Dim - 1>& orders,
                       std::span<ElementSums<Dim>> sums);

}  // namespace isorim::quadrature
