#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"

/// What a closed shell of surface elements encloses, by triangles refined until the answer is certain.
namespace isorim::geometry {

/// A rational Bézier patch: homogeneous net 4 x (p + 1)(q + 1), u fastest, with its orientation.
struct SurfacePiece {
  HomogeneousPoints<3> net;
  int degree_u = 1;
  int degree_v = 1;
  /// +1 or -1.
  int orientation = 1;
  Point3 lower;
  Point3 upper;

  SurfacePiece(HomogeneousPoints<3> homogeneous, int degree_u, int degree_v, int orientation);
  Point3 corner(int i, int j) const;
  double diagonal() const { return (upper - lower).norm(); }
};

Point3 evaluate(const SurfacePiece& piece, double s, double t);
/// The four quarters.
std::vector<SurfacePiece> quarter(const SurfacePiece& piece);

/// The sign of the volume (+1 if the oriented normals point outward); empty if the shell is nowhere thicker than
/// `thickness` in the mean: volume against area.
std::optional<int> volume_sign(std::span<const SurfacePiece> shell, double thickness);

/// How often the closed shell surrounds the point: +-1 inside, 0 outside (its solid angle over 4 pi, summed over
/// triangles of patches small against their distance: van Oosterom & Strackee 1983). Empty if the point lies nearer
/// than `resolution` or the sum is not near an integer.
std::optional<int> winding_number(std::span<const SurfacePiece> shell, const Point3& point, double resolution);

}  // namespace isorim::geometry
