#include "io/propeller/blade_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/excerpt.h"

namespace isorim::io {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\"";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

const BladeColumn* column_named(std::string_view name) {
  const auto found = std::ranges::find_if(blade_columns, [&](const BladeColumn& c) { return same_name(c.name, name); });
  return found == blade_columns.end() ? nullptr : &*found;
}

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  BladeTableKeys read() {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      const std::string_view line = trimmed(text_.substr(0, end));
      ++line_;
      text_.remove_prefix(std::min(end + 1, text_.size()));
      if (line.empty() || line.starts_with('#')) continue;
      if (columns_.empty())
        read_names(line);
      else
        read_row(line);
    }
    if (columns_.empty()) throw InputError(fmt::format("{}: the file is empty; expected a table of a blade", name_));
    return std::move(keys_);
  }

 private:
  [[noreturn]] void refuse(std::string_view message) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, message));
  }

  void read_names(std::string_view line) {
    separator_ = line.find(';') != std::string_view::npos    ? ';'
                 : line.find('\t') != std::string_view::npos ? '\t'
                                                             : ',';
    for (const std::string_view name : cells_of(line, separator_)) {
      const BladeColumn* column = column_named(name);
      if (column && std::ranges::find(columns_, column) != columns_.end())
        refuse(fmt::format("found the column \"{}\" twice", name));
      columns_.push_back(column);
    }
    if (std::ranges::find(columns_, &blade_columns.front()) != columns_.end()) return;
    std::vector<std::string_view> names;
    for (const BladeColumn& column : blade_columns) names.push_back(column.name);
    refuse(fmt::format("found \"{}\"; expected a line of names with \"r/R\" among them; known are {}", excerpt(line),
                       fmt::join(names, ", ")));
  }

  void read_row(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line, separator_);
    if (cells.size() != columns_.size())
      refuse(fmt::format("found {} columns; expected {}, as in the line of names", cells.size(), columns_.size()));
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (columns_[i]) (keys_.*columns_[i]->values).push_back(number(cells[i], columns_[i]->name));
  }

  double number(std::string_view cell, std::string_view column) const {
    double value = 0.0;
    const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc() && end == digits.data() + digits.size() && std::isfinite(value)) return value;
    const bool has_comma = cell.find(',') != std::string_view::npos;
    refuse(fmt::format("found \"{}\" as {}; expected a number{}", excerpt(cell), column,
                       has_comma ? " with a decimal point" : ""));
  }

  std::string_view text_;
  const std::string& name_;
  int line_ = 0;
  char separator_ = ',';
  /// Null for those that are not read.
  std::vector<const BladeColumn*> columns_;
  BladeTableKeys keys_;
};

}  // namespace

BladeTableKeys parse_blade_table(std::string_view text, const std::string& name) {
  return TableReader(text, name).read();
}

}  // namespace isorim::io
