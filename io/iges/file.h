#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The lexical layer of IGES 5.3 (fixed form): lines, columns, directory entries and parameter records. What the
/// entities mean is left to the reader of the geometry; nothing here is rounded, scaled or repaired.
namespace isorim::io::iges {

/// What separates two parameters and what ends a record; the global section may redefine both.
struct Delimiters {
  char parameter = ',';
  char record = ';';
};

/// The 26 values of the global section, with the standard's defaults for those that are left out. Texts are UTF-8.
struct GlobalSection {
  Delimiters delimiters;
  std::string product;
  /// As its author called it.
  std::string file_name;
  std::string native_system;
  std::string preprocessor_version;
  int integer_bits = 32;
  int single_exponent = 38;
  int single_digits = 6;
  int double_exponent = 308;
  int double_digits = 15;
  std::string receiving_product;
  /// Model space over real world: the part's true coordinates are those of the file divided by it. Positive.
  double scale = 1.0;
  /// 1 to 11 as written; 1 (inch) if left out.
  int unit_flag = 1;
  std::string unit_name;
  int line_weights = 1;
  double largest_line_width = 0.0;
  std::string date;
  /// The distance below which the author takes coordinates as equal; often too small or too large. 0 if absent.
  double resolution = 0.0;
  /// 0 if absent.
  double largest_coordinate = 0.0;
  std::string author;
  std::string organisation;
  /// 11 is IGES 5.3.
  int version_flag = 3;
  int drafting_standard = 0;
  std::string model_date;
  std::string application_protocol;

  /// The unit of all lengths: "mm", "in", ..., from the flag, or from the name where the flag is 3; a name that is not
  /// known as it is written, "?" if there is none.
  std::string unit = "in";
  /// Length of that unit in millimetres; 0 if it is not known.
  double unit_in_millimetres = 25.4;
};

/// A directory entry and the parameters that belong to it. Pointers are D numbers.
struct Entity {
  /// The odd number of its first line, by which others point at it.
  int sequence = 0;
  int type = 0;
  int form = 0;
  /// 0 or, for types that a definition in the file explains, the negative pointer to it.
  int structure = 0;
  /// Pattern number, or the negative pointer to a definition.
  int line_font = 0;
  /// Level (layer), or the negative pointer to a list of levels (406 form 1).
  int level = 0;
  int view = 0;
  /// Pointer to a 124, or 0.
  int transformation = 0;
  int label_display = 0;
  /// 0 visible, 1 blanked.
  int blank = 0;
  /// 0 independent, 1 physically dependent, 2 logically dependent, 3 both.
  int subordinate = 0;
  /// 0 geometry, 1 annotation, 2 definition, 3 other, 4 logical, 5 in parameter space, 6 construction.
  int use = 0;
  /// 0 passes its attributes on, 1 does not, 2 says so in a property.
  int hierarchy = 0;
  int line_weight = 0;
  /// 0 none, 1 to 8, or the negative pointer to a 314.
  int colour = 0;
  /// Without blanks around it, UTF-8.
  std::string label;
  int subscript = 0;
  /// The parameters as written, blanks trimmed, without the type number that stands first. Valid as long as a copy of
  /// the file lives.
  std::span<const std::string_view> tokens;
  /// The sequence number of its first line in the P section; 0 if it has none.
  int first_line = 0;
  /// Why its parameters or directory fields cannot be trusted; empty if they can. `Parameters` refuses such entities.
  std::string complaint;
};

/// "144 at D35".
std::string entity_text(const Entity& entity);

/// The text that the entities' tokens are views of.
struct ParameterText {
  /// Columns 1 to 64 of every P line, each padded with blanks.
  std::string text;
  std::vector<std::string_view> tokens;
  struct Line {
    std::size_t offset = 0;
    int back_pointer = 0;
    int sequence = 0;
  };
  std::vector<Line> lines;
};

struct File {
  /// What messages call it.
  std::string name;
  /// The start section: prose, one string a line, UTF-8.
  std::vector<std::string> start;
  GlobalSection global;
  /// By rising D number.
  std::vector<Entity> entities;
  /// What is not as the standard says but has one meaning only: one sentence a kind, with its number and first place.
  std::vector<std::string> warnings;
  std::shared_ptr<const ParameterText> parameters;

  /// The entity with that D number; nullptr if there is none.
  const Entity* find(int sequence) const;
};

/// Reads a file. Takes memory of a small multiple of its size and time proportional to it.
///
/// Throws InputError, with the file's name and the line, if it cannot be opened; if it is not IGES (saying what it
/// seems to be), or IGES in the binary or compressed form; if a line belongs to no section, the delimiters are
/// impossible, a directory entry has no type or half of it is missing, or two entries share one number. Flaws of one
/// entity are told in Entity::complaint, harmless ones in File::warnings.
File read_file(const std::filesystem::path& path);

/// The same for the bytes of a file; `name` is for messages.
File parse(std::string_view bytes, std::string name);

}  // namespace isorim::io::iges
