#include "io/iges/lines.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io::iges {
namespace {

constexpr std::size_t text_columns = 72;
constexpr std::size_t all_columns = 80;
/// Of P lines.
constexpr std::size_t parameter_columns = 64;

/// A line in its columns.
struct Columns {
  std::string_view text;
  char section = ' ';
  std::string_view number;
};

bool is_section(char c) {
  return c == 'S' || c == 'G' || c == 'D' || c == 'P' || c == 'T';
}

bool is_blank(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) <= ' '; });
}

/// Blanks and digits, as a sequence number has.
bool is_number_field(std::string_view text) {
  return text.find_first_not_of(" 0123456789") == std::string_view::npos;
}

/// 0 if it is blank or no number.
int number_in(std::string_view field) {
  field = trim(field);
  int number = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  return error == std::errc() && end == field.data() + field.size() ? number : 0;
}

std::optional<Columns> cut_at_columns(std::string_view line) {
  if (line.size() <= text_columns || !is_section(line[text_columns])) return std::nullopt;
  const std::string_view number = line.substr(text_columns + 1, all_columns - text_columns - 1);
  if (!is_number_field(number)) return std::nullopt;
  return Columns{line.substr(0, text_columns), line[text_columns], number};
}

std::string expand_tabs(std::string_view line) {
  constexpr std::size_t stop = 8;
  std::string expanded;
  for (const char c : line) {
    if (c == '\t') {
      expanded.append(stop - expanded.size() % stop, ' ');
    } else {
      expanded += c;
    }
  }
  return expanded;
}

/// The byte at which the character of that column (counted from 0) begins.
std::size_t byte_of_column(std::string_view line, std::size_t column) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xC0U) != 0x80U && column-- == 0) return i;
  }
  return line.size();
}

/// Where characters of several bytes each take one column.
std::optional<Columns> cut_at_characters(std::string_view line) {
  const std::size_t letter = byte_of_column(line, text_columns);
  if (letter >= line.size() || !is_section(line[letter])) return std::nullopt;
  const std::string_view number = line.substr(letter + 1, all_columns - text_columns - 1);
  if (!is_number_field(number)) return std::nullopt;
  return Columns{line.substr(0, letter), line[letter], number};
}

/// Where blanks are lost: the letter of a section and a number end the line.
std::optional<Columns> cut_from_end(std::string_view line) {
  line = trim(line);
  const std::size_t letter = line.find_last_not_of(" 0123456789");
  if (letter == std::string_view::npos || letter + 1 >= line.size()) return std::nullopt;
  if (!is_section(line[letter])) return std::nullopt;
  return Columns{line.substr(0, letter), line[letter], line.substr(letter + 1)};
}

/// The text and the back pointer of a P line; of one that has lost blanks only if a blank parts the two.
std::optional<std::pair<std::string_view, int>> cut_parameters(std::string_view text, bool in_columns) {
  if (in_columns) {
    const std::size_t end =
        text.size() > text_columns ? byte_of_column(text, parameter_columns) : std::min(parameter_columns, text.size());
    return std::pair(text.substr(0, end), number_in(text.substr(end)));
  }
  text = trim(text);
  const std::size_t digits = text.find_last_not_of("0123456789") + 1;
  if (digits == 0 || (digits < text.size() && text[digits - 1] != ' ')) return std::nullopt;
  return std::pair(text.substr(0, digits), number_in(text.substr(digits)));
}

class Splitter {
 public:
  explicit Splitter(Warnings& warnings) : warnings_(warnings) {}

  Sections split(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    for (const char end : {'\r', '\n'}) {
      if (bytes.find(end) != std::string_view::npos) line_end_ = end;
    }
    reserve(bytes.size());
    while (!bytes.empty() && !sections_.terminate) take(next_line(bytes));
    if (!is_blank(bytes)) {
      warnings_.add("the file goes on after the T line; that was left out", place(file_line_ + 1));
    }
    if (sections_.global_lines == 0 && sections_.directory.empty() && sections_.parameters.lines.empty()) {
      throw InputError("not an IGES file: no line has the letter of a section (S, G, D, P, T) in column 73");
    }
    if (!sections_.terminate) {
      warnings_.add("the T line that ends a file is missing; the file may be cut off", place(file_line_));
    }
    return std::move(sections_);
  }

 private:
  static std::string place(int line) { return fmt::format("line {}", line); }

  void reserve(std::size_t bytes) {
    const std::size_t lines = bytes / all_columns;
    sections_.parameters.text.reserve(lines * parameter_columns);
    sections_.parameters.lines.reserve(lines);
  }

