#include "io/iges/free_format.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace isorim::io::iges {

void Warnings::add(const std::string& kind, const std::string& place) {
  const auto [at, is_new] = index_.try_emplace(kind, kinds_.size());
  if (is_new) kinds_.push_back({kind, place, 0});
  ++kinds_[at->second].count;
}

std::vector<std::string> Warnings::sentences() const {
  std::vector<std::string> sentences;
  for (const Kind& kind : kinds_) {
    sentences.push_back(kind.count == 1 ? fmt::format("{}: {}", kind.first_place, kind.text)
                                        : fmt::format("{}: {} ({} times)", kind.first_place, kind.text, kind.count));
  }
  return sentences;
}

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
bool is_digit(char c) {
  return '0' <= c && c <= '9';
}

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

namespace {

/// The number of bytes that the next `characters` UTF-8 characters take.
std::size_t bytes_of_characters(std::string_view text, std::size_t characters) {
  std::size_t bytes = 0;
  for (; bytes < text.size(); ++bytes) {
    const bool starts_character = (static_cast<unsigned char>(text[bytes]) & 0xC0U) != 0x80U;
    if (starts_character && characters-- == 0) break;
  }
  return bytes;
}

class RecordScanner {
 public:
  RecordScanner(std::string_view text, std::size_t position, const Delimiters& delimiters)
      : text_(text), at_(position), delimiters_(delimiters) {}

  RecordEnd scan(std::vector<std::string_view>& tokens) {
    for (;;) {
      while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
      const std::size_t begin = at_;
      const std::size_t end = find_end(begin);
      at_ = find_delimiter(end);
      tokens.push_back(end > begin ? text_.substr(begin, end - begin) : trim(text_.substr(begin, at_ - begin)));
      if (at_ == text_.size()) return {at_, true, wrong_counts_};
      if (text_[at_++] == delimiters_.record) return {at_, false, wrong_counts_};
    }
  }

 private:
  bool is_delimiter(std::size_t at) const {
    return text_[at] == delimiters_.parameter || text_[at] == delimiters_.record;
  }
  std::size_t find_delimiter(std::size_t at) const {
    while (at < text_.size() && !is_delimiter(at)) ++at;
    return at;
  }
  /// Blanks and then a delimiter, or nothing at all.
  bool ends_at(std::size_t at) const {
    while (at < text_.size() && is_blank(text_[at])) ++at;
    return at == text_.size() || is_delimiter(at);
  }

  /// The end of the Hollerith string that begins at `begin`; `begin` itself if there is none.
  std::size_t find_end(std::size_t begin) {
    std::size_t content = begin;
    while (content < text_.size() && is_digit(text_[content])) ++content;
    if (content == begin || content == text_.size() || (text_[content] != 'H' && text_[content] != 'h')) return begin;
    std::size_t count = 0;
    const auto parsed = std::from_chars(text_.data() + begin, text_.data() + content, count);
    ++content;
    const bool fits = parsed.ec == std::errc() && count <= text_.size() - content;
    if (fits && ends_at(content + count)) return content + count;
    if (fits) {
      const std::size_t bytes = bytes_of_characters(text_.substr(content), count);
      if (bytes != count && ends_at(content + bytes)) return content + bytes;
    }
    ++wrong_counts_;
    const std::size_t nearest = find_delimiter(content);
    // A count that is too large reaches over whole values, one that is too small ends inside the string.
    const bool too_small = fits && (nearest >= content + count || !is_value(nearest + 1));
    return too_small ? find_delimiter(content + count) : nearest;
  }

  /// What stands between this place and the next delimiter is a number, a string or nothing.
  bool is_value(std::size_t at) const {
    const std::string_view value = trim(text_.substr(at, find_delimiter(at) - at));
    return value.empty() || parse_real(value) || parse_text(value);
  }

  std::string_view text_;
  std::size_t at_;
  Delimiters delimiters_;
  int wrong_counts_ = 0;
};

}  // namespace

RecordEnd scan_record(std::string_view text, std::size_t position, const Delimiters& delimiters,
                      std::vector<std::string_view>& tokens) {
  return RecordScanner(text, position, delimiters).scan(tokens);
}

namespace {

std::string_view without_plus(std::string_view token) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  return token;
}

