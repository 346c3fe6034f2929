#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/hull/offset_table.h"

/// Libraries of hulls: HDF5 files with one group a hull.
namespace isorim::io {

/// What a list of hulls tells.
struct HullEntry {
  std::string name;
  std::string title;
  std::string source;
  double length = 0.0;
  double beam = 0.0;
  double draught = 0.0;
  int stations = 0;
  int waterlines = 0;
};

/// In alphabetical order. Throws InputError if the file cannot be read or is no library.
std::vector<HullEntry> list_hulls(const std::filesystem::path& library);

/// The table as it was stored, bit for bit. Throws InputError as list_hulls() does, and if there is none of the name
/// (with the nearest one).
geometry::OffsetTable read_hull(const std::filesystem::path& library, const std::string& name);

/// Stores a table under a name of letters, digits, "_", "-" and "."; a new file if there is none. What was there under
/// the name is replaced if `replaces`, else refused. The file appears whole or stays as it was.
enum class ExistingHull { refuse, replace };
void store_hull(const std::filesystem::path& library, const std::string& name, const geometry::OffsetTable& table,
                ExistingHull existing);

/// Throws InputError as read_hull() does.
void remove_hull(const std::filesystem::path& library, const std::string& name);

}  // namespace isorim::io
