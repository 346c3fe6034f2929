#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Texts in the fonts that every PDF reader has: Helvetica and, for Greek letters and mathematical signs, Symbol.
namespace isorim::io::drawing {

/// Of capital letters, in units of the font size (Adobe's font metrics of Helvetica).
inline constexpr double cap_height = 0.718;

enum class Font { helvetica, symbol };

/// Part of a text in one font.
struct TextRun {
  Font font = Font::helvetica;
  /// In the font's own encoding: Windows-1252 for Helvetica, Symbol's built-in one.
  std::string bytes;
  /// In units of the font size.
  double width = 0.0;
};

/// The text (UTF-8) as runs. Characters that neither font has, and bytes that are not UTF-8, become question marks.
std::vector<TextRun> text_runs(std::string_view text);

/// The width in mm of the text in letters whose capitals are `height` mm high.
double text_width(std::string_view text, double height);

/// The characters of UTF-8 text as code points; bytes that are not UTF-8 as U+FFFD.
std::vector<char32_t> code_points(std::string_view text);

/// The byte of Windows-1252, if that has the character and it is none that controls.
std::optional<std::uint8_t> windows_1252_byte(char32_t c);

}  // namespace isorim::io::drawing
