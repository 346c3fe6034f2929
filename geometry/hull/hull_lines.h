#pragma once

#include <span>
#include <vector>

#include "geometry/intersection/plane_section.h"
#include "geometry/intersection/section_spline.h"
#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// The lines of a hull: where its port half meets planes.
namespace isorim::geometry {

/// A plane through a line parallel to x in the centre plane, inclined outwards and downwards.
struct DiagonalPlane {
  /// z of that line.
  double height = 0.0;
  /// Radians below the horizontal, in (0, pi / 2).
  double angle = 0.0;
};

struct LinePlanes {
  /// x.
  std::vector<double> stations;
  /// z.
  std::vector<double> waterlines;
  /// y, positive.
  std::vector<double> buttocks;
  std::vector<DiagonalPlane> diagonals;
};

/// One line: the curves of a plane section. They are on the surface exactly and on the plane to rounding.
struct HullLine {
  /// x, z or y of the plane; of a diagonal, its height.
  double at = 0.0;
  PlaneFrame frame;
  std::vector<SectionCurve> curves;
  /// Of the curves, in the coordinates of the frame.
  std::vector<SectionSpline> splines;
};

/// In the coordinates of their frames stations are (y, z), waterlines (x, y), buttocks (x, z), diagonals x and the
/// distance from the centre plane within the plane.
struct HullLines {
  std::vector<HullLine> stations;
  std::vector<HullLine> waterlines;
  std::vector<HullLine> buttocks;
  std::vector<HullLine> diagonals;
};

/// Cuts the bands of a port half. Planes that do not meet it give lines without curves; parts of the surface that lie
/// in a plane (a flat of side in a buttock plane) have none. The splines follow the curves to `fit_tolerance` times the
/// size. Throws GeometryError as PlaneCutter::section() and fit_section() do.
HullLines hull_lines(std::span<const NurbsSurface<3>> port, const LinePlanes& planes, double fit_tolerance = 1e-8);

}  // namespace isorim::geometry
