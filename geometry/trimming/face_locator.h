#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {

/// Tells which points of the parameters are kept. Made once for a face; each question costs in proportion to the number
/// of Bézier pieces of its loops.
class FaceLocator {
 public:
  explicit FaceLocator(const TrimmedSurface& face);
  /// Of loops alone, which need not be sound: for telling which lies in which. Throws GeometryError if they are points
  /// or lie on one line of constant u or v.
  explicit FaceLocator(std::span<const TrimLoop> loops);

  /// How often the loops run around uv, counter-clockwise: 1 in what a sound face keeps, else 0. Nothing if uv is
  /// nearer than `resolution` to a loop, relative to the loops' extent in each parameter. Exact otherwise.
  std::optional<int> winding_number(const Point2& uv, double resolution = 1e-12) const;
  /// The same for sound faces; nothing on the loops.
  std::optional<bool> contains(const Point2& uv, double resolution = 1e-12) const;

  /// A point around which the loops run, far from them in u and in v. Throws GeometryError if there is none (the
  /// loops enclose nothing, or something thinner than a thousandth of their extent that all probes miss).
  Point2 interior_point() const;

 private:
  void build(std::vector<PlanePiece> pieces);
  std::vector<double> crossings(Eigen::Index direction, double level) const;
  std::optional<Interval> kept_interval(Eigen::Index direction, const Point2& through) const;
  double clearance(const Point2& point, Interval in_u, Interval in_v) const;
  std::optional<Point2> longest_on_level(double level) const;
  std::optional<Point2> best_of_levels(int count) const;

  /// In the unit square of the loops' extent.
  std::vector<PlanePiece> pieces_;
  Point2 corner_;
  Vector2 size_;
};

/// Whether the face keeps uv; nothing if uv lies on a loop. For many points make a FaceLocator.
std::optional<bool> contains(const TrimmedSurface& face, const Point2& uv);
/// A point well inside of what the face keeps.
Point2 interior_point(const TrimmedSurface& face);

}  // namespace isorim::geometry
