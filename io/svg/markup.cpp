#include "io/svg/markup.h"

#include <fmt/format.h>

namespace isorim::io::svg {

namespace {

constexpr double superscript_size = 0.72;

/// Width in units of the font size; those of DejaVu Sans, the widest of the faces that we ask for.
double character_width(char c) {
  constexpr std::string_view narrow = " !'(),./:;I[]fijlrt|";
  constexpr std::string_view wide = "%+<=>@MWmw";
  const bool is_ascii = static_cast<unsigned char>(c) < 0x80;
  if (narrow.find(c) != std::string_view::npos) return 0.36;
  if (!is_ascii || wide.find(c) != std::string_view::npos) return 0.86;
  return 'A' <= c && c <= 'Z' ? 0.71 : 0.62;
}

}  // namespace

std::string number(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string escape(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

double text_width(std::string_view text, double font_size) {
  double width = 0.0;
  for (const char c : text) {
    const bool continues_character = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
    if (!continues_character) width += character_width(c);
  }
  return width * font_size;
}

double Label::width(double font_size) const {
  return text_width(base, font_size) + text_width(superscript, superscript_size * font_size);
}

std::string Label::markup(double font_size) const {
  if (superscript.empty()) return escape(base);
  return fmt::format(R"({}<tspan dy="{}" font-size="{}">{}</tspan>)", escape(base), number(-0.4 * font_size),
                     number(superscript_size * font_size), escape(superscript));
}

std::string open_document(int width, int height, std::string_view title) {
  std::string result = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
      R"(font-family="Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif" font-size="12" fill="#222">)"
      "\n",
      width, height);
  if (!title.empty()) result += fmt::format("<title>{}</title>\n", escape(title));
  return result + fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", width, height);
}

}  // namespace isorim::io::svg
