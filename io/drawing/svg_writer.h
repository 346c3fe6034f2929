#pragma once

#include <filesystem>
#include <string>

#include "io/drawing/drawing.h"

/// Sheets as SVG files in true size.
namespace isorim::io::drawing {

/// The sheet as an SVG document whose user unit is 1 mm, its width and height those of the page. The layers that are
/// not empty are groups with their names (Inkscape shows them as layers). Polynomial Bézier segments of degree 3 at
/// most are drawn exactly, others by cubics within 0.0005 mm; coordinates are rounded to 0.0001 mm. The same text for
/// the same sheet on every machine. Throws InputError as require_page().
std::string to_svg(const Sheet& sheet);

/// Writes to_svg() atomically; errors as write_file().
void write_svg(const std::filesystem::path& path, const Sheet& sheet);

}  // namespace isorim::io::drawing
