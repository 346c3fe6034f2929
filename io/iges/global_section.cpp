#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/iges/records.h"
#include "io/iges/units.h"

namespace isorim::io::iges {
namespace {

constexpr const char* section = "global section";

bool may_delimit(char c) {
  constexpr std::string_view forbidden = "0123456789+-.DEH";
  return c > ' ' && c < '\x7F' && forbidden.find(c) == std::string_view::npos;
}

char checked_delimiter(char c, const char* which) {
  if (may_delimit(c)) return c;
  throw InputError(fmt::format(
      "global section: the {} delimiter is '{}', expected a printable character other than digits, + - . D E H", which,
      to_utf8(std::string(1, c))));
}

/// The delimiters stand first and hold at once: they cut the section that defines them. Returns where the third value
/// begins; nothing if the record ends before.
std::optional<std::size_t> read_delimiters(std::string_view text, Delimiters& delimiters) {
  std::size_t at = 0;
  const auto skip_blanks = [&] {
    while (at < text.size() && text[at] == ' ') ++at;
  };
  /// "1Hc", or nothing.
  const auto redefinition = [&]() -> std::optional<char> {
    skip_blanks();
    if (at + 2 >= text.size() || text[at] != '1' || text[at + 1] != 'H') return std::nullopt;
    at += 3;
    return text[at - 1];
  };
  if (const auto c = redefinition()) delimiters.parameter = checked_delimiter(*c, "parameter");
  skip_blanks();
  if (at < text.size() && text[at] == delimiters.parameter) {
    ++at;
    if (const auto c = redefinition()) delimiters.record = checked_delimiter(*c, "record");
    skip_blanks();
  }
  if (delimiters.parameter == delimiters.record) {
    throw InputError(fmt::format("global section: '{}' is to delimit both parameters and records", delimiters.record));
  }
  if (at < text.size() && text[at] == delimiters.record) return std::nullopt;
  if (at >= text.size() || text[at] != delimiters.parameter) {
    throw InputError(fmt::format("global section: found '{}', expected the delimiter '{}' behind its definition",
                                 at < text.size() ? to_utf8(text.substr(at, 8)) : "nothing", delimiters.parameter));
  }
  return at + 1;
}

/// The values from the third on, by their numbers in the standard.
class GlobalValues {
 public:
  GlobalValues(std::vector<std::string_view> tokens, Warnings& warnings)
      : tokens_(std::move(tokens)), warnings_(warnings) {}

  std::string text(std::size_t number) const {
    const std::string_view token = at(number);
    // Some programs leave out the count.
    return parse_text(token).value_or(to_utf8(token));
  }
  int integer(std::size_t number, int fallback) const { return read(number, fallback, parse_integer, "an integer"); }
  double real(std::size_t number, double fallback) const { return read(number, fallback, parse_real, "a number"); }

 private:
  static constexpr std::size_t first = 3;

  std::string_view at(std::size_t number) const {
    return number - first < tokens_.size() ? tokens_[number - first] : std::string_view{};
  }
  template <class Value, class Parse>
  Value read(std::size_t number, Value fallback, Parse parse, const char* expected) const {
    const std::string_view token = at(number);
    if (token.empty()) return fallback;
    const auto value = parse(token);
    if (!value) {
      warnings_.add(fmt::format("value {} is '{}', expected {}; taken as {}", number, to_utf8(token.substr(0, 40)),
                                expected, fallback),
                    section);
    }
    return value.value_or(fallback);
  }

  std::vector<std::string_view> tokens_;
  Warnings& warnings_;
};

void find_unit(GlobalSection& global, Warnings& warnings) {
  const LengthUnit* by_flag = unit_of_flag(global.unit_flag);
  const LengthUnit* by_name = unit_of_name(global.unit_name);
  const LengthUnit* unit = by_flag != nullptr ? by_flag : by_name;
  if (by_flag != nullptr && by_name != nullptr && by_flag != by_name) {
    warnings.add(fmt::format("unit flag {} means {}, but the unit's name is '{}'; the flag holds", global.unit_flag,
                             by_flag->symbol, global.unit_name),
                 section);
  }
  if (by_flag == nullptr && global.unit_flag != 3) {
    warnings.add(fmt::format("unit flag {} is unknown, expected 1 to 11; the unit's name holds", global.unit_flag),
                 section);
  }
  if (unit == nullptr) {
    warnings.add(fmt::format("unit '{}' is unknown; lengths cannot be converted", global.unit_name), section);
    global.unit = global.unit_name.empty() ? "?" : global.unit_name;
    global.unit_in_millimetres = 0.0;
    return;
  }
  global.unit = unit->symbol;
  global.unit_in_millimetres = unit->millimetres;
}

void read_values(GlobalSection& global, const GlobalValues& values) {
  global.product = values.text(3);
  global.file_name = values.text(4);
  global.native_system = values.text(5);
  global.preprocessor_version = values.text(6);
  global.integer_bits = values.integer(7, global.integer_bits);
  global.single_exponent = values.integer(8, global.single_exponent);
  global.single_digits = values.integer(9, global.single_digits);
  global.double_exponent = values.integer(10, global.double_exponent);
  global.double_digits = values.integer(11, global.double_digits);
  global.receiving_product = values.text(12);
  global.scale = values.real(13, global.scale);
  global.unit_flag = values.integer(14, global.unit_flag);
  global.unit_name = values.text(15);
  global.line_weights = values.integer(16, global.line_weights);
  global.largest_line_width = values.real(17, global.largest_line_width);
  global.date = values.text(18);
  global.resolution = values.real(19, global.resolution);
  global.largest_coordinate = values.real(20, global.largest_coordinate);
  global.author = values.text(21);
  global.organisation = values.text(22);
  global.version_flag = values.integer(23, global.version_flag);
  global.drafting_standard = values.integer(24, global.drafting_standard);
  global.model_date = values.text(25);
  global.application_protocol = values.text(26);
}

}  // namespace

GlobalSection read_global_section(const std::string& text, Warnings& warnings) {
  GlobalSection global;
  if (text.empty()) {
    warnings.add("it is missing; the standard's defaults hold (unit: inch)", section);
    return global;
  }
  std::vector<std::string_view> tokens;
  if (const auto third = read_delimiters(text, global.delimiters)) {
    const RecordEnd end = scan_record(text, *third, global.delimiters, tokens);
    if (end.delimiter_missing) warnings.add("its record delimiter is missing", section);
    if (end.wrong_counts > 0) warnings.add("the count of characters before an H is wrong", section);
  }
  read_values(global, GlobalValues(std::move(tokens), warnings));
  if (!(global.scale > 0.0)) {
    warnings.add(fmt::format("the model space scale is {}, expected a positive number; taken as 1", global.scale),
                 section);
    global.scale = 1.0;
  }
  find_unit(global, warnings);
  return global;
}

}  // namespace isorim::io::iges
