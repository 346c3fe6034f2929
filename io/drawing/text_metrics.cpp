#include "io/drawing/text_metrics.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace isorim::io::drawing {

namespace {

/// Of Helvetica, in thousandths of the font size, for the bytes 32 to 255 of Windows-1252; 0 where there is none.
/// Adobe Core 14 font metrics, Helvetica.afm.
constexpr std::array<std::uint16_t, 224> helvetica_widths{
    278,  278, 355, 556, 556, 889,  667,  191,  333, 333,  389, 584, 278,  333, 278, 278,  //
    556,  556, 556, 556, 556, 556,  556,  556,  556, 556,  278, 278, 584,  584, 584, 556,  //
    1015, 667, 667, 722, 722, 667,  611,  778,  722, 278,  500, 667, 556,  833, 722, 778,  //
    667,  778, 722, 667, 611, 722,  667,  944,  667, 667,  611, 278, 278,  278, 469, 556,  //
    333,  556, 556, 500, 556, 556,  278,  556,  556, 222,  222, 500, 222,  833, 556, 556,  //
    556,  556, 333, 500, 278, 556,  500,  722,  500, 500,  500, 334, 260,  334, 584, 0,    //
    556,  0,   222, 556, 333, 1000, 556,  556,  333, 1000, 667, 333, 1000, 0,   611, 0,    //
    0,    222, 222, 333, 333, 350,  556,  1000, 333, 1000, 500, 333, 944,  0,   500, 667,  //
    278,  333, 556, 556, 556, 556,  260,  556,  333, 737,  370, 556, 584,  333, 737, 333,  //
    400,  584, 333, 333, 333, 578,  537,  278,  333, 333,  365, 556, 834,  834, 834, 611,  //
    667,  667, 667, 667, 667, 667,  1000, 722,  667, 667,  667, 667, 278,  278, 278, 278,  //
    722,  722, 778, 778, 778, 778,  778,  584,  778, 722,  722, 722, 722,  667, 667, 611,  //
    556,  556, 556, 556, 556, 556,  889,  500,  556, 556,  556, 556, 278,  278, 278, 278,  //
    556,  556, 556, 556, 556, 556,  556,  584,  611, 556,  556, 556, 556,  500, 556, 500};

/// The characters that Windows-1252 has in its bytes 128 to 159; 0 where there is none.
constexpr std::array<char32_t, 32> windows_1252{0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                                0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0,      0x017D, 0,
                                                0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                                0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

struct SymbolGlyph {
  char32_t character;
  std::uint8_t byte;
  std::uint16_t width;
};

/// Adobe Core 14 font metrics, Symbol.afm.
constexpr std::array symbol_glyphs{
    SymbolGlyph{U'Α', 65, 722},  SymbolGlyph{U'Β', 66, 667},       SymbolGlyph{U'Γ', 71, 603},
    SymbolGlyph{U'Δ', 68, 612},  SymbolGlyph{U'Ε', 69, 611},       SymbolGlyph{U'Ζ', 90, 611},
    SymbolGlyph{U'Η', 72, 722},  SymbolGlyph{U'Θ', 81, 741},       SymbolGlyph{U'Ι', 73, 333},
    SymbolGlyph{U'Κ', 75, 722},  SymbolGlyph{U'Λ', 76, 686},       SymbolGlyph{U'Μ', 77, 889},
    SymbolGlyph{U'Ν', 78, 722},  SymbolGlyph{U'Ξ', 88, 645},       SymbolGlyph{U'Ο', 79, 722},
    SymbolGlyph{U'Π', 80, 768},  SymbolGlyph{U'Ρ', 82, 556},       SymbolGlyph{U'Σ', 83, 592},
    SymbolGlyph{U'Τ', 84, 611},  SymbolGlyph{U'Υ', 85, 690},       SymbolGlyph{U'Φ', 70, 763},
    SymbolGlyph{U'Χ', 67, 722},  SymbolGlyph{U'Ψ', 89, 795},       SymbolGlyph{U'Ω', 87, 768},
    SymbolGlyph{U'α', 97, 631},  SymbolGlyph{U'β', 98, 549},       SymbolGlyph{U'γ', 103, 411},
    SymbolGlyph{U'δ', 100, 494}, SymbolGlyph{U'ε', 101, 439},      SymbolGlyph{U'ζ', 122, 494},
    SymbolGlyph{U'η', 104, 603}, SymbolGlyph{U'θ', 113, 521},      SymbolGlyph{U'ι', 105, 329},
    SymbolGlyph{U'κ', 107, 549}, SymbolGlyph{U'λ', 108, 549},      SymbolGlyph{U'μ', 109, 576},
    SymbolGlyph{U'ν', 110, 521}, SymbolGlyph{U'ξ', 120, 493},      SymbolGlyph{U'ο', 111, 549},
    SymbolGlyph{U'π', 112, 549}, SymbolGlyph{U'ρ', 114, 549},      SymbolGlyph{U'ς', 86, 439},
    SymbolGlyph{U'σ', 115, 603}, SymbolGlyph{U'τ', 116, 439},      SymbolGlyph{U'υ', 117, 576},
    SymbolGlyph{U'φ', 102, 521}, SymbolGlyph{U'χ', 99, 549},       SymbolGlyph{U'ψ', 121, 686},
    SymbolGlyph{U'ω', 119, 686}, SymbolGlyph{U'\u2032', 162, 247}, SymbolGlyph{U'\u2033', 178, 411},
    SymbolGlyph{U'←', 172, 987}, SymbolGlyph{U'↑', 173, 603},      SymbolGlyph{U'→', 174, 987},
    SymbolGlyph{U'↓', 175, 603}, SymbolGlyph{U'∂', 182, 494},      SymbolGlyph{U'∅', 198, 823},
    SymbolGlyph{U'∇', 209, 713}, SymbolGlyph{U'∑', 229, 713},      SymbolGlyph{U'\u2212', 45, 549},
    SymbolGlyph{U'√', 214, 549}, SymbolGlyph{U'∞', 165, 713},      SymbolGlyph{U'∫', 242, 274},
    SymbolGlyph{U'≈', 187, 549}, SymbolGlyph{U'≠', 185, 549},      SymbolGlyph{U'≤', 163, 549},
    SymbolGlyph{U'≥', 179, 549}};

constexpr char32_t replacement = 0xFFFD;

struct Glyph {
  Font font = Font::helvetica;
  std::uint8_t byte = '?';
  double width = 0.556;
};

Glyph glyph_of(char32_t c) {
  if (const auto byte = windows_1252_byte(c))
    return {Font::helvetica, *byte, 1e-3 * helvetica_widths[static_cast<std::size_t>(*byte - 32)]};
  for (const SymbolGlyph& glyph : symbol_glyphs)
    if (glyph.character == c) return {Font::symbol, glyph.byte, 1e-3 * glyph.width};
  return {};
}

/// The code point that starts at `at`, which moves on to the next one; U+FFFD, and one byte on, if there is none.
char32_t next_code_point(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(at);
  const std::size_t length = first < 0x80         ? 1
                             : first >> 5 == 0x6  ? 2
                             : first >> 4 == 0xE  ? 3
                             : first >> 3 == 0x1E ? 4
                                                  : 0;
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  if (length == 0 || at + length > text.size()) return ++at, replacement;
  char32_t c = length == 1 ? first : first & (0x7FU >> length);
  for (std::size_t i = at + 1; i < at + length; ++i) {
    if (byte(i) >> 6 != 0x2) return ++at, replacement;
    c = c << 6 | (byte(i) & 0x3FU);
  }
  if (c < least[length] || c > 0x10FFFF || (c >= 0xD800 && c < 0xE000)) return ++at, replacement;
  at += length;
  return c;
}

}  // namespace

std::optional<std::uint8_t> windows_1252_byte(char32_t c) {
  if ((c >= 32 && c < 127) || (c >= 160 && c < 256)) return static_cast<std::uint8_t>(c);
  const auto found = std::find(windows_1252.begin(), windows_1252.end(), c);
  if (c == 0 || found == windows_1252.end()) return std::nullopt;
  return static_cast<std::uint8_t>(128 + (found - windows_1252.begin()));
}

std::vector<char32_t> code_points(std::string_view text) {
  std::vector<char32_t> result;
  for (std::size_t at = 0; at < text.size();) result.push_back(next_code_point(text, at));
  return result;
}

std::vector<TextRun> text_runs(std::string_view text) {
  std::vector<TextRun> runs;
  for (const char32_t c : code_points(text)) {
    const Glyph glyph = glyph_of(c);
    if (runs.empty() || runs.back().font != glyph.font) runs.push_back({glyph.font, "", 0.0});
    runs.back().bytes += static_cast<char>(glyph.byte);
    runs.back().width += glyph.width;
  }
  return runs;
}

double text_width(std::string_view text, double height) {
  double width = 0.0;
  for (const TextRun& run : text_runs(text)) width += run.width;
  return width * height / cap_height;
}

}  // namespace isorim::io::drawing
