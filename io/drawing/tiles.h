#pragma once

#include <vector>

#include "io/drawing/drawing.h"

/// Sheets cut into pages that a small printer can print, to be glued together.
namespace isorim::io::drawing {

/// All in mm.
struct Tiling {
  /// The paper upright: A4. It is turned where that needs fewer pages.
  double paper_width = 210.0;
  double paper_height = 297.0;
  /// What printers leave blank on the left, right and top: lasers 4.2, many inkjets more.
  double margin = 10.0;
  /// At the bottom, with the label and the scale bar.
  double foot = 20.0;
  /// By which neighbours lie over each other.
  double overlap = 10.0;
};

/// One page of a sheet.
struct Tile {
  /// From 1, among those that there are.
  int number = 1;
  /// From 0; row 0 is at the top, column 0 on the left.
  int row = 0;
  int column = 0;
  /// The page of this tile, in the coordinates of the paper (origin at its lower left corner).
  double paper_width = 0.0;
  double paper_height = 0.0;
  /// The part of the sheet that it shows, in the drawing's coordinates: inside the sheet's page.
  Rectangle part;
  /// Where part.lower lies on the paper.
  geometry::Point2 place = geometry::Point2::Zero();
  /// In the coordinates of the paper: the label "row B, column 2, sheet 5 of 12", a scale bar of 50 mm, a map of the
  /// pages that there are, and where there are neighbours the lines along which to cut, each with two registration
  /// crosses that lie on both pages, and the neighbour's name.
  Drawing marks;
};

/// The tiles, row by row from the top. Neighbours share a strip as wide as the overlap, in the middle of which the
/// line to cut lies; a sheet that fits on one page is put in its middle. Pages on which, up to the lines to cut,
/// nothing is drawn are left out. Throws InputError as require_page(), or if a length of the tiling is not finite or
/// negative, or the paper is too small for margins and overlap, or if there were more than 10000 pages.
std::vector<Tile> tiles_of(const Sheet& sheet, const Tiling& tiling = {});

/// How the pages go together: the whole sheet, small, on a page of its own, with the lines to cut and the names of the
/// pages.
struct AssemblyMap {
  double paper_width = 0.0;
  double paper_height = 0.0;
  /// The sheet's page, its lower left corner at `place`, by this factor.
  double factor = 1.0;
  geometry::Point2 place = geometry::Point2::Zero();
  /// In the coordinates of the paper.
  Drawing marks;
};

/// Of the tiles of a sheet, more than one.
AssemblyMap assembly_map(const Sheet& sheet, const std::vector<Tile>& tiles, const Tiling& tiling = {});

/// "A", ..., "Z", "AA", ...: the name of row 0, ...
std::string row_name(int row);

}  // namespace isorim::io::drawing
