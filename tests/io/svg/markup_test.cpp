#include "io/svg/markup.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/io/svg/xml_check.h"

namespace isorim::io::svg {
namespace {

TEST(SvgMarkup, NumbersHaveNoNeedlessDigits) {
  EXPECT_EQ(number(12.5), "12.5");
  EXPECT_EQ(number(3.0), "3");
  EXPECT_EQ(number(100.0, 0), "100");
  EXPECT_EQ(number(0.126), "0.13");
  EXPECT_EQ(number(-0.001), "0");
  EXPECT_EQ(number(-1.25, 3), "-1.25");
}

TEST(SvgMarkup, EscapedTextComesBackFromTheParser) {
  const std::string text = "a < b & \"c\" > 'd'";
  EXPECT_EQ(parse_xml("<t a=\"" + escape(text) + "\">" + escape(text) + "</t>")[0].text, text);
  EXPECT_EQ(parse_xml("<t a=\"" + escape(text) + "\"/>")[0].attribute("a"), text);
}

TEST(SvgMarkup, ControlCharactersBecomeSpaces) {
  EXPECT_EQ(escape("a\x01\n"
                   "b"),
            "a  b");
}

TEST(SvgMarkup, WidthCountsCharactersNotBytes) {
  EXPECT_DOUBLE_EQ(text_width("\u00e9", 10.0), text_width("\u2212", 10.0));
  EXPECT_DOUBLE_EQ(text_width("abab", 12.0), 2.0 * text_width("ab", 12.0));
  EXPECT_LT(text_width("iii", 12.0), text_width("mmm", 12.0));
}

TEST(SvgMarkup, SuperscriptIsRaised) {
  const auto elements = parse_xml("<text>" + Label{"10", "5"}.markup(12.0) + "</text>");
  ASSERT_EQ(elements.size(), 2U);
  EXPECT_EQ(elements[0].text, "10");
  EXPECT_EQ(elements[1].text, "5");
  EXPECT_LT(elements[1].number("dy"), 0.0);
  EXPECT_LT(elements[1].number("font-size"), 12.0);
}

TEST(XmlCheck, RefusesWhatIsNotWellFormed) {
  for (const char* text : {"<a>", "<a></b>", "<a x=1/>", "<a x=\"1\" x=\"2\"/>", "<a>&</a>", "<a/><b/>", "<a b=\"<\"/>",
                           "<a><b></a></b>", ""}) {
    EXPECT_THROW(parse_xml(text), std::runtime_error) << text;
  }
}

}  // namespace
}  // namespace isorim::io::svg
