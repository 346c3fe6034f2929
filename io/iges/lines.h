#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/iges/file.h"
#include "io/iges/free_format.h"

/// From the bytes of a file to its sections.
namespace isorim::io::iges {

struct DirectoryLine {
  /// Columns 1 to 72.
  std::array<char, 72> columns;
  /// As written in columns 74 to 80; 0 if there is none.
  int sequence = 0;
  /// Counted from 1 in the file.
  int file_line = 0;
};

struct Sections {
  std::vector<std::string> start;
  /// Columns 1 to 72 of all G lines.
  std::string global;
  std::vector<DirectoryLine> directory;
  ParameterText parameters;
  /// Columns 1 to 72 of the T line.
  std::optional<std::string> terminate;
  int start_lines = 0;
  int global_lines = 0;
};

/// Cuts the file into lines (LF, CR LF, CR, or 80 columns without ends of lines), and these into columns. Tabs, UTF-8
/// characters and lines that have lost blanks are put right where the result is unambiguous. Throws InputError, without
/// the file's name, if the file is not IGES in fixed form, or a line belongs to no section.
Sections split_sections(std::string_view bytes, Warnings& warnings);

}  // namespace isorim::io::iges
