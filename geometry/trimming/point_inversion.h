#pragma once

#include <vector>

#include "geometry/trimming/parameter_rectangle.h"
#include "geometry/vocabulary.h"

/// The parameters of points that lie on a surface or near it.
namespace isorim::geometry {

struct InvertedPoint {
  /// At any period of a closed direction: the one at which the search started.
  Point2 uv;
  SurfaceJet<3> jet;
  double distance = 0.0;
};

class PointInverter {
 public:
  /// Keeps a reference to the rectangle. Points nearer to the surface than `sure` are taken as found wherever the
  /// search met them.
  PointInverter(const ParameterRectangle& rectangle, double sure);

  const ParameterRectangle& rectangle() const { return *rectangle_; }
  double sure() const { return sure_; }

  /// The nearest point of the surface about the guess, by Newton's method, to rounding. Open directions end at the
  /// sides of the rectangle, closed ones go on with the next period.
  InvertedPoint refine(const Point3& target, const Point2& guess) const;

  /// The nearest point of the whole surface: from the nearest point of a grid if that is surely right, else by
  /// closest_point().
  InvertedPoint locate(const Point3& target) const;

 private:
  void make_grid() const;

  const ParameterRectangle* rectangle_;
  double sure_;
  /// Made at the first call of locate().
  mutable std::vector<Point2> grid_;
  mutable Points<3> grid_points_;
};

}  // namespace isorim::geometry
