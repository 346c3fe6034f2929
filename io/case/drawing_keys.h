#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/case/schema.h"

/// [drawings] and [moulds]: workshop drawings.
namespace isorim::io {

enum class SheetCut {
  /// A page as large as the drawing.
  whole,
  /// Pages of A4 to be glued together.
  a4,
};

enum class DrawingFormat { pdf, svg, dxf };

/// How drawings are made, whatever they show.
struct DrawingKeys {
  /// Of the case's lengths.
  double millimetres = 1.0;
  /// Empty: all.
  std::vector<std::string> formats;
  SheetCut sheets = SheetCut::whole;
  /// An overview of what the case describes, if there is one of its kind.
  bool overview = true;
  /// Of the overview: 1 to this. 0: as many as it needs to fit on a sheet of A3.
  double scale = 0.0;
  KeyPlace where;

  bool has(DrawingFormat format) const;
};

/// "pdf", ...
const char* name_of(DrawingFormat format);

/// Sections at heights above z = 0, and boards between them.
struct MouldKeys {
  std::optional<double> board_thickness;
  std::vector<double> heights;
  std::optional<double> from;
  std::optional<double> to;
  std::optional<double> step;
  KeyPlace where;
};

}  // namespace isorim::io
