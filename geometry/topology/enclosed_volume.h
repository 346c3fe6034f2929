#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"

/// What a closed shell of surface elements encloses.
namespace isorim::geometry {

/// A directed chord in the unit cell of an element.
struct CellChord {
  Point2 from;
  Point2 to;
};

/// A rational Bézier patch, or the part of one that its region keeps, with its orientation.
struct SurfacePiece {
  /// 4 x (p + 1)(q + 1) homogeneous points, u fastest.
  HomogeneousPoints<3> net;
  int degree_u = 1;
  int degree_v = 1;
  /// +1 or -1.
  int orientation = 1;
  /// Of a cut element, in the element table, which has to outlive the piece; null: all is kept.
  const TrimmedRegion* region = nullptr;
  /// Of a part of a cut element: closed chains of chords, in any order, the kept part on their left.
  std::vector<CellChord> outline;
  /// Box of the control points.
  Point3 lower;
  Point3 upper;

  SurfacePiece(HomogeneousPoints<3> homogeneous, int degree_u, int degree_v, int orientation);
  bool is_cut() const { return region != nullptr || !outline.empty(); }
  double diagonal() const { return (upper - lower).norm(); }
};

/// `sign` times the orientation of the element.
SurfacePiece surface_piece(const ElementTable<3>& table, const BezierElement<3>& element, int sign);

Point3 evaluate(const SurfacePiece& piece, double s, double t);
/// A point of the kept part, on its rim if it is cut, otherwise off the middle and all regular places.
Point3 probe_point(const SurfacePiece& piece);

/// The sign of the volume (+1 if the oriented normals point outward), by the flux of x / 3 with Gauss-Legendre rules of
/// rising order until two agree to a tenth of the volume, small ones twice; cut elements by the radial integration of
/// their regions. Empty if they do not agree with 32 points in each direction, or the volume is lost in rounding.
std::optional<int> volume_sign(std::span<const SurfacePiece> shell);

/// How often the closed shell surrounds the point: +-1 inside, 0 outside (its solid angle over 4 pi, summed over
/// triangles of pieces small against their distance: van Oosterom & Strackee 1983). Empty if the point lies nearer
/// than `resolution` or the sum is not near an integer.
std::optional<int> winding_number(std::span<const SurfacePiece> shell, const Point3& point, double resolution);

}  // namespace isorim::geometry
