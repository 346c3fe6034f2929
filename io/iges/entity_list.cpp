#include "io/iges/entity_list.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/iges/free_format.h"

namespace isorim::io::iges {
namespace {

constexpr std::size_t parameter_columns = 64;
constexpr std::size_t text_columns = 72;

}  // namespace

std::string real_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos) text[exponent] = 'E';
  if (text.find('.') == std::string::npos) text.insert(std::min(exponent, text.size()), 1, '.');
  return text;
}

void Record::append_whole(std::string_view token) {
  if (lines_.back().size() + token.size() + 1 > columns_) lines_.emplace_back();
  lines_.back().append(token) += ',';
}

Record& Record::integer(long value) {
  append_whole(fmt::format("{}", value));
  return *this;
}

Record& Record::real(double value) {
  append_whole(real_text(value));
  return *this;
}

Record& Record::omitted() {
  append_whole("");
  return *this;
}

Record& Record::text(std::string_view value) {
  if (value.empty()) return omitted();
  const std::string head = fmt::format("{}H", value.size());
  if (lines_.back().size() + head.size() + 1 > columns_) lines_.emplace_back();
  lines_.back() += head;
  for (const char c : value) {
    if (lines_.back().size() == columns_) lines_.emplace_back();
    lines_.back() += static_cast<unsigned char>(c) < 0x20U || c == '\x7F' ? ' ' : c;
  }
  if (lines_.back().size() == columns_) lines_.emplace_back();
  lines_.back() += ',';
  return *this;
}

std::vector<std::string> Record::lines() const {
  std::vector<std::string> lines = lines_;
  lines.back().back() = ';';
  return lines;
}

Record EntityList::parameters(int type) {
  Record record(parameter_columns);
  record.integer(type);
  return record;
}

int EntityList::add(int type, const Record& parameters, const DirectoryFields& fields) {
  const int number = static_cast<int>(directory_.size()) + 1;
  const std::size_t first_line = parameters_.size() + 1;
  const std::vector<std::string> lines = parameters.lines();
  for (const std::string& line : lines)
    parameters_.push_back(fmt::format("{:<64} {:7}", "", number).replace(0, line.size(), line));
  directory_.push_back(fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}00{:02}{:02}00", type, first_line, 0, 0,
                                   fields.level, 0, fields.transformation, 0, fields.subordinate, fields.use));
  directory_.push_back(fmt::format("{:8}{:8}{:8}{:8}{:8}{:32}", type, 0, fields.colour, lines.size(), fields.form, ""));
  directory_.back().replace(71, 1, "0");
  return number;
}

namespace {

void append_lines(std::string& text, const std::vector<std::string>& lines, char section) {
  constexpr std::size_t most = 9999999;
  if (lines.size() > most) {
    throw InputError(fmt::format("section {} of the IGES file would have {} lines, expected {} at most", section,
                                 lines.size(), most));
  }
  std::size_t number = 0;
  for (const std::string& line : lines) {
    text += line;
    text.append(text_columns - line.size(), ' ');
    fmt::format_to(std::back_inserter(text), "{}{:7}\n", section, ++number);
  }
}

}  // namespace

std::string EntityList::file_text(std::string_view start, const Record& global) const {
  std::vector<std::string> prose;
  do {
    prose.emplace_back(start.substr(0, text_columns));
    start.remove_prefix(std::min(text_columns, start.size()));
  } while (!start.empty());
  const std::vector<std::string> globals = global.lines();
  std::string text;
  text.reserve((prose.size() + globals.size() + directory_.size() + parameters_.size() + 1) * (text_columns + 9));
  append_lines(text, prose, 'S');
  append_lines(text, globals, 'G');
  append_lines(text, directory_, 'D');
  append_lines(text, parameters_, 'P');
  append_lines(
      text, {fmt::format("S{:7}G{:7}D{:7}P{:7}", prose.size(), globals.size(), directory_.size(), parameters_.size())},
      'T');
  return text;
}

Record global_record() {
  Record record(text_columns);
  record.text(",").text(";");
  return record;
}

}  // namespace isorim::io::iges
