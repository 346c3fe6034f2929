#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vocabulary.h"

/// Rational Bézier pieces of plane curves, and what can be said of them for certain from their control polygons.
namespace isorim::geometry {

/// A piece of a plane curve, given by its homogeneous Bézier net (3 x (p + 1), positive weights).
struct PlanePiece {
  HomogeneousPoints<2> net;
  Point2 lower;
  Point2 upper;

  explicit PlanePiece(HomogeneousPoints<2> homogeneous);

  Point2 control_point(Eigen::Index i) const { return net.col(i).head<2>() / net(2, i); }
  Point2 start() const { return control_point(0); }
  Point2 end() const { return control_point(net.cols() - 1); }
  double diagonal() const { return (upper - lower).norm(); }
};

/// At s in [0, 1] (de Casteljau).
Point2 evaluate(const PlanePiece& piece, double s);
/// The halves over [0, 1/2] and [1/2, 1].
std::pair<PlanePiece, PlanePiece> bisect(const PlanePiece& piece);
PlanePiece reverse(const PlanePiece& piece);

/// Cuts a piece until each part turns little: the legs of its control polygon stay within 60 degrees of its chord, so a
/// part cannot cross itself (the tangent of a rational Bézier curve lies in the cone of the legs: Floater 1992). Parts
/// not larger than `smallest` stay as they are.
void append_monotone_parts(const PlanePiece& piece, double smallest, std::vector<PlanePiece>& parts);

/// True if the control polygons are farther apart than `distance` along an axis or along a normal of either chord, so
/// the curves are too.
bool are_separated(const PlanePiece& a, const PlanePiece& b, double distance);

/// Twice the area that the pieces, joined end to start, enclose (counter-clockwise positive), to within `bound`.
struct AreaEstimate {
  double value = 0.0;
  double bound = 0.0;
};
/// Bisects until the sign is certain or the bound falls below `resolution`.
AreaEstimate doubled_signed_area(std::span<const PlanePiece> pieces, double resolution);

/// How often the closed chain of pieces runs around `point`; empty if the point lies nearer than `resolution` to the
/// curve. Exact otherwise: a piece whose control points are seen within less than a half turn subtends the angle of its
/// ends.
std::optional<int> winding_number(std::span<const PlanePiece> pieces, const Point2& point, double resolution);

}  // namespace isorim::geometry
