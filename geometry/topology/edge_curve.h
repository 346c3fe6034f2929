#pragma once

#include <optional>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/trimming/lifted_curve.h"

namespace isorim::geometry {

/// A curve of a patch's loop in space, prepared for many questions about distances: exact evaluation, and a polygon of
/// points on it that leaves only few places to look at.
class EdgeCurve {
 public:
  /// The surface has to outlive it; the pcurve is kept.
  EdgeCurve(const NurbsSurface<3>& surface, NurbsCurve<2> pcurve);

  /// Of the pcurve, whose parameter all members use.
  Interval domain() const { return pcurve_.domain(); }
  Point3 at(double t) const;
  /// In the direction of the pcurve, seen with the surface.
  LiftedJet jet(double t) const { return lifted_jet(*surface_, pcurve_, t); }
  /// By Gauss-Legendre rules on the legs of the polygon: to 1e-3 of itself on wild curves, 1e-7 on gentle ones.
  double length(Interval part) const;
  double length() const { return length(domain()); }
  /// Rising, the ends of the domain among them: where the curve in space may be less smooth. Of a pcurve that crosses
  /// knot lines of the surface otherwise than along the other parameter: its own breakpoints, its spans divided evenly
  /// into at least as many parts as it may cross.
  std::vector<double> breakpoints() const;
  /// Diagonal of the box of the curve's points.
  double diagonal() const { return (upper_ - lower_).norm(); }
  /// Number of legs of the polygon that have a part in the interval.
  int leg_count(Interval part) const;
  /// The curve is its polygon, run through evenly leg by leg.
  bool has_straight_legs() const;

  struct Foot {
    double t = 0.0;
    double distance = 0.0;
  };
  /// The nearest point over `within`; empty if it is farther than `limit`.
  std::optional<Foot> nearest(const Point3& target, Interval within, double limit) const;
  /// All points over `within` at which the curve comes locally nearest to the target and nearer than `limit`: one for
  /// each time that it passes by.
  std::vector<Foot> feet(const Point3& target, Interval within, double limit) const;

  /// Boxes of at most eight legs each, which hold the curve over `within`.
  struct Box {
    Point3 lower;
    Point3 upper;
  };
  std::vector<Box> boxes(Interval within) const;

 private:
  /// A leg of the polygon: from samples_[i] to samples_[i + 1].
  struct Sample {
    double t = 0.0;
    Point3 point;
    /// How far the curve may leave the leg that starts here.
    double bulge = 0.0;
  };
  struct LegDistance {
    double distance = 0.0;
    double t = 0.0;
  };

  struct Tangent {
    Point3 point;
    Vector3 derivative;
  };
  Tangent tangent(double t) const;
  void sample();
  void append_samples(double t0, const Point3& p0, double t1, const Point3& p1, int depth);
  std::size_t leg_at(double t) const;
  LegDistance leg_distance(std::size_t leg, const Point3& target) const;
  Interval around(std::size_t leg, Interval within) const;
  Foot refine(const Point3& target, double start, Interval within) const;
  Foot bisect_slope(const Point3& target, Foot start, const Tangent& jet, Interval within) const;
  bool may_have_kink(Interval part) const;

  const NurbsSurface<3>* surface_;
  NurbsCurve<2> pcurve_;
  /// The same curve in space, if there is one.
  std::optional<NurbsCurve<3>> exact_;
  /// The surface may turn a corner at knot lines inside its domain.
  bool kinks_u_ = false;
  bool kinks_v_ = false;
  std::vector<Sample> samples_;
  Point3 lower_;
  Point3 upper_;
};

}  // namespace isorim::geometry
