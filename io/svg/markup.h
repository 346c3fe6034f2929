#pragma once

#include <string>
#include <string_view>

/// The few pieces of SVG text that plots and drawings are put together from.
namespace isorim::io::svg {

/// `value` with at most `decimals` decimals and no trailing zeros: "12.5", "3", "0" (never "-0").
std::string number(double value, int decimals = 2);

/// Characters that mean something in XML as entities; control characters, which XML forbids, as spaces.
std::string escape(std::string_view text);

/// A guess at the width in pixels of the text (UTF-8) in a sans-serif face of the given size.
double text_width(std::string_view text, double font_size);

/// Text with a superscript, such as 10 to the power of 5. Neither is escaped yet.
struct Label {
  std::string base;
  std::string superscript;

  double width(double font_size) const;
  /// The content of a <text> element of the given font size.
  std::string markup(double font_size) const;
};

/// The opening <svg> element: size in pixels, white ground, font, and the title for screen readers.
std::string open_document(int width, int height, std::string_view title);

}  // namespace isorim::io::svg
