#pragma once

#include <array>
#include <cstdint>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include "io/picture/picture.h"

namespace isorim::io::picture {

/// 256 colours over a range; grey for NaN.
vtkSmartPointer<vtkLookupTable> lookup_table(ColourMap map, const std::array<double, 2>& range);

/// Colours of one lightness for any number of patches, neighbours in the list far apart.
Colour patch_colour(int patch);

/// Of the bare shape.
inline constexpr Colour plain_colour{0.62, 0.71, 0.80};

}  // namespace isorim::io::picture
