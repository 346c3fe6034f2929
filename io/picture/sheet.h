#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/picture/drawable.h"
#include "io/picture/picture.h"

namespace isorim::io::picture {

/// What goes into a picture.
struct Sheet {
  std::vector<Drawable> drawables;
  /// Of the field, if one is shown.
  std::array<double, 2> range{};
};

/// The bytes of a PNG. Throws NumericalError if nothing can be drawn on this machine.
std::string draw_sheet(const Sheet& sheet, const PictureOptions& options);

}  // namespace isorim::io::picture
