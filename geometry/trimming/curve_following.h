#pragma once

#include <optional>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/trimming/point_inversion.h"
#include "geometry/vocabulary.h"

/// Walking along a curve in space that lies on a surface, with the parameters in hand.
namespace isorim::geometry {

struct FollowedPoint {
  /// On the curve.
  double t = 0.0;
  Point3 target;
  /// On the surface; continuous along the curve, so at any period of the closed directions.
  Point2 uv;
  SurfaceJet<3> jet;
  /// Of the target from the surface.
  double distance = 0.0;
  /// d(uv) / dt of the nearest point; zero at a pole.
  Vector2 slope = Vector2::Zero();
  /// The side of the rectangle that collapses to this point, -1 if none: the parameter along it is undetermined.
  int pole = -1;
  /// At a breakpoint of the curve or on a knot line of the surface.
  bool is_break = false;
};

class CurveFollower {
 public:
  /// Keeps references to both. `size` is that of the face.
  CurveFollower(const PointInverter& points, const NurbsCurve<3>& curve, double size);

  const ParameterRectangle& rectangle() const { return points_.rectangle(); }

  /// A parameter strictly inside the curve's domain at which it runs through a pole.
  std::optional<double> inner_pole() const;

  /// A few points in every span of the curve, ends included, in order; in each step a closed parameter changes by less
  /// than half a period.
  std::vector<FollowedPoint> follow() const;

  /// These points grouped into stretches that hold no breakpoint of the curve and cross no knot line of the surface:
  /// each begins where the one before it ends, on such a line.
  std::vector<std::vector<FollowedPoint>> smooth_spans(const std::vector<FollowedPoint>& points) const;

  /// The point at t between two neighbouring ones.
  FollowedPoint between(const FollowedPoint& from, const FollowedPoint& to, double t) const;
  /// The point at t, by steps from another one.
  FollowedPoint onwards(const FollowedPoint& from, double t) const { return step(from, t, 0); }
  /// The point at t nearest to the guess.
  FollowedPoint refined(double t, const Point2& guess) const;

  /// The parameters of a point, with parameter d on a side of the rectangle if it is nearer to it than `snap` in space.
  Point2 snapped(const FollowedPoint& point, int d, double snap) const;

 private:
  FollowedPoint first(double t) const;
  FollowedPoint step(const FollowedPoint& from, double t, int depth) const;
  FollowedPoint completed(double t, const Point3& target, const Vector3& derivative, const InvertedPoint& found) const;
  int pole_at(const Point3& target) const;
  /// The parameter, near t and inside the interval, of the point of the curve nearest to the given one.
  double nearest(double t, const Point3& point, Interval inside) const;
  void divide(const FollowedPoint& from, const FollowedPoint& to, int depth, std::vector<FollowedPoint>& points) const;
  FollowedPoint crossing(const FollowedPoint& from, const FollowedPoint& to, int d, double value) const;

  const PointInverter& points_;
  const NurbsCurve<3>& curve_;
  double size_;
  double pole_reach_;
  /// How often the whole surface may still be searched: against curves that are nowhere near it.
  mutable int searches_left_ = 12;
};

}  // namespace isorim::geometry
