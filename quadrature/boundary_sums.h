#pragma once

#include <cstdint>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/element_sums.h"
#include "quadrature/estimate.h"
#include "quadrature/options.h"

namespace isorim::quadrature {

/// The sums of SumLayout over a whole boundary, with respect to its outward normal.
template <int Dim>
struct BoundarySums {
  ElementSums<Dim> value;
  /// Estimated absolute error of each, rounding included.
  ElementSums<Dim> error;
  /// The part of each error that no rule can lower: differences below it count as rounding.
  ElementSums<Dim> rounding;
  /// Points of the boundary at which position and tangents were evaluated.
  std::int64_t evaluations = 0;
  /// Every element is polynomial, so all sums but the measure are exact up to rounding, whatever is cut off.
  bool exact = false;
  /// Every element is an affine image of its cell, so the measure is exact as well.
  bool exact_measure = false;
};

/// Which sums the tolerance of Options is aimed at. The rest is computed all the same.
enum class SumScope { measure_only, all };

/// Adaptive, in parallel, the same bits for any number of threads. The tolerance is relative to the measure; to the
/// content; to the size for the centroid that the first moments give; and to its trace for the inertia about the
/// centroid.
template <int Dim>
BoundarySums<Dim> boundary_sums(const geometry::ElementTable<Dim>& table, const geometry::Point<Dim>& pole,
                                SumScope scope, const Options& options);

}  // namespace isorim::quadrature
