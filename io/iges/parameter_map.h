#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::io::iges {

/// From the parameter that IGES gives to a curve, or to one direction of a surface, to the parameter of the NURBS that
/// stands for it.
///
/// The two agree for lines, splines and parabolas. A circular arc has its angle as parameter, while its rational
/// quadratic pieces have the tangent of half the angle; ellipses and hyperbolas likewise. The map is increasing and
/// continuous; it is an affine or a half-angle tangent function between breakpoints.
class ParameterMap {
 public:
  /// Maps `from` onto `to`. With half_rate = 0 affinely; else as tan(half_rate (t - centre)) does, where half_rate is
  /// half the radians of a unit of t, and |half_rate (t - centre)| < pi / 2.
  struct Piece {
    geometry::Interval from;
    geometry::Interval to;
    double half_rate = 0.0;
    double centre = 0.0;
  };

  /// The identity.
  ParameterMap() = default;
  /// Pieces that follow one another. With `periodic` the map continues past both ends, each turn adding the lengths of
  /// the domain and of the image; else it continues straight, with the slope of its end.
  explicit ParameterMap(std::vector<Piece> pieces, bool periodic = false);

  static ParameterMap affine(geometry::Interval from, geometry::Interval to);
  /// The angles of an arc whose NURBS has `pieces` equal rational quadratic pieces on the knots 0, 1 / pieces, .., 1
  /// (geometry::unit_arc()). radians: of a unit of the parameter (1, or pi / 180 where IGES has degrees).
  static ParameterMap arc(geometry::Interval angles, int pieces, double radians = 1.0, bool periodic = false);

  /// The ends of the domain and of the image are met to the bit, and so are breakpoints.
  double operator()(double t) const;
  double derivative(double t) const;

  bool is_identity() const { return pieces_.empty(); }
  /// One affine function, everywhere.
  bool is_affine() const;
  /// Length after which the map repeats; none if it does not.
  std::optional<double> period() const;
  /// Where the function changes, strictly inside `range`, in increasing order; over all turns of a periodic map. Throws
  /// GeometryError for more than 64 turns.
  std::vector<double> breakpoints(geometry::Interval range) const;
  /// Empty for the identity.
  std::span<const Piece> pieces() const { return pieces_; }
  /// Only for maps with pieces.
  geometry::Interval domain() const { return {pieces_.front().from.first, pieces_.back().from.last}; }
  geometry::Interval image() const { return {pieces_.front().to.first, pieces_.back().to.last}; }

  /// t -> map(t + by).
  ParameterMap shifted(double by) const;
  /// The map with its domain moved affinely onto `domain`. Throws GeometryError for the identity, which has none.
  ParameterMap over(geometry::Interval domain) const;

 private:
  double inside(double t) const;

  std::vector<Piece> pieces_;
  bool periodic_ = false;
};

}  // namespace isorim::io::iges
