#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The text of IGES files in fixed form.
namespace isorim::io::iges {

/// A real constant in the fewest digits that name this double and no other, with a point. The value must be finite.
std::string real_text(double value);

/// The values of a record, cut into lines of a given number of columns: numbers stay in one piece, strings may cross
/// lines.
class Record {
 public:
  explicit Record(std::size_t columns) : columns_(columns) {}

  Record& integer(long value);
  Record& real(double value);
  /// As Hollerith string; control characters become blanks.
  Record& text(std::string_view value);
  Record& omitted();

  /// The lines, the last one closed by the record delimiter.
  std::vector<std::string> lines() const;

 private:
  void append_whole(std::string_view token);

  std::size_t columns_;
  std::vector<std::string> lines_{std::string()};
};

/// What the directory says of an entity besides its type.
struct DirectoryFields {
  int form = 0;
  int transformation = 0;
  /// 1: the entity that holds this one places it.
  int subordinate = 0;
  /// 5: in the parameter space of a surface; 2: definition.
  int use = 0;
  int level = 0;
  /// Number of a colour, or the negative pointer to a 314.
  int colour = 0;
};

/// Entities in the order in which they are added; they point to those before them.
class EntityList {
 public:
  /// Begins the parameters of an entity: they start with its type.
  static Record parameters(int type);

  /// Returns the D number.
  int add(int type, const Record& parameters, const DirectoryFields& fields = {});
  bool empty() const { return directory_.empty(); }

  /// The whole file. `global` are the values of the global section, delimiters included. Throws InputError if a
  /// section has more lines than seven digits can number.
  std::string file_text(std::string_view start, const Record& global) const;

 private:
  std::vector<std::string> directory_;
  /// Columns 1 to 72, back pointer included.
  std::vector<std::string> parameters_;
};

/// The global section's record begins with the delimiters.
Record global_record();

}  // namespace isorim::io::iges
