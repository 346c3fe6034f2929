#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/drawing/drawing.h"

/// Drawings as DXF files.
namespace isorim::io::drawing {

struct DxfOptions {
  /// The file's lengths in mm over those of the drawing: 50 for a drawing at 1:50 that shall have its true size.
  double scale = 1.0;
};

/// The drawing as a text DXF file of version AC1015 (AutoCAD 2000), in mm, the same text on every machine. Curves of
/// degree 2 to 10 are SPLINE entities with their own knots, control points and weights, all digits given; curves of
/// degree 1 are polylines (LWPOLYLINE); higher degrees are met by cubic splines within 0.0005 mm. Circles are CIRCLE,
/// texts TEXT with their alignment, fills solid HATCH entities with polygons within 0.01 mm. Layers have their names,
/// line types and the nearest of AutoCAD's 255 colours and of its line widths. Throws InputError if the scale is not
/// positive.
std::string to_dxf(const Drawing& drawing, const DxfOptions& options = {});

/// Writes to_dxf() atomically; errors as write_file().
void write_dxf(const std::filesystem::path& path, const Drawing& drawing, const DxfOptions& options = {});

/// The number in AutoCAD's table of 255 colours that is nearest; black is 7, which is white on a dark screen.
int colour_index(const Colour& colour);

}  // namespace isorim::io::drawing
