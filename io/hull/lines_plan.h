#pragma once

#include <filesystem>

#include "geometry/hull/hull_lines.h"
#include "io/case/lines_plan_keys.h"
#include "io/drawing/drawing.h"
#include "io/hull/hull_facts.h"

namespace isorim::io {

/// The lines that the keys ask for, defaults filled in from the table. Throws GeometryError as geometry::hull_lines().
geometry::HullLines plan_lines(const HullFacts& hull, const LinesPlanKeys& keys);

/// The lines plan in its three views: the sheer plan (x to the right, z) with the buttocks, beside it the body plan
/// with the stations (those of the fore body to the right, of the after body to the left, amidships on both sides) and
/// the traces of the diagonals, below it the half-breadth plan with the waterlines above the centre line and the
/// diagonals below it. Grid lines are labelled by stations, heights and half-breadths. Lengths are taken as metres, for
/// the scale: the largest of 1, 2, 5 times a power of ten and 1:2.5, 1:25, .. whose sheet is not wider than
/// `keys.width`.
drawing::Sheet lines_plan(const HullFacts& hull, const geometry::HullLines& lines, const LinesPlanKeys& keys);

/// Writes lines_plan.svg, .pdf, .dxf and lines.csv (points of all lines, closer than 1e-4 of the length to the curves).
void write_lines_plan(const std::filesystem::path& folder, const HullFacts& hull, const LinesPlanKeys& keys);

}  // namespace isorim::io
