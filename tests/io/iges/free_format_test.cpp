#include "io/iges/free_format.h"

#include <clocale>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace isorim::io::iges {
namespace {

using Tokens = std::vector<std::string_view>;

struct Scanned {
  Tokens tokens;
  RecordEnd end;
};
Scanned scan(std::string_view text, const Delimiters& delimiters = {}) {
  Scanned scanned;
  scanned.end = scan_record(text, 0, delimiters, scanned.tokens);
  return scanned;
}

TEST(IgesFreeFormat, RealsAreTheNearestDoubles) {
  const std::pair<const char*, double> cases[] = {{"1.5", 1.5},
                                                  {"+1.5", 1.5},
                                                  {"-1.5", -1.5},
                                                  {"5", 5.0},
                                                  {"5.", 5.0},
                                                  {".5", 0.5},
                                                  {"-.5", -0.5},
                                                  {"1E3", 1000.0},
                                                  {"1.E+03", 1000.0},
                                                  {"1.5D-3", 0.0015},
                                                  {"1.5d+03", 1500.0},
                                                  {"2.5e1", 25.0},
                                                  {"0.1234-100", 0.1234e-100},
                                                  {"1.5+20", 1.5e20},
                                                  {"-1.5-20", -1.5e-20},
                                                  {"0.1", 0.1},
                                                  {"0.333333333333333333333333333333", 1.0 / 3.0},
                                                  {"1.7976931348623157E308", std::numeric_limits<double>::max()},
                                                  {"4.9406564584124654D-324", 4.9406564584124654e-324},
                                                  {"1E-400", 0.0},
                                                  {"0.0000000001E-320", 0.0},
                                                  {"1E-99999999999999999999", 0.0}};
  for (const auto& [text, expected] : cases) {
    ASSERT_TRUE(parse_real(text).has_value()) << text;
    EXPECT_EQ(*parse_real(text), expected) << text;
  }
  EXPECT_TRUE(std::signbit(*parse_real("-0.")));
  EXPECT_TRUE(std::signbit(*parse_real("-1D-999")));
}

TEST(IgesFreeFormat, EveryDoubleSurvivesSeventeenDigits) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-10.0, 10.0);
  std::uniform_int_distribution<int> exponent(-300, 300);
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, exponent(random));
    char text[64];
    std::snprintf(text, sizeof text, "%.16E", value);
    ASSERT_EQ(parse_real(text), value) << text;
    for (char& c : text) c = c == 'E' ? 'D' : c;
    ASSERT_EQ(parse_real(text), value) << text;
  }
}

TEST(IgesFreeFormat, WhatIsNoNumberIsNotRead) {
  for (const char* text : {"",      "+",      "-",       ".",      "abc",   "1.5x",   "x1.5",           "1..5", "1.5.5",
                           "--1",   "+-1",    "-+1",     "inf",    "nan",   "-inf",   "infinity",       "0x10", "1.5E",
                           "1.5E+", "1.5D",   "1 5",     "1.5 E3", "1E999", "-1E999", "1000000000E300", "1-2",  "1,5",
                           "3HABC", "1.5EE3", "1.5D3D3", "E5",     "D5"}) {
    EXPECT_FALSE(parse_real(text).has_value()) << text;
  }
}

TEST(IgesFreeFormat, IntegersMayBeWrittenAsReals) {
  EXPECT_EQ(parse_integer("3"), 3);
  EXPECT_EQ(parse_integer("+3"), 3);
  EXPECT_EQ(parse_integer("-3"), -3);
  EXPECT_EQ(parse_integer("0003"), 3);
  EXPECT_EQ(parse_integer("3."), 3);
  EXPECT_EQ(parse_integer("3.0D0"), 3);
  EXPECT_EQ(parse_integer("2147483647"), 2147483647);
  for (const char* text : {"", "3.5", "2147483648", "1E10", "-1E10", "abc", "3a", "+-3", "1H3"}) {
    EXPECT_FALSE(parse_integer(text).has_value()) << text;
  }
}

