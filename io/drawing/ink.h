#pragma once

#include <vector>

#include "io/drawing/drawing.h"

namespace isorim::io::drawing {

/// Where something is drawn: boxes round short pieces of all lines, and round texts and fills, as wide as the lines
/// are.
class Ink {
 public:
  explicit Ink(const Drawing& drawing);

  /// False only where nothing is drawn; true also up to 2 mm beside lines.
  bool meets(const Rectangle& rectangle) const;

 private:
  std::vector<Rectangle> boxes_;
};

}  // namespace isorim::io::drawing