  std::string_view next_line(std::string_view& bytes) {
    ++file_line_;
    const std::size_t end = std::min(line_end_ != '\0' ? bytes.find(line_end_) : all_columns, bytes.size());
    std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(line_end_ != '\0' ? std::min(end + 1, bytes.size()) : end);
    while (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void take(std::string_view line) {
    if (is_blank(line)) return;
    if (const auto columns = cut_at_columns(line)) {
      if (line.size() > all_columns && !is_blank(line.substr(all_columns))) {
        warnings_.add("text behind column 80 was left out", place(file_line_));
      }
      return add(*columns, true);
    }
    take_irregular(line);
  }

  void take_irregular(std::string_view line) {
    if (line.find('\t') != std::string_view::npos) {
      const std::string expanded = expand_tabs(line);
      if (const auto columns = cut_at_columns(expanded)) {
        warnings_.add("tabs were taken for blanks up to the next multiple of 8 columns", place(file_line_));
        return add(*columns, true);
      }
    }
    if (const auto columns = cut_at_characters(line)) {
      warnings_.add("a character of several bytes was counted as one column", place(file_line_));
      return add(*columns, true);
    }
    const auto columns = cut_from_end(line);
    const bool has_lost_blanks = columns && continues(*columns);
    if (has_lost_blanks && makes_sense_without_columns(*columns)) {
      warnings_.add("the line has lost blanks; its end was taken for columns 73 to 80", place(file_line_));
      return add(*columns, false);
    }
    if (section_ != 'S' || has_lost_blanks) refuse(line);
    warnings_.add("a line without the letter of its section was taken for prose of the start section",
                  place(file_line_));
    sections_.start.push_back(to_utf8(line));
  }

  [[noreturn]] void refuse(std::string_view line) const {
    const std::string found = line.size() > text_columns
                                  ? fmt::format("columns 73 to 80 hold '{}'", to_utf8(line.substr(text_columns, 8)))
                                  : fmt::format("it has {} columns only", line.size());
    throw InputError(
        fmt::format("line {} belongs to no section: {}, expected one of S, G, D, P, T and the number of the line",
                    file_line_, found));
  }

  /// The number is the one that the section's next line should have.
  bool continues(const Columns& columns) const {
    const std::size_t expected = columns.section == 'S'   ? static_cast<std::size_t>(sections_.start_lines)
                                 : columns.section == 'G' ? static_cast<std::size_t>(sections_.global_lines)
                                 : columns.section == 'D' ? sections_.directory.size()
                                 : columns.section == 'P' ? sections_.parameters.lines.size()
                                                          : 0;
    return static_cast<std::size_t>(number_in(columns.number)) == expected + 1;
  }

  static bool makes_sense_without_columns(const Columns& columns) {
    if (columns.text.size() > text_columns) return false;
    return columns.section == 'P' ? cut_parameters(columns.text, false).has_value() : columns.section != 'D';
  }

  void add(const Columns& columns, bool in_columns) {
    section_ = columns.section;
    switch (section_) {
      case 'S':
        ++sections_.start_lines;
        sections_.start.push_back(to_utf8(columns.text.substr(0, columns.text.find_last_not_of(' ') + 1)));
        break;
      case 'G':
        ++sections_.global_lines;
        append_padded(sections_.global, columns.text, text_columns);
        break;
      case 'D':
        add_directory_line(columns);
        break;
      case 'P':
        add_parameter_line(columns, in_columns);
        break;
      default:
        sections_.terminate = std::string(columns.text);
    }
  }

  static void append_padded(std::string& text, std::string_view columns, std::size_t width) {
    text.append(columns);
    if (columns.size() < width) text.append(width - columns.size(), ' ');
  }

  void add_directory_line(const Columns& columns) {
    DirectoryLine line{{}, number_in(columns.number), file_line_};
    line.columns.fill(' ');
    std::copy_n(columns.text.begin(), std::min(columns.text.size(), text_columns), line.columns.begin());
    sections_.directory.push_back(line);
  }

  void add_parameter_line(const Columns& columns, bool in_columns) {
    const auto [text, back_pointer] = cut_parameters(columns.text, in_columns).value();
    ParameterText& parameters = sections_.parameters;
    parameters.lines.push_back({parameters.text.size(), back_pointer, number_in(columns.number)});
    append_padded(parameters.text, text, parameter_columns);
  }

  Warnings& warnings_;
  Sections sections_;
  char section_ = 'S';
  int file_line_ = 0;
  /// 0 where every 80 bytes are a line.
  char line_end_ = '\0';
};

/// Says what a file is that is not IGES in fixed form.
void refuse_other_formats(std::string_view bytes) {
  if (is_blank(bytes)) throw InputError("the file is empty");
  const std::string_view head = bytes.substr(0, 1024);
  const std::string_view flag = head.substr(0, std::min(all_columns, head.find_first_of("\r\n")));
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) {
    throw InputError("the file is text in UTF-16; IGES is ASCII");
  }
  if (head.find('\0') != std::string_view::npos) {
    const bool has_flag = head.starts_with('B') || (flag.size() > text_columns && flag[text_columns] == 'B');
    throw InputError(has_flag
                         ? "this is IGES in the binary form, which is not read; export it in the fixed (ASCII) form"
                         : "not an IGES file: it is binary");
  }
  if (flag.size() > text_columns && flag[text_columns] == 'C' && is_number_field(flag.substr(text_columns + 1))) {
    throw InputError("this is IGES in the compressed form, which is not read; export it in the fixed form");
  }
  constexpr std::pair<std::string_view, std::string_view> others[] = {
      {"ISO-10303-21", "a STEP file"},        {"solid ", "an STL file"},        {"DBRep_DrawableShape", "a BREP file"},
      {"CASCADE Topology", "a BREP file"},    {"<?xml", "an XML file"},         {"%PDF", "a PDF file"},
      {"PK\x03\x04", "a compressed archive"}, {"\x1F\x8B", "a compressed file"}};
  for (const auto& [start, what] : others) {
    if (head.starts_with(start)) throw InputError(fmt::format("not an IGES file: it looks like {}", what));
  }
}

}  // namespace

Sections split_sections(std::string_view bytes, Warnings& warnings) {
  refuse_other_formats(bytes);
  return Splitter(warnings).split(bytes);
}

}  // namespace isorim::io::iges