/// Brings the exponent into the form that from_chars knows; the token as it is if it has it already.
std::string_view with_c_exponent(std::string_view token, std::string& buffer) {
  const std::size_t letter = token.find_first_of("DdEe");
  std::size_t exponent = letter;
  if (letter == std::string_view::npos) {
    exponent = token.find_first_of("+-", 1);
    if (exponent == std::string_view::npos || token.find('.') > exponent) return token;
    buffer.assign(token.substr(0, exponent)).append("e").append(token.substr(exponent));
    return buffer;
  }
  if (token[letter] == 'E' || token[letter] == 'e') return token;
  buffer.assign(token);
  buffer[letter] = 'e';
  return buffer;
}

/// Of a number that from_chars found out of range: below it rather than above.
bool is_tiny(std::string_view token) {
  const std::size_t end_of_mantissa = std::min(token.find_first_of("eE"), token.size());
  const std::string_view mantissa = token.substr(0, end_of_mantissa);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  const double magnitude = static_cast<double>(point) - static_cast<double>(first);
  double exponent = 0.0;
  if (end_of_mantissa < token.size()) {
    std::string_view digits = without_plus(token.substr(end_of_mantissa + 1));
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (read.ec == std::errc::result_out_of_range) return digits.starts_with('-');
  }
  return magnitude + exponent < 0.0;
}

}  // namespace

std::optional<double> parse_real(std::string_view token) {
  const std::size_t sign = !token.empty() && (token.front() == '-' || token.front() == '+') ? 1 : 0;
  // from_chars would read inf and nan.
  if (token.size() == sign || !(is_digit(token[sign]) || token[sign] == '.')) return std::nullopt;
  std::string buffer;
  const std::string_view number = with_c_exponent(without_plus(token), buffer);
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (end != number.data() + number.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    if (!is_tiny(number)) return std::nullopt;
    return token.front() == '-' ? -0.0 : 0.0;
  }
  return value;
}

std::optional<int> parse_integer(std::string_view token) {
  const std::string_view digits = without_plus(token);
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size()) {
    if (digits.size() < token.size() && value < 0) return std::nullopt;
    return value;
  }
  const std::optional<double> real = parse_real(token);
  if (!real || *real != std::floor(*real) || std::abs(*real) > std::numeric_limits<int>::max()) return std::nullopt;
  return static_cast<int>(*real);
}

std::optional<std::string> parse_text(std::string_view token) {
  std::size_t h = 0;
  while (h < token.size() && is_digit(token[h])) ++h;
  if (h == 0 || h == token.size() || (token[h] != 'H' && token[h] != 'h')) return std::nullopt;
  return to_utf8(token.substr(h + 1));
}

namespace {

/// Number of bytes of the UTF-8 character at the front of `bytes`, which is not empty; 0 if there is none.
std::size_t utf8_length(std::string_view bytes) {
  const auto lead = static_cast<unsigned char>(bytes.front());
  const std::size_t length = lead < 0x80U                     ? 1
                             : lead >= 0xC2U && lead < 0xE0U  ? 2
                             : lead >= 0xE0U && lead < 0xF0U  ? 3
                             : lead >= 0xF0U && lead <= 0xF4U ? 4
                                                              : 0;
  if (length == 0 || length > bytes.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(bytes[i]) & 0xC0U) != 0x80U) return 0;
  }
  const auto second = length > 1 ? static_cast<unsigned char>(bytes[1]) : 0U;
  // Overlong forms, surrogates and what lies beyond Unicode.
  const bool forbidden = (lead == 0xE0U && second < 0xA0U) || (lead == 0xEDU && second >= 0xA0U) ||
                         (lead == 0xF0U && second < 0x90U) || (lead == 0xF4U && second >= 0x90U);
  return forbidden ? 0 : length;
}

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

}  // namespace

std::string to_utf8(std::string_view bytes) {
  const bool as_is = is_utf8(bytes);
  std::string text;
  text.reserve(bytes.size());
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20U || code == 0x7FU) {
      text += ' ';
    } else if (code < 0x80U || as_is) {
      text += c;
    } else {
      text += static_cast<char>(0xC0U | (code >> 6U));
      text += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return text;
}

}  // namespace isorim::io::iges
