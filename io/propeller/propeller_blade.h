#pragma once

#include <string>
#include <vector>

#include "geometry/propeller/blade_edit.h"
#include "geometry/propeller/blade_section.h"
#include "io/case/shape_keys.h"

/// From the keys of a propeller to the sections of its blades.
namespace isorim::io {

/// The sections from the root to the tip, and what the user should know of them.
struct PropellerBlade {
  std::vector<geometry::BladeSection> sections;
  std::vector<std::string> warnings;
};

/// Throws InputError that begins with file, line and key, or with file and line of a table: columns that are missing,
/// given twice or of different lengths, and what series_sections(), table_sections() and point_section() refuse.
PropellerBlade propeller_blade(const PropellerKeys& keys);

/// The edits of the keys; their sections are looked up by radius. Throws InputError as above.
std::vector<geometry::BladeEdit> blade_edits(const PropellerKeys& keys,
                                             const std::vector<geometry::BladeSection>& sections);

}  // namespace isorim::io
