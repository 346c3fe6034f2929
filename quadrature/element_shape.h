#pragma once

#include <array>
#include <complex>
#include <vector>

#include "quadrature/element_jet.h"
#include "quadrature/sinh_map.h"

/// What the rules of target_rules.h need to know of an element, and where a target's singularity lies in its
/// parameters.
namespace isorim::quadrature {

/// A part of the unit cell.
template <int Directions>
struct Cell {
  geometry::Point<Directions> lower = geometry::Point<Directions>::Zero();
  geometry::Point<Directions> upper = geometry::Point<Directions>::Ones();

  geometry::Point<Directions> clamped(const geometry::Point<Directions>& place) const {
    return place.cwiseMax(lower).cwiseMin(upper);
  }
  double width(std::size_t d) const {
    return upper[static_cast<Eigen::Index>(d)] - lower[static_cast<Eigen::Index>(d)];
  }
};

/// An element seen from afar and from near.
template <int Dim>
struct ElementShape {
  static constexpr std::size_t directions = Dim - 1;

  ElementNet<Dim> net;
  /// A sphere that holds the element.
  geometry::Point<Dim> centre;
  double radius = 0.0;
  /// Half the largest speed in each direction: about the half length of the parameter lines.
  std::array<double, directions> half_length{};
  /// Of the Jacobian times a function of the field's degree, along each direction.
  std::array<Growth, directions> growth;
  struct Sample {
    geometry::Point<Dim - 1> place;
    geometry::Vector<Dim> position;
    std::array<geometry::Vector<Dim>, directions> first;
  };
  std::vector<Sample> samples;
};

/// Resolves the Jacobian's shape as far as a tolerance needs it.
template <int Dim>
ElementShape<Dim> element_shape(const ElementNet<Dim>& net, double field_degree, double tolerance);

/// Without the growth: all that nearest_place() needs.
template <int Dim>
ElementShape<Dim> plain_shape(const ElementNet<Dim>& net);

/// The place of a cell whose point lies nearest to a target, or nearly so: the nearest of the shape's samples, improved
/// by Newton's method kept to the cell. An aid for decisions: rules that are made about it converge if it is a bit off.
template <int Dim>
struct NearestPlace {
  geometry::Point<Dim - 1> place;
  /// There, relative to the target.
  ElementJet<Dim> jet;
  double distance = 0.0;
};
template <int Dim>
NearestPlace<Dim> nearest_place(const ElementShape<Dim>& shape, const Cell<Dim - 1>& cell,
                                const geometry::Point<Dim>& target);

/// A complex t near 0 with |offset + t tangent + t^2 / 2 curvature|^2 = 0 and non-negative imaginary part: where a
/// kernel becomes singular on a line that passes the target at `offset`.
template <int Dim>
std::complex<double> singularity_on_line(const geometry::Vector<Dim>& offset, const geometry::Vector<Dim>& tangent,
                                         const geometry::Vector<Dim>& curvature);

/// A singularity that is extrapolated from a sample at distance d from it is known to a part of d only: this one says
/// nothing new, beside a better known one or so near to the real axis that it may lie on any side of it.
inline bool is_vague(std::complex<double> extrapolated, std::complex<double> known, double sample) {
  constexpr double part = 0.35;
  const double uncertainty = part * std::abs(extrapolated - sample);
  return std::abs(extrapolated - known) < uncertainty || std::abs(extrapolated.imag()) < uncertainty;
}

}  // namespace isorim::quadrature