TEST(IgesFreeFormat, ThePointIsAPointInEveryLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"}) {
    // Where the locale is not installed there is nothing to see.
    std::setlocale(LC_ALL, locale);
    EXPECT_EQ(parse_real("1.5"), 1.5) << locale;
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(IgesFreeFormat, CutsRecords) {
  EXPECT_EQ(scan("110,1.,,2. ;").tokens, (Tokens{"110", "1.", "", "2."}));
  EXPECT_EQ(scan("   110 ,  1. , 2.;").tokens, (Tokens{"110", "1.", "2."}));
  EXPECT_EQ(scan(";").tokens, Tokens{""});
  EXPECT_EQ(scan("110,1.,;").tokens, (Tokens{"110", "1.", ""}));
  const Scanned with_comment = scan("110,1.; a comment, with 3Hx;y; and more");
  EXPECT_EQ(with_comment.tokens, (Tokens{"110", "1."}));
  EXPECT_EQ(with_comment.end.position, 7U);
  const Scanned unfinished = scan("110,1.,2.   ");
  EXPECT_EQ(unfinished.tokens, (Tokens{"110", "1.", "2."}));
  EXPECT_TRUE(unfinished.end.delimiter_missing);
  EXPECT_EQ(scan("110/1./,;#", {'/', '#'}).tokens, (Tokens{"110", "1.", ",;"}));
}

TEST(IgesFreeFormat, HollerithStringsMayHoldDelimitersAndBlanks) {
  const Scanned scanned = scan("406,1,10Ha,b;c 1H, ,0H,3H   , 2H;;;");
  EXPECT_EQ(scanned.tokens, (Tokens{"406", "1", "10Ha,b;c 1H, ", "0H", "3H   ", "2H;;"}));
  EXPECT_EQ(scanned.end.wrong_counts, 0);
  EXPECT_EQ(parse_text("10Ha,b;c 1H, "), "a,b;c 1H, ");
  EXPECT_EQ(parse_text("0H"), "");
  EXPECT_EQ(parse_text("3H   "), "   ");
  EXPECT_EQ(parse_text("abc"), std::nullopt);
  EXPECT_EQ(parse_text("H"), std::nullopt);
  EXPECT_EQ(parse_text("12"), std::nullopt);
}

TEST(IgesFreeFormat, WrongHollerithCountsEndAtADelimiter) {
  const auto texts = [](std::string_view record) {
    const Scanned scanned = scan(record);
    EXPECT_EQ(scanned.end.wrong_counts, 1) << record;
    return scanned.tokens;
  };
  EXPECT_EQ(texts("406,3HWhole,7;"), (Tokens{"406", "3HWhole", "7"}));
  EXPECT_EQ(texts("406,6HPart,12.5,7;"), (Tokens{"406", "6HPart", "12.5", "7"}));
  EXPECT_EQ(texts("406,99HPart,12.5;"), (Tokens{"406", "99HPart", "12.5"}));
  EXPECT_EQ(texts("406,99999999999999999999999HPart;"), (Tokens{"406", "99999999999999999999999HPart"}));
  EXPECT_EQ(texts("406,9HPart;"), (Tokens{"406", "9HPart"}));
  EXPECT_EQ(texts("406,15HSize, in metres too,7;"), (Tokens{"406", "15HSize, in metres too", "7"}));
}

TEST(IgesFreeFormat, HollerithCountsMayBeOfCharactersOrBytes) {
  EXPECT_EQ(scan("406,5HFl\xC3\xBCgel,7;").tokens.size(), 3U);
  EXPECT_EQ(scan("406,6HFl\xC3\xBCgel,7;").end.wrong_counts, 0);
  EXPECT_EQ(scan("406,7HFl\xC3\xBCgel,7;").end.wrong_counts, 0);
  EXPECT_EQ(scan("406,6HFl\xC3\xBCgel,7;").tokens.back(), "7");
}

TEST(IgesFreeFormat, TextsAreUtf8WhateverTheFileHolds) {
  EXPECT_EQ(to_utf8("plain"), "plain");
  EXPECT_EQ(to_utf8("Fl\xC3\xBCgel"), "Fl\xC3\xBCgel");
  EXPECT_EQ(to_utf8("Fl\xFCgel"), "Fl\xC3\xBCgel");
  EXPECT_EQ(to_utf8(std::string_view("a\0b\tc\x7F", 6)), "a b c ");
  // Overlong, a surrogate, beyond Unicode, cut off: Latin-1.
  for (const char* bytes : {"\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82"}) {
    EXPECT_EQ(to_utf8(bytes).size(), 2 * std::string_view(bytes).size());
  }
}

}  // namespace
}  // namespace isorim::io::iges
