#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/case/value.h"
#include "io/sweep/sweep_keys.h"

/// From a sweep file to its cases, before any of them is run.
namespace isorim::io {

/// A parameter or a derived value.
struct SweepColumn {
  std::string name;
  /// What it sets in the case; empty if nothing.
  std::string key;
  bool is_derived = false;
  KeyPlace where;
};

/// One value a column.
struct SweepCase {
  std::vector<Value> values;
};

struct SweepPlan {
  std::filesystem::path path;
  SweepKeys keys;
  std::filesystem::path base_path;
  Value base;
  std::vector<SweepColumn> columns;
  std::vector<SweepCase> cases;
  /// What defines the cases: the sweep file without what may change between runs (title, output, plots, run), and the
  /// other files that it names with their contents.
  std::string definition;
  std::vector<std::pair<std::string, std::string>> files;

  /// The file's name without its extension.
  std::string name() const { return path.stem().string(); }
  std::string title() const { return keys.title.empty() ? name() : keys.title; }
  /// The number of a case, from 0, as messages and folders call it: from 1, with leading zeros, all equally long.
  std::string case_name(std::size_t index) const;
  /// "radius = 1, degree = 3".
  std::string describe(std::size_t index) const;
};

/// More cases than this are refused.
inline constexpr std::size_t most_sweep_cases = 1000000;

/// Reads a sweep file and its base case, and lays out the cases. Throws InputError with every complaint, one a line,
/// for whatever is wrong in the sweep file, its CSV files and its expressions, for cases that are there twice, and for
/// values that the declarations of case files do not admit: unknown keys, wrong types, numbers out of their range.
/// (What is wrong with single shapes shows when they are run.)
SweepPlan read_sweep(const std::filesystem::path& path);

/// The columns that the tables of every sweep have; parameters bear other names.
const std::vector<std::string>& sweep_table_columns();

/// The case as a tree: the base with the values of its parameters. Relative paths in it begin at the base's folder.
Value case_tree(const SweepPlan& plan, std::size_t index);

/// A value as tables show it: a text without quotes, anything else as TOML.
std::string plain_text(const Value& value);

/// The number that a value is; nothing if it is none. Booleans are 0 and 1.
std::optional<double> as_number(const Value& value);

/// A part of the cases: those with index % count == part - 1.
struct Shard {
  int part = 1;
  int count = 1;

  bool owns(std::size_t index) const { return index % static_cast<std::size_t>(count) + 1 == std::size_t(part); }
  bool is_everything() const { return count == 1; }
  std::string text() const { return std::to_string(part) + "/" + std::to_string(count); }
};

/// "K/N" with 1 <= K <= N. Throws InputError for anything else.
Shard parse_shard(const std::string& text);

}  // namespace isorim::io
