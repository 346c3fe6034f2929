#pragma once

#include <complex>
#include <span>
#include <vector>

#include "quadrature/direction_rule.h"
#include "quadrature/near_request.h"

namespace isorim::quadrature {

/// A curve in the unit cell: 3 x (degree + 1) homogeneous points.
using CellCurve = geometry::HomogeneousPoints<2>;

/// The four sides of a cell, counter-clockwise.
std::vector<CellCurve> sides(const Cell<2>& cell);

/// The integral over a region of the unit cell in polar coordinates about a pole c,
///
///   sum over the boundary's curves of int int_0^1 g(c + t (C(s) - c)) t dt (C - c) x C' ds,
///
/// for integrands with a singularity at the pole, or above it at the target. Along the rays the factor t cancels a 1 /
/// r, and a sinh map takes account of a target off the surface. Along a curve a sinh map about the point nearest to the
/// pole, in the metric of the surface at the pole, makes up for its nearness: on a straight side it is the angle's
/// substitution by Gudermann's function. Both leave integrands that are analytic in strips of width pi.
///
/// Where the region is not star-shaped about the pole, rays leave it and enter it again and the parts outside cancel.
/// If the pole is not in the region, neither are its surroundings, whose parts cancel as well: rays start only at an
/// ellipse about the pole that the region does not reach, and the singularity is never met.
class PolarRule {
 public:
  enum class Around {
    /// The pole belongs to the region.
    place,
    /// It does not.
    hole,
  };
  /// The jet is that at the pole, relative to the target; its offset is zero for an own target.
  PolarRule(const NearRequest<3>& request, std::span<const CellCurve> curves, const geometry::Point2& pole,
            const ElementJet<3>& jet, bool is_own, Around around);

  int points() const;
  int most_points_on_a_line() const;
  void append(NodeBuffer<3>& nodes) const;

 private:
  using Complex = std::complex<double>;

  /// The metric of the surface at the pole: squared lengths of steps in the parameters. Kept away from singular.
  struct Metric {
    double uu = 0.0;
    double vv = 0.0;
    double uv = 0.0;

    double product(const geometry::Vector2& a, const geometry::Vector2& b) const {
      return uu * a[0] * b[0] + vv * a[1] * b[1] + uv * (a[0] * b[1] + a[1] * b[0]);
    }
  };
  /// What a curve spans with the pole.
  struct Sector {
    CellCurve curve;
    DirectionRule along;
    int radial_points = 0;
  };

  /// A bound from below of the distance from the pole to the curves, in the metric: at most a tenth too small.
  double clearance_from(std::span<const CellCurve> curves) const;
  double distance_bound(const CellCurve& curve) const;
  static Metric metric_of(const ElementShape<3>& shape, const ElementJet<3>& jet);
  void add_curve(const CellCurve& curve, int depth);
  /// The element at a point of a curve.
  struct SidePoint {
    double s = 0.0;
    geometry::Vector2 ray;
    geometry::Vector2 first;
    geometry::Vector2 second;
    ElementJet<3> jet;
  };
  std::vector<SidePoint> side_points(const CellCurve& curve, double nearest) const;
  int points_along(const CellCurve& curve, const SinhMap& map, double log_rho, double reach) const;
  Complex nearest_on_curve(const CellCurve& curve) const;
  Complex complex_root(const CellCurve& curve, Complex guess) const;
  geometry::Vector3 tangent(const geometry::Vector2& ray) const;
  geometry::Vector3 curvature(const geometry::Vector2& ray) const;
  Complex singularity(const geometry::Vector2& ray) const;
  Complex distant_singularity(const geometry::Vector2& ray) const;
  /// A ray from start to 1.
  struct Ray {
    double start;
    SinhMap map;
    /// From the coordinate on the whole ray to that of the map.
    Complex inside(Complex t) const { return (t - start) / (1.0 - start); }
    Complex outside(Complex x) const { return start + x * (1.0 - start); }
  };
  Ray radial_map(const geometry::Vector2& ray) const;
  int radial_points(const SidePoint& end) const;
  void append(const Sector& sector, NodeBuffer<3>& nodes) const;

  const NearRequest<3>& request_;
  geometry::Point2 pole_;
  ElementJet<3> jet_;
  bool is_own_;
  double distance_;
  /// In the metric.
  double inner_radius_ = 0.0;
  Metric metric_;
  std::vector<Sector> sectors_;
};

}  // namespace isorim::quadrature
