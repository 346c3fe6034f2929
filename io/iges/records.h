#pragma once

#include <vector>

#include "io/iges/file.h"
#include "io/iges/lines.h"

namespace isorim::io::iges {

/// Throws InputError if the delimiters are impossible or a record delimiter is missing.
GlobalSection read_global_section(const std::string& text, Warnings& warnings);

/// Where an entity says that its parameters are.
struct RecordPlace {
  /// Sequence number of the first line, and number of lines.
  int first_line = 0;
  int line_count = 0;
};

struct Directory {
  /// By rising D number.
  std::vector<Entity> entities;
  /// One for each entity.
  std::vector<RecordPlace> places;
};

/// Throws InputError if an entry has no type or no second line, or if two have the same number.
Directory read_directory(const std::vector<DirectoryLine>& lines, Warnings& warnings);

/// Cuts the parameter records into tokens and gives each entity its own. Every line is cut at most once: the lines
/// whose back pointers name an entity are its own; where none do, those that the directory entry names.
void assign_parameters(Directory& directory, ParameterText& parameters, const Delimiters& delimiters,
                       Warnings& warnings);

}  // namespace isorim::io::iges
