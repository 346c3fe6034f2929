#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/spline/knot_vector.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// The degree + 1 Bernstein polynomials on [0, 1] and their derivatives at s, on the stack.
struct BernsteinJet {
  std::array<double, KnotVector::max_degree + 1> values;
  std::array<double, KnotVector::max_degree + 1> derivatives;
};
BernsteinJet bernstein_jet(int degree, double s);

/// Where a place of an element's unit cell lies, and how the element runs there.
template <int Dim>
struct ElementJet {
  Point<Dim> position;
  /// Column d: the derivative by coordinate d of the unit cell.
  Eigen::Matrix<double, Dim, Dim - 1> tangents;
  /// orientation times (y', -x') or S_s x S_t: outward, its length the Jacobian.
  Vector<Dim> area_vector;

  /// Unit, outward; zero at a degenerate place (a pole).
  Vector<Dim> normal() const {
    const double jacobian = area_vector.stableNorm();
    return jacobian > 0.0 ? Vector<Dim>(area_vector / jacobian) : Vector<Dim>(Vector<Dim>::Zero());
  }
};

/// By the Bernstein basis, to a few roundings.
template <int Dim>
ElementJet<Dim> evaluate_jet(const ElementTable<Dim>& table, const BezierElement<Dim>& element,
                             const Point<Dim - 1>& place);

}  // namespace isorim::geometry
