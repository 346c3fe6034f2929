#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/case/schema.h"
#include "io/svg/axis.h"

/// What a sweep file says; the declarations are in sweep_declarations.cpp.
namespace isorim::io {

/// How the axes of a sweep make its cases: every combination; the first entries of all, the second ones, ...; or a
/// Latin hypercube sample of their combinations.
enum class Combination { grid, zip, latin_hypercube };

enum class Spacing { linear, logarithmic };

/// A list of anything that a key may take.
struct ValueList {
  std::vector<Value> items;
  KeyPlace where;
};

/// A real, which the file may write as an integer.
struct RangeNumber {
  double value = 0.0;
  bool is_integer = false;
};

/// One axis of a sweep: a key of the case, and a list or a range of values for it.
struct ParameterKeys {
  std::string key;
  std::string name;
  std::optional<ValueList> values;
  std::optional<RangeNumber> from;
  std::optional<RangeNumber> to;
  std::optional<int> count;
  std::optional<RangeNumber> step;
  Spacing spacing = Spacing::linear;
  KeyPlace where;
};

/// heading = "key of the case".
struct ColumnKeys {
  std::vector<std::pair<std::string, std::string>> entries;
  KeyPlace where;
};

/// One axis of a sweep: the rows of a file, whose columns vary together.
struct RowsKeys {
  std::string csv;
  ColumnKeys columns;
  KeyPlace where;
};

/// A value computed from the parameters.
struct DerivedKeys {
  std::string name;
  std::string key;
  std::string expression;
  KeyPlace where;
};

struct SweepOutputKeys {
  std::vector<std::string> results;
  bool case_files = true;
  KeyPlace where;
};

struct SweepPlotKeys {
  std::string file;
  std::string title;
  std::string x;
  OneOrMany<std::string> y;
  std::string series;
  svg::Scale x_scale = svg::Scale::linear;
  svg::Scale y_scale = svg::Scale::linear;
  KeyPlace where;
};

struct SweepRunKeys {
  bool stop_on_failure = false;
  /// Seconds.
  std::optional<double> timeout;
  /// Megabytes (10^6 bytes).
  std::optional<double> memory;
  KeyPlace where;
};

struct SweepKeys {
  std::string title;
  std::string base;
  Combination combine = Combination::grid;
  std::optional<int> samples;
  int seed = 1;
  std::vector<ParameterKeys> parameter;
  std::vector<RowsKeys> rows;
  std::vector<DerivedKeys> derived;
  SweepOutputKeys output;
  std::vector<SweepPlotKeys> plot;
  SweepRunKeys run;
  KeyPlace where;
};

template <>
struct KeyType<ValueList> : PlainKey {
  static std::string type() { return "list of values"; }
  static bool read(const Value& v, ValueList& t, const Range& r, const KeyPlace& w, Complaints& c);
  static std::string print(const ValueList&) { return ""; }
};

template <>
struct KeyType<RangeNumber> : PlainKey {
  static std::string type() { return "real"; }
  static bool read(const Value& v, RangeNumber& t, const Range& r, const KeyPlace& w, Complaints& c);
  static std::string print(const RangeNumber&) { return ""; }
};

template <>
struct KeyType<ColumnKeys> : PlainKey {
  static std::string type() { return "table of texts"; }
  static bool read(const Value& v, ColumnKeys& t, const Range& r, const KeyPlace& w, Complaints& c);
  static std::string print(const ColumnKeys&) { return ""; }
};

template <>
const Schema<SweepKeys>& schema<SweepKeys>();

/// The declarations of all tables that a sweep file may hold.
std::vector<const Description*> sweep_tables();

/// All keys of a sweep file, as text for the terminal and as Markdown.
std::string sweep_reference();
std::string sweep_reference_markdown();

}  // namespace isorim::io
