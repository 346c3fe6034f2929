#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/nurbs/curve.h"

namespace isorim::geometry {

/// The two parametric directions of a surface.
enum class Direction { u = 0, v = 1 };

/// A rational tensor-product B-spline surface; valid from construction on.
///
/// Its natural normal is S_u x S_v. The control net is stored with u fastest: point (i, j) is column
/// i + j * nu.
template <int Dim>
class NurbsSurface {
 public:
  /// homogeneous: (Dim + 1) x (nu nv), columns (w x, .., w). Throws GeometryError as NurbsCurve does, naming (i, j).
  NurbsSurface(KnotVector knots_u, KnotVector knots_v, HomogeneousPoints<Dim> homogeneous);
  static NurbsSurface from_points(KnotVector knots_u, KnotVector knots_v, const Points<Dim>& points,
                                  std::span<const double> weights = {});

  const KnotVector& knots(Direction d) const { return d == Direction::u ? knots_u_ : knots_v_; }
  const KnotVector& knots_u() const { return knots_u_; }
  const KnotVector& knots_v() const { return knots_v_; }
  const HomogeneousPoints<Dim>& homogeneous() const { return homogeneous_; }
  int count_u() const { return knots_u_.basis_count(); }
  int count_v() const { return knots_v_.basis_count(); }
  /// Dim x (nu nv) Cartesian control points.
  Points<Dim> control_points() const;
  Eigen::VectorXd weights() const { return homogeneous_.row(Dim).transpose(); }
  bool is_polynomial() const;

 private:
  KnotVector knots_u_;
  KnotVector knots_v_;
  HomogeneousPoints<Dim> homogeneous_;
};

template <int Dim>
struct SurfaceJet {
  Point<Dim> point;
  Vector<Dim> du;
  Vector<Dim> dv;
  Vector<Dim> duu;
  Vector<Dim> duv;
  Vector<Dim> dvv;
};

template <int Dim>
Point<Dim> evaluate(const NurbsSurface<Dim>& surface, const Point2& uv);
/// Piegl & Tiller, eq. 4.20; limits at breakpoints as for curves.
template <int Dim>
SurfaceJet<Dim> evaluate_jet(const NurbsSurface<Dim>& surface, const Point2& uv);

template <int Dim>
NurbsSurface<Dim> insert_knot(const NurbsSurface<Dim>& surface, Direction direction, double u, int times = 1);
template <int Dim>
NurbsSurface<Dim> refine_knots(const NurbsSurface<Dim>& surface, Direction direction,
                               std::span<const double> new_knots);

template <int Dim>
struct SurfaceKnotRemoval {
  NurbsSurface<Dim> surface;
  int removed = 0;
  double error_bound = 0.0;
};
/// As for curves; the bound holds for every point of the surface.
template <int Dim>
SurfaceKnotRemoval<Dim> remove_knot(const NurbsSurface<Dim>& surface, Direction direction, double u, int times,
                                    double tolerance);

template <int Dim>
NurbsSurface<Dim> elevate_degree(const NurbsSurface<Dim>& surface, Direction direction, int times);
template <int Dim>
NurbsSurface<Dim> clamp(const NurbsSurface<Dim>& surface);
template <int Dim>
std::pair<NurbsSurface<Dim>, NurbsSurface<Dim>> split(const NurbsSurface<Dim>& surface, Direction direction, double u);
template <int Dim>
NurbsSurface<Dim> restrict_to(const NurbsSurface<Dim>& surface, Interval u, Interval v);
/// The surface over a larger domain in one direction, in which its first and last elements continue as they are. Throws
/// GeometryError if `domain` does not contain the surface's, and if a weight would not stay positive.
template <int Dim>
NurbsSurface<Dim> extend(const NurbsSurface<Dim>& surface, Direction direction, Interval domain);
/// Reverses one parameter, so the normal turns round.
template <int Dim>
NurbsSurface<Dim> reverse(const NurbsSurface<Dim>& surface, Direction direction);
/// (u, v) -> surface(v, u); the normal turns round.
template <int Dim>
NurbsSurface<Dim> swap_directions(const NurbsSurface<Dim>& surface);
/// A map with negative determinant turns the natural normal round.
template <int Dim>
NurbsSurface<Dim> transform(const NurbsSurface<Dim>& surface, const AffineMap<Dim>& map);

/// The curve u -> S(u, value) (direction = u) or v -> S(value, v) (direction = v): the direction is the one that
/// the curve runs in.
template <int Dim>
NurbsCurve<Dim> isoparametric_curve(const NurbsSurface<Dim>& surface, Direction direction, double value);

/// The four boundary curves in the order v = first, u = last, v = last, u = first, each in the direction of its
/// increasing parameter.
template <int Dim>
std::array<NurbsCurve<Dim>, 4> boundary_curves(const NurbsSurface<Dim>& surface);

template <int Dim>
struct ClosestSurfacePoint {
  Point2 uv;
  Point<Dim> point;
  double distance = 0.0;
};
/// The globally closest point, by branch and bound on Bézier patches and Newton; edges and corners count.
///
/// The distance is right to 1e-10 of itself, and to rounding wherever the nearest point is an ordinary minimum. A
/// search that meets a whole line of equally near points across the parameters ends after 200 000 parts with the best
/// of them. Beside a degenerate pole the place is known to the square root of rounding only.
/// Throws GeometryError if the target is not finite.
template <int Dim>
ClosestSurfacePoint<Dim> closest_point(const NurbsSurface<Dim>& surface, const Point<Dim>& target);

}  // namespace isorim::geometry
