#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/spline/knot_vector.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A rational B-spline curve in the plane (Dim = 2) or in space (Dim = 3); valid from construction on. It is a
/// polynomial B-spline exactly when all weights are equal: nothing else tells the two apart.
template <int Dim>
class NurbsCurve {
 public:
  /// homogeneous: (Dim + 1) x knots.basis_count(), columns (w x, .., w). Throws GeometryError if the counts differ,
  /// a coordinate is not finite, or a weight is not positive; the message names the index and the value.
  NurbsCurve(KnotVector knots, HomogeneousPoints<Dim> homogeneous);
  /// Cartesian points and weights (one each; empty means all 1).
  static NurbsCurve from_points(KnotVector knots, const Points<Dim>& points, std::span<const double> weights = {});

  const KnotVector& knots() const { return knots_; }
  const HomogeneousPoints<Dim>& homogeneous() const { return homogeneous_; }
  int degree() const { return knots_.degree(); }
  Interval domain() const { return knots_.domain(); }
  /// Dim x n Cartesian control points.
  Points<Dim> control_points() const;
  Eigen::VectorXd weights() const { return homogeneous_.row(Dim).transpose(); }
  /// All weights equal, bit for bit.
  bool is_polynomial() const;

 private:
  KnotVector knots_;
  HomogeneousPoints<Dim> homogeneous_;
};

/// Position and derivatives with respect to the parameter.
template <int Dim>
struct CurveJet {
  Point<Dim> point;
  Vector<Dim> du;
  Vector<Dim> duu;
};

/// At a breakpoint derivatives are the limits from the right, at the domain's end from the left. A parameter
/// outside the domain continues the end segment.
template <int Dim>
Point<Dim> evaluate(const NurbsCurve<Dim>& curve, double u);
/// Piegl & Tiller, eq. 4.8.
template <int Dim>
CurveJet<Dim> evaluate_jet(const NurbsCurve<Dim>& curve, double u);

template <int Dim>
NurbsCurve<Dim> insert_knot(const NurbsCurve<Dim>& curve, double u, int times = 1);
template <int Dim>
NurbsCurve<Dim> refine_knots(const NurbsCurve<Dim>& curve, std::span<const double> new_knots);

template <int Dim>
struct CurveKnotRemoval {
  NurbsCurve<Dim> curve;
  int removed = 0;
  /// Bound on the distance that any point of the curve moved.
  double error_bound = 0.0;
};
/// Removes the inner knot u up to `times` times while no point moves by more than `tolerance`
/// (Piegl & Tiller, A5.8 with the tolerance of eq. 5.30 for rational curves).
template <int Dim>
CurveKnotRemoval<Dim> remove_knot(const NurbsCurve<Dim>& curve, double u, int times, double tolerance);

template <int Dim>
NurbsCurve<Dim> elevate_degree(const NurbsCurve<Dim>& curve, int times);
template <int Dim>
NurbsCurve<Dim> clamp(const NurbsCurve<Dim>& curve);
/// Both halves keep their part of the parameter interval. u strictly inside the domain.
template <int Dim>
std::pair<NurbsCurve<Dim>, NurbsCurve<Dim>> split(const NurbsCurve<Dim>& curve, double u);
template <int Dim>
NurbsCurve<Dim> restrict_to(const NurbsCurve<Dim>& curve, Interval piece);
template <int Dim>
NurbsCurve<Dim> reverse(const NurbsCurve<Dim>& curve);
template <int Dim>
NurbsCurve<Dim> transform(const NurbsCurve<Dim>& curve, const AffineMap<Dim>& map);
/// The same curve over another parameter interval (affine reparametrisation).
template <int Dim>
NurbsCurve<Dim> reparametrise(const NurbsCurve<Dim>& curve, Interval domain);

template <int Dim>
struct ClosestCurvePoint {
  double u = 0.0;
  Point<Dim> point;
  double distance = 0.0;
};
/// The globally closest point of the curve: branch and bound on the Bézier segments' control polygons, then Newton
/// to rounding. Ends and kinks count, and at a jump both ends of the gap. Of several equally near points the one with
/// the smallest parameter. Throws GeometryError if the target is not finite.
template <int Dim>
ClosestCurvePoint<Dim> closest_point(const NurbsCurve<Dim>& curve, const Point<Dim>& target);

struct ArcLength {
  double value = 0.0;
  /// Estimate of the absolute error.
  double error = 0.0;
};
/// Length of the curve over `piece` (inside the domain, else GeometryError), adaptive to the relative tolerance by
/// Gauss-Kronrod rules of 7 and 15 points. A jump adds nothing. The error is at least half the true one.
template <int Dim>
ArcLength arc_length(const NurbsCurve<Dim>& curve, Interval piece, double tolerance = 1e-14);
/// The parameter at which the length from the domain's start reaches `length` (clipped to the domain). Throws
/// GeometryError for a NaN.
template <int Dim>
double parameter_at_length(const NurbsCurve<Dim>& curve, double length, double tolerance = 1e-14);

/// Joins curves end to start (each end within `tolerance` of the next start) into one, degrees raised to the
/// largest, inner ends as knots of multiplicity equal to the degree. The first curve keeps its parameters, the others
/// follow with the lengths of their domains; two ends meet halfway. Throws GeometryError at a gap, with its size.
template <int Dim>
NurbsCurve<Dim> join(std::span<const NurbsCurve<Dim>> curves, double tolerance);

/// The x, y plane of space; z = 0.
NurbsCurve<3> embed(const NurbsCurve<2>& curve);

}  // namespace isorim::geometry
