#pragma once

#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/propeller/generatrix.h"

namespace isorim::geometry {

/// The line along which a blade's face, u round the section and v outward, meets a round hub of any profile about the X
/// axis: v as a function of u.
class BladeFoot {
 public:
  /// A stretch of the line along which neither the face nor the hub has a knot line.
  struct Piece {
    /// Polynomial, over [0, 1], in the face's parameters with u rising; within a few units of rounding of the line.
    NurbsCurve<2> curve;
    /// Of the hub's generatrix.
    int hub_piece = 0;
  };

  /// Holds references to both. Throws GeometryError, with the place, if the face's inner edge lies outside the hub, its
  /// outer edge inside, or if it comes back to the hub farther out (looked for at 128 x 128 places).
  BladeFoot(const NurbsSurface<3>& face, const Generatrix& hub);

  /// Of the line, to rounding.
  double v_at(double u) const;
  Point3 point_at(double u) const { return evaluate(face_, Point2(u, v_at(u))); }
  /// The least and the greatest X of the line.
  Interval extent() const { return extent_; }
  /// In the order of rising u. Throws GeometryError if the line leaves the generatrix.
  std::vector<Piece> pieces() const;

 private:
  /// Distance from the shaft beyond the hub's radius there.
  double height(double u, double v) const;
  /// Throws as the constructor.
  void check_outward(double u) const;
  /// Where the line crosses knot lines of the face or borders of the hub's pieces, with both ends.
  std::vector<double> cuts() const;
  /// Those inside one span of the face's knots.
  void append_cuts(Interval span, std::vector<double>& found) const;

  const NurbsSurface<3>& face_;
  const Generatrix& hub_;
  Interval v_;
  Interval extent_;
};

}  // namespace isorim::geometry
