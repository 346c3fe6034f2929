#include "io/fit/point_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/excerpt.h"
#include "io/file_bytes.h"

namespace isorim::io {
namespace {

struct Line {
  int number = 0;
  std::string_view text;
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The lines that say something.
std::vector<Line> content_lines(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<Line> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    const bool is_comment = line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
    if (!line.empty() && !is_comment) lines.push_back({number, line});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

[[noreturn]] void refuse_line(const std::string& name, const Line& line, std::string_view message) {
  throw InputError(fmt::format("{}:{}: {}", name, line.number, message));
}

[[noreturn]] void refuse_decimal_comma(const std::string& name, const Line& line) {
  refuse_line(name, line,
              fmt::format("found \"{}\", which looks like numbers with decimal commas; expected decimal points",
                          excerpt(line.text)));
}

enum class Separator { comma, semicolon, tab, blank };

Separator separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return Separator::semicolon;
  if (line.find('\t') != std::string_view::npos) return Separator::tab;
  if (line.find(',') != std::string_view::npos) return Separator::comma;
  return Separator::blank;
}

std::vector<std::string_view> fields_of(std::string_view line, Separator separator) {
  std::vector<std::string_view> fields;
  if (separator == Separator::blank) {
    while (!line.empty()) {
      const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
      fields.push_back(line.substr(0, end));
      line = trimmed(line.substr(end));
    }
    return fields;
  }
  const char mark = separator == Separator::comma ? ',' : separator == Separator::semicolon ? ';' : '\t';
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(mark, begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  // "1;2;" is what some programs write.
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return fields;
}

std::optional<double> number_of(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

bool is_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "1,5": digits on both sides of the only comma.
bool has_decimal_comma(std::string_view field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string_view::npos || comma == 0) return false;
  return std::isdigit(static_cast<unsigned char>(field[comma - 1])) != 0 && is_digits(field.substr(comma + 1));
}

/// A name without quotes, units in brackets and capitals.
std::string plain_name(std::string_view field) {
  field = field.substr(0, field.find_first_of("[("));
  std::string name;
  for (const char c : field) {
    if (c != '"' && c != '\'' && c != ' ') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

/// Which columns hold what; -1: none does.
struct Columns {
  int x = -1;
  int y = -1;
  int z = -1;
  int weight = -1;
  std::size_t count = 0;
};

Columns named_columns(const std::vector<std::string_view>& fields, const std::string& name, const Line& line) {
  Columns columns;
  columns.count = fields.size();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string field = plain_name(fields[i]);
    const auto take = [&](int& column) {
      if (column >= 0) refuse_line(name, line, fmt::format("found two columns \"{}\"", field));
      column = static_cast<int>(i);
    };
    if (field == "x") take(columns.x);
    if (field == "y") take(columns.y);
    if (field == "z") take(columns.z);
    if (field == "w" || field == "weight" || field == "weights") take(columns.weight);
  }
  if (columns.x < 0 || columns.y < 0) {
    refuse_line(name, line,
                fmt::format("found the columns \"{}\"; expected x and y among them, as in \"x, y, weight\"",
                            excerpt(line.text)));
  }
  return columns;
}

Columns counted_columns(std::size_t count, const std::string& name, const Line& line) {
  if (count < 2 || count > 4) {
    refuse_line(name, line,
                fmt::format("found {} number(s) in a line; expected x, y or x, y, z or x, y, z, weight (a first line "
                            "of names tells other columns)",
                            count));
  }
  return {0, 1, count > 2 ? 2 : -1, count > 3 ? 3 : -1, count};
}

bool is_header(const std::vector<std::string_view>& fields) {
  return std::ranges::none_of(fields, [](std::string_view field) { return number_of(field).has_value(); }) &&
         std::ranges::none_of(fields, has_decimal_comma);
}

/// The numbers of a line.
std::vector<double> numbers_of(const std::vector<std::string_view>& fields, const std::string& name, const Line& line) {
  std::vector<double> numbers;
  for (const std::string_view field : fields) {
    if (has_decimal_comma(field)) refuse_decimal_comma(name, line);
    const std::optional<double> value = number_of(field);
    if (!value || !std::isfinite(*value)) {
      // Blanks between numbers whose commas are no separators: "1,5 2,5".
      if (field.find_first_of(" \t") != std::string_view::npos) refuse_decimal_comma(name, line);
      refuse_line(name, line, fmt::format("found \"{}\"; expected a number", excerpt(field)));
    }
    numbers.push_back(*value);
  }
  return numbers;
}

/// Twice as many columns as expected, none of which has a decimal point: "1,5,2,5".
bool are_halves(const std::vector<std::string_view>& fields) {
  if (fields.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    std::string_view field = fields[i];
    if (i % 2 == 0 && (field.starts_with('-') || field.starts_with('+'))) field.remove_prefix(1);
    if (!is_digits(field)) return false;
  }
  return true;
}

/// x, y, z, weight in whole numbers throughout, without a line of names, can only be told from decimal commas by a
/// point somewhere.
void check_for_halves(const std::vector<Line>& lines, std::size_t first, const std::string& name) {
  for (std::size_t i = first; i < lines.size(); ++i) {
    if (!are_halves(fields_of(lines[i].text, Separator::comma))) return;
  }
  if (first < lines.size()) refuse_decimal_comma(name, lines[first]);
}

/// The lines of numbers, and the line of names if there is one.
struct Table {
  std::vector<Line> lines;
  std::vector<std::vector<std::string_view>> fields;
  std::optional<Line> header_line;
  std::vector<std::string_view> header;
};

Table split_lines(std::string_view text, const std::string& name) {
  std::vector<Line> lines = content_lines(text);
  Table table;
  if (lines.empty()) throw InputError(fmt::format("{}: found no points", name));
  const Separator separator = separator_of(lines.back().text);
  std::vector<std::string_view> first = fields_of(lines.front().text, separator_of(lines.front().text));
  if (is_header(first)) {
    table.header = std::move(first);
    table.header_line = lines.front();
    lines.erase(lines.begin());
    if (lines.empty()) throw InputError(fmt::format("{}: found no points", name));
  }
  const std::size_t columns = fields_of(lines.front().text, separator).size();
  const bool doubled = table.header_line ? columns == 2 * table.header.size() : columns > 3;
  if (separator == Separator::comma && doubled) check_for_halves(lines, 0, name);
  for (const Line& line : lines) table.fields.push_back(fields_of(line.text, separator));
  table.lines = std::move(lines);
  return table;
}

void check_count(std::size_t found, std::size_t expected, const std::string& name, const Line& line) {
  if (found == expected) return;
  refuse_line(name, line, fmt::format("found {} column(s); expected {} as in the lines before", found, expected));
}

void check_weight(double weight, const std::string& name, const Line& line) {
  if (weight > 0.0) return;
  refuse_line(name, line, fmt::format("found the weight {}; expected a positive one", weight));
}

}  // namespace

PointTable parse_points(std::string_view text, const std::string& name) {
  const Table table = split_lines(text, name);
  Columns columns;
  if (table.header_line) columns = named_columns(table.header, name, *table.header_line);
  PointTable result;
  result.name = name;
  result.points.setZero(3, static_cast<Eigen::Index>(table.lines.size()));
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    const Line& line = table.lines[i];
    std::vector<std::string_view> fields = table.fields[i];
    if (i == 0 && !table.header_line) columns = counted_columns(fields.size(), name, line);
    // Lines whose numbers have decimal commas have too many columns as well: say the former.
    std::vector<double> numbers = table.header_line ? std::vector<double>() : numbers_of(fields, name, line);
    check_count(fields.size(), columns.count, name, line);
    const auto at = [&](int column) {
      if (!table.header_line) return numbers[static_cast<std::size_t>(column)];
      return numbers_of({fields[static_cast<std::size_t>(column)]}, name, line).front();
    };
    const auto k = static_cast<Eigen::Index>(i);
    result.points(0, k) = at(columns.x);
    result.points(1, k) = at(columns.y);
    if (columns.z >= 0) result.points(2, k) = at(columns.z);
    if (columns.weight >= 0) {
      result.weights.push_back(at(columns.weight));
      check_weight(result.weights.back(), name, line);
    }
    result.lines.push_back(line.number);
  }
  result.has_z = columns.z >= 0;
  return result;
}

PointTable read_points(const std::filesystem::path& path) {
  return parse_points(read_bytes(path), path.string());
}

std::vector<double> parse_weights(std::string_view text, const std::string& name) {
  const Table table = split_lines(text, name);
  std::vector<double> weights;
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    const Line& line = table.lines[i];
    const std::vector<double> numbers = numbers_of(table.fields[i], name, line);
    if (numbers.size() != 1) {
      if (separator_of(line.text) == Separator::comma && are_halves(table.fields[i])) refuse_decimal_comma(name, line);
      refuse_line(name, line, fmt::format("found {} numbers; expected one weight", numbers.size()));
    }
    check_weight(numbers.front(), name, line);
    weights.push_back(numbers.front());
  }
  return weights;
}

std::vector<double> read_weights(const std::filesystem::path& path) {
  return parse_weights(read_bytes(path), path.string());
}

}  // namespace isorim::io
