#pragma once

#include "geometry/hull/offset_table.h"

/// Offsets that are as fair as their accuracy allows.
namespace isorim::geometry {

struct FairedOffsets {
  OffsetTable table;
  /// How many half-breadths have been moved, and the largest move.
  int moved = 0;
  double largest_move = 0.0;
  /// Of the given and of the faired table: see fair_offsets().
  double roughness_before = 0.0;
  double roughness = 0.0;
};

/// Moves half-breadths by at most `tolerance`, a length, to the least roughness: with xi = x / length and zeta = z /
/// draught the sum over the waterlines of int (d3y / dxi3)^2 dxi, times their spacing in zeta, and over the sections of
/// int (d3y / dzeta3)^2 dzeta, times theirs in xi, in units of half the beam, all by divided differences of
/// neighbouring offsets. (The same measure as that of splines, ../spline/smoothest_spline.h.) Offsets of a form of
/// degree two in x and z are not moved. The minimum under bounds is unique up to 1e-9 of the curvature of the measure,
/// and found by Newton's method with projection (D. P. Bertsekas, SIAM J. Control Optim. 20 (1982) 221-246).
///
/// What is zero stays zero; so do three or more successive offsets that are equal, along a waterline or a section (flat
/// of side, parallel middle body), and half the beam. No offset becomes negative or leaves half the beam. Differences
/// are not taken across knuckles, whose lines, like keel, deck and contours, stay. Throws GeometryError as check()
/// does, and for a tolerance that is not positive.
FairedOffsets fair_offsets(const OffsetTable& table, double tolerance);

}  // namespace isorim::geometry
