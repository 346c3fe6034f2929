#include "io/sweep/csv_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(CsvRows, ReadQuotesBlanksCommentsAndLineEnds) {
  const CsvRows rows = parse_csv(
      "\xef\xbb\xbf# by hand\r\n a, \"b c\" ,d\r\n\r\n1,\"x \"\"y\"\"\nz\", 3 \r\n# no row\n,2,\"\"\n", "t.csv");
  EXPECT_THAT(rows.headings, ElementsAre("a", "b c", "d"));
  EXPECT_THAT(rows.rows, ElementsAre(ElementsAre("1", "x \"y\"\nz", "3"), ElementsAre("", "2", "")));
  EXPECT_THAT(rows.lines, ElementsAre(4, 7));
}

TEST(CsvRows, ReadSemicolonsAndTabs) {
  EXPECT_THAT(parse_csv("a;b\n1,5;2\n", "t").rows, ElementsAre(ElementsAre("1,5", "2")));
  EXPECT_THAT(parse_csv("a\tb,c\n1\t2\n", "t").headings, ElementsAre("a", "b,c"));
  EXPECT_THAT(parse_csv("a\tb\n\t2\n", "t").rows, ElementsAre(ElementsAre("", "2")));
}

TEST(CsvRows, ReadTheLastLineWithoutItsEnd) {
  EXPECT_THAT(parse_csv("a,b\n1,", "t").rows, ElementsAre(ElementsAre("1", "")));
}

TEST(CsvRows, WriteWhatTheyReadBack) {
  for (const std::string text : {"plain", "", "a,b", "\"", "two\nlines", " blank ", "#1", "a;b", "a\tb"}) {
    const CsvRows rows = parse_csv("first," + csv_field("h " + text) + "\nx," + csv_field(text) + "\n", "t");
    EXPECT_THAT(rows.rows, ElementsAre(ElementsAre("x", text)));
    EXPECT_EQ(rows.headings[1], "h " + text);
  }
}

void expect_refused(const std::string& text, const std::string& fragment) {
  EXPECT_THAT([&] { parse_csv(text, "t.csv"); }, ThrowsMessage<InputError>(HasSubstr(fragment))) << text;
}

TEST(CsvRows, RefuseWhatIsNoTable) {
  expect_refused("", "t.csv:1: found no line of headings");
  expect_refused("a,b\n", "found no rows");
  expect_refused("a,b\n1,2\n3\n", "t.csv:3: found 1 fields; expected 2");
  expect_refused("a,\n1,2\n", "found an empty heading");
  expect_refused("a,a\n1,2\n", "found the heading \"a\" twice");
  expect_refused("a,b\n1,\"2\n3,4\n", "t.csv:2: found a quote that is not closed");
  expect_refused("a,b\n1,\"2\"3\n", "t.csv:2: found \"3\" behind a closing quote");
}

}  // namespace
}  // namespace isorim::io
