#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// The tree of values that a case file holds, each with the place where it was written. It keeps TOML's library out
/// of every other file, and an override from the command line becomes part of it as if it stood in the file.
namespace isorim::io {

/// Where something was written: "case.toml:12", or the command-line option that gave it.
struct Place {
  std::shared_ptr<const std::string> source;
  /// From 1; 0 when the source has no lines.
  int line = 0;
  int column = 0;

  std::string describe() const;
};

struct TableEntry;

/// A date or a time, which no key of ours takes: kept only so that messages can show it.
struct DateOrTime {
  std::string text;
};

struct Value {
  using Array = std::vector<Value>;
  /// In the order of the file.
  using Table = std::vector<TableEntry>;

  /// A new value is false. An initialiser that says so would make clang ask for TableEntry's size here.
  std::variant<bool, std::int64_t, double, std::string, DateOrTime, Array, Table> data;
  Place place;

  template <class T>
  const T* as() const {
    return std::get_if<T>(&data);
  }
  /// The entry of a table; null if this is no table or has no such key.
  const Value* find(std::string_view key) const;
};

struct TableEntry {
  std::string key;
  Value value;
};

/// What was found, for messages: `the integer 3`, `the text "abc"`, `a list of 4`, `a table`.
std::string describe(const Value& value);

/// Parses TOML text; `name` is what messages call the file. Throws InputError "name:line:column: ..." for text that
/// is not TOML.
Value parse_toml(std::string_view text, const std::string& name);

/// Throws InputError if the file cannot be read, or as parse_toml.
Value read_toml(const std::filesystem::path& path);

/// Puts `assignment`, "dotted.path=value", into the tree. The value is TOML (3.5, true, [1, 2], "text", { a = 1 });
/// what is not becomes text, so `title=Ball` works unquoted. A part of the path that is a number (from 0) picks from
/// a list: `integral.0.over=boundary`. Tables that are missing on the way are made. Throws InputError if there is no
/// '=', a part is empty, or the path runs through something that is no table or list or past a list's end.
void apply_override(Value& root, const std::string& assignment);

/// The tree as TOML text that parses back to the same values; reals with 17 significant digits.
std::string to_toml(const Value& root);

}  // namespace isorim::io
