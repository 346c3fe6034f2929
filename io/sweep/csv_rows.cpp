#include "io/sweep/csv_rows.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// Takes a text apart, row by row.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
    separator_ = find_separator();
  }

  /// The next row that is neither empty nor a comment; false at the end.
  bool next(std::vector<std::string>& fields, int& line) {
    while (at_ < text_.size()) {
      line = line_;
      if (pass_over()) continue;
      fields.clear();
      do fields.push_back(field());
      while (take(separator_));
      take('\r');
      if (at_ < text_.size() && !take_line_end()) {
        fail(fmt::format("found \"{}\" behind a closing quote", text_[at_]));
      }
      return true;
    }
    return false;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, message));
  }

 private:
  char find_separator() const {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    bool quoted = false;
    bool tab = false;
    for (const char c : text_.substr(0, end)) {
      if (c == '"') quoted = !quoted;
      if (!quoted && c == ';') return ';';
      tab |= !quoted && c == '\t';
    }
    return tab ? '\t' : ',';
  }

  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  bool take_line_end() {
    if (!take('\n')) return false;
    ++line_;
    return true;
  }

  /// Passes over an empty line or a comment.
  bool pass_over() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    if (!line.starts_with('#') && !std::all_of(line.begin(), line.end(), is_blank)) return false;
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return true;
  }

  void pass_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_]) && text_[at_] != separator_) ++at_;
  }

  std::string field() {
    pass_blanks();
    if (at_ < text_.size() && text_[at_] == '"') {
      std::string content = quoted();
      pass_blanks();
      return content;
    }
    const std::size_t end = std::min(text_.find_first_of(std::string{separator_, '\n'}, at_), text_.size());
    std::string_view content = text_.substr(at_, end - at_);
    at_ = end;
    while (!content.empty() && is_blank(content.back())) content.remove_suffix(1);
    return std::string(content);
  }

  std::string quoted() {
    const int begin = line_;
    std::string content;
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (c == '"') {
        ++at_;
        if (at_ >= text_.size() || text_[at_] != '"') return content;
      }
      content += c;
    }
    line_ = begin;
    fail("found a quote that is not closed");
  }

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
  int line_ = 1;
  char separator_ = ',';
};

void check_headings(const CsvReader& reader, const std::vector<std::string>& headings) {
  for (auto heading = headings.begin(); heading != headings.end(); ++heading) {
    if (heading->empty()) reader.fail("found an empty heading");
    if (std::find(headings.begin(), heading, *heading) != heading) {
      reader.fail(fmt::format("found the heading \"{}\" twice", *heading));
    }
  }
}

}  // namespace

CsvRows parse_csv(std::string_view text, const std::string& name) {
  CsvReader reader(text, name);
  CsvRows result{std::make_shared<const std::string>(name), {}, {}, {}};
  int line = 0;
  if (!reader.next(result.headings, line)) reader.fail("found no line of headings");
  check_headings(reader, result.headings);
  std::vector<std::string> fields;
  while (reader.next(fields, line)) {
    if (fields.size() != result.headings.size()) {
      throw InputError(fmt::format("{}:{}: found {} fields; expected {}, one a heading", name, line, fields.size(),
                                   result.headings.size()));
    }
    result.rows.push_back(fields);
    result.lines.push_back(line);
  }
  if (result.rows.empty()) reader.fail("found no rows below the headings");
  return result;
}

std::string csv_field(std::string_view text) {
  const bool plain = !text.empty() && text.find_first_of(",;\"\n\r\t#") == std::string_view::npos &&
                     !is_blank(text.front()) && !is_blank(text.back());
  if (plain || text.empty()) return std::string(text);
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace isorim::io
