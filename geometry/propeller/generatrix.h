#pragma once

#include <vector>

#include "geometry/nurbs/curve.h"

namespace isorim::geometry {

/// The part of a hub's profile that is a function of X, so that blades can stand on it.
class Generatrix {
 public:
  /// One Bézier segment of a leg.
  struct Piece {
    /// Index into legs().
    int leg = 0;
    /// On the leg.
    Interval parameters;
    Interval x;
  };

  /// Curves in (X, distance from the shaft), one after the other with X rising on the whole. Of the stretches of Bézier
  /// segments along which the control points' X does not fall, the longest is taken. Throws GeometryError if there is
  /// none.
  explicit Generatrix(std::vector<NurbsCurve<2>> legs);

  const std::vector<NurbsCurve<2>>& legs() const { return legs_; }
  /// One after the other, rising in X.
  const std::vector<Piece>& pieces() const { return pieces_; }
  Interval extent() const { return {pieces_.front().x.first, pieces_.back().x.last}; }

  /// The last piece that begins at or before X; the first or the last one beyond the ends.
  int piece_at(double x) const;
  /// Of the point at X on the leg of a piece, to rounding; the piece's end for X beyond it.
  double parameter(int piece, double x) const;
  /// The radius at X; beyond the ends that at the end.
  double radius(double x) const;
  /// Over a range of X; to about 1e-5 of itself where the profile is curved.
  double largest_radius(Interval range) const;

 private:
  std::vector<NurbsCurve<2>> legs_;
  std::vector<Piece> pieces_;
};

}  // namespace isorim::geometry
