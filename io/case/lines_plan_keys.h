#pragma once

#include <vector>

#include "io/case/schema.h"

/// [lines_plan]: which lines of a hull are drawn.
namespace isorim::io {

struct LinesPlanKeys {
  /// x, z and y of planes; empty: those of the table, and quarters of half the beam.
  std::vector<double> stations;
  std::vector<double> waterlines;
  std::vector<double> buttocks;
  /// Rows of the height at which a diagonal plane meets the centre plane and its angle in degrees below the horizontal.
  NumberArray diagonals;
  /// Of the paper, in mm.
  double width = 841.0;
  KeyPlace where;
};

}  // namespace isorim::io
