#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/trimming/knot_line_cuts.h"
#include "geometry/trimming/parameter_grid.h"
#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {

/// The kept part of one cell.
struct CellRegion {
  /// The smallest rectangle that holds the region, but for a small excess (1/64 of its sides) and for sides that the
  /// cell itself has nearly there: in the parameters of the surface.
  Interval u;
  Interval v;
  /// In the unit cell of that rectangle.
  TrimmedRegion region;
};

/// What a trimmed surface keeps of each cell of its knot lines.
struct FaceCells {
  static constexpr std::int32_t outside = -2;
  static constexpr std::int32_t whole = -1;

  int columns = 0;
  int rows = 0;
  /// For each cell, u fastest: outside, whole, or an index into regions.
  std::vector<std::int32_t> state;
  std::vector<CellRegion> regions;

  std::int32_t at(int column, int row) const {
    return state[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

/// Throws GeometryError if the loops enclose a cell other than once or never (overlapping or wrongly directed loops),
/// with a place that shows it.
FaceCells cut_into_cells(const TrimmedSurface& face);

/// The step behind: from pieces that form closed chains. Throws NumericalError if they do not.
FaceCells assemble_cells(std::span<const CutPiece> pieces, const ParameterGrid& grid);

}  // namespace isorim::geometry
