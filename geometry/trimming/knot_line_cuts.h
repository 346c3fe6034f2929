#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/trimming/parameter_grid.h"
#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {

/// A part of a trimming curve that lies in one cell of the grid, or along one knot line.
struct CutPiece {
  /// 3 x (p + 1); its end points are those below.
  HomogeneousPoints<2> net;
  GridPoint start;
  GridPoint end;
  /// Where the piece lies in u and v, numbered as GridCoordinate::station. Both odd: inside a cell (the ends may be on
  /// its edges). One even: along that line.
  std::array<int, 2> station{};

  bool is_along_line() const { return station[0] % 2 == 0 || station[1] % 2 == 0; }
};

/// The loops cut wherever they cross or touch a knot line, the cut points exactly on it.
///
/// The pieces form closed chains: each ends in the very point in which the next one starts. Of what lies outside the
/// surface's domain the nearest point of the domain takes the place, so pieces outside become pieces along its edges.
/// Whatever lies within rounding of a knot line is along it. Each piece fits its station: both ends lie in the closed
/// cell, or on the line and at most at the ends of its span.
std::vector<CutPiece> cut_at_knot_lines(std::span<const TrimLoop> loops, const ParameterGrid& grid);

}  // namespace isorim::geometry
