#include "io/tspline/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/excerpt.h"

namespace isorim::io::tspline {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

bool is_blank(char c) {
  return blanks.find(c) != std::string_view::npos;
}

/// As much of a word as a message has room for.
std::string shown(std::string_view word) {
  return excerpt(word, 40);
}

/// from_chars knows no plus sign.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

template <class Number>
bool parse(std::string_view word, Number& value) {
  const std::string_view digits = without_plus(word);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && end == digits.data() + digits.size();
}

}  // namespace

Words::Words(std::string_view text, char comment) : text_(text), comment_(comment) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text_.substr(0, byte_order_mark.size()) == byte_order_mark) text_.remove_prefix(byte_order_mark.size());
  advance();
}

void Words::advance() {
  std::size_t at = end_;
  int line = line_;
  last_line_ = line_;
  while (at < text_.size()) {
    const char c = text_[at];
    if (c == '\n') {
      ++line;
      ++at;
    } else if (is_blank(c)) {
      ++at;
    } else if (comment_ != 0 && c == comment_) {
      at = std::min(text_.find('\n', at), text_.size());
    } else {
      break;
    }
  }
  start_ = at;
  while (at < text_.size() && text_[at] != '\n' && !is_blank(text_[at]) && (comment_ == 0 || text_[at] != comment_))
    ++at;
  end_ = at;
  word_ = text_.substr(start_, end_ - start_);
  if (!word_.empty()) line_ = line;
}

void Words::refuse(int line, const std::string& reason) const {
  throw InputError(fmt::format("line {}: {}", line, reason));
}

void Words::refuse_word(std::string_view what) const {
  if (at_end()) refuse(line_, fmt::format("found the end of the file; expected {}", what));
  refuse(line_, fmt::format("found \"{}\"; expected {}", shown(word_), what));
}

std::string_view Words::word(std::string_view what) {
  if (at_end()) refuse_word(what);
  const std::string_view result = word_;
  advance();
  return result;
}

long Words::integer(std::string_view what, long low, long high) {
  long value = 0;
  if (at_end() || !parse(word_, value)) refuse_word(what);
  if (value < low || value > high) refuse_word(fmt::format("{} from {} to {}", what, low, high));
  advance();
  return value;
}

double Words::real(std::string_view what) {
  double value = 0.0;
  if (at_end() || !parse(word_, value) || !std::isfinite(value)) refuse_word(what);
  advance();
  return value;
}

std::size_t Words::count(std::string_view what, std::size_t words_each) {
  const int line = line_;
  const std::string_view found = word_;
  const auto value = static_cast<std::size_t>(integer(what, 1, 1L << 40));
  // Every word but the last is followed by a blank.
  const std::size_t room = (remaining() + 1) / 2 / words_each;
  if (value > room)
    refuse(line, fmt::format("found {} as {}, but the rest of the file has room for no more than {}", shown(found),
                             what, room));
  return value;
}

void Words::skip_line() {
  const int line = last_line_;
  while (!at_end() && line_ == line) advance();
}

}  // namespace isorim::io::tspline
