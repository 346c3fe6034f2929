#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "geometry/hull/hull_surface.h"
#include "io/case/shape_base_keys.h"

/// What a case file says of hulls. The declarations are in hull_declarations.cpp, the construction in io/hull/.
namespace isorim::io {

struct HullScaleKeys {
  std::optional<double> length;
  std::optional<double> beam;
  std::optional<double> draught;
  KeyPlace where;
};

struct HullShiftKeys {
  std::optional<double> prismatic;
  /// Per cent of the length, forward of amidships.
  std::optional<double> lcb;
  KeyPlace where;
};

struct HullKeys : SolidKeys {
  /// "wigley", a file of offsets, or the name of a hull in `library`.
  std::string offsets;
  /// A library file.
  std::string library;
  std::optional<HullScaleKeys> scale;
  /// By how much half-breadths may be moved to make the scaled table fair.
  std::optional<double> fair;
  std::optional<HullShiftKeys> shift;
  geometry::SectionParameters parameters = geometry::SectionParameters::automatic;
  /// Where relative paths begin, the folder of the case file; set by its reader.
  std::filesystem::path folder;
};

}  // namespace isorim::io
