#include "io/excerpt.h"

#include <string>

#include <gtest/gtest.h>

namespace isorim::io {
namespace {

using std::string_literals::operator""s;

TEST(Excerpt, LeavesShortTextsAsTheyAre) {
  EXPECT_EQ(excerpt(""), "");
  EXPECT_EQ(excerpt("Länge"), "Länge");
  EXPECT_EQ(excerpt(std::string(60, 'a')), std::string(60, 'a'));
}

TEST(Excerpt, ShowsControlCharactersByTheirNumbers) {
  EXPECT_EQ(excerpt("a\0b\x1b[31m\n\x7f"s), "a\\x00b\\x1b[31m\\x0a\\x7f");
}

TEST(Excerpt, CutsBetweenCharacters) {
  EXPECT_EQ(excerpt(std::string(61, 'a')), std::string(60, 'a') + "...");
  EXPECT_EQ(excerpt("aß", 2), "a...");
  EXPECT_EQ(excerpt("aß", 3), "aß");
  EXPECT_EQ(excerpt("\x80\x80\x80", 2), "...");
}

}  // namespace
}  // namespace isorim::io
