#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/hull/offset_table.h"

namespace isorim::io {

/// Reads a table of offsets in CSV (the format is in README.md beside this file), dimensional or not: the result is in
/// the units of the file's length, beam and draught.
///
/// Throws InputError "name:line: column: ..." for what is no number where one is expected, unknown keys and columns,
/// missing ones, lines of another number of cells, stations or waterlines that do not rise or fall, and whatever
/// geometry::check() finds wrong.
geometry::OffsetTable parse_offsets(std::string_view text, const std::string& name);

/// Throws InputError if the file cannot be read, or as parse_offsets().
geometry::OffsetTable read_offsets(const std::filesystem::path& path);

/// The table as such a file, in lengths, which reads back to the same bits.
std::string offsets_text(const geometry::OffsetTable& table);

}  // namespace isorim::io
