#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/iges/file.h"

/// Values in free format, as the G and P sections hold them.
namespace isorim::io::iges {

/// Warnings, one for each kind: thousands of lines may have the same flaw.
class Warnings {
 public:
  /// `place` ("line 12", "128 at D7") is shown for the first of a kind.
  void add(const std::string& kind, const std::string& place);
  /// In the order in which the kinds came up.
  std::vector<std::string> sentences() const;

 private:
  struct Kind {
    std::string text;
    std::string first_place;
    std::size_t count = 0;
  };
  std::vector<Kind> kinds_;
  std::map<std::string, std::size_t, std::less<>> index_;
};

std::string_view trim(std::string_view text);

struct RecordEnd {
  /// Just behind the record delimiter, or the end of the text.
  std::size_t position = 0;
  /// The text ended before the record did.
  bool delimiter_missing = false;
  /// Hollerith strings whose count of characters contradicts the delimiter behind them.
  int wrong_counts = 0;
};

/// Cuts the record that begins at `position` into its values: views of `text`, blanks trimmed, empty where a value is
/// left out. Hollerith strings are one value whatever they contain. Where the number before H does not lead to a
/// delimiter, it is tried as a number of UTF-8 characters, then the string ends at the delimiter that makes sense.
RecordEnd scan_record(std::string_view text, std::size_t position, const Delimiters& delimiters,
                      std::vector<std::string_view>& tokens);

/// The double nearest to a decimal number as Fortran and C write it: signs, no digits before or behind the point,
/// exponents with E or D of either case, or with a sign alone (1.5-300). Numbers below the range are 0; nothing for
/// numbers above the range and for what is no number. Independent of the locale.
std::optional<double> parse_real(std::string_view token);
/// An integer, also one that is written as a real number (3., 3.0E0).
std::optional<int> parse_integer(std::string_view token);
/// The characters of a Hollerith string as UTF-8; nothing if the token is not one.
std::optional<std::string> parse_text(std::string_view token);
/// UTF-8 of what is UTF-8 already or else Latin-1; control characters become blanks.
std::string to_utf8(std::string_view bytes);

}  // namespace isorim::io::iges
