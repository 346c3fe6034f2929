#include "io/fit/point_table.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

using geometry::Point3;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    parse_points(text, "p.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParsePoints, TakesEverySeparator) {
  for (const std::string text : {"1,2\n3.5,-4e-1\n", "1;2\r\n3.5;-4e-1\r\n", "1\t2\n3.5\t-4e-1",
                                 "  1   2\n3.5 -4e-1  \n", "1, 2\n3.5, -4e-1\n", "1;2;\n+3.5;-4e-1;\n",
                                 "\xEF\xBB\xBF"
                                 "1,2\n3.5,-.4\n"}) {
    SCOPED_TRACE(text);
    const PointTable table = parse_points(text, "p.csv");
    ASSERT_EQ(table.points.cols(), 2);
    EXPECT_EQ(table.points.col(0), Point3(1.0, 2.0, 0.0));
    EXPECT_EQ(table.points.col(1), Point3(3.5, -0.4, 0.0));
    EXPECT_FALSE(table.has_z);
    EXPECT_TRUE(table.weights.empty());
  }
}

TEST(ParsePoints, PassesOverCommentsAndCountsTheirLines) {
  const PointTable table = parse_points("# a section\n\n1 2\n% more\n// and more\n3 4\n", "p.csv");
  EXPECT_THAT(table.lines, ElementsAre(3, 6));
}

TEST(ParsePoints, ColumnsByNumberAndByName) {
  EXPECT_TRUE(parse_points("1,2,3.5\n", "p.csv").has_z);
  EXPECT_THAT(parse_points("1,2,3,0.5\n", "p.csv").weights, ElementsAre(0.5));
  const PointTable named = parse_points("\"Weight\";name;Y [mm];x (mm)\n2;a;20;10\n3;b;40;30\n", "p.csv");
  EXPECT_EQ(named.points.col(1), Point3(30.0, 40.0, 0.0));
  EXPECT_THAT(named.weights, ElementsAre(2.0, 3.0));
  EXPECT_FALSE(named.has_z);
  EXPECT_TRUE(parse_points("x,y,z\n1,2,3\n", "p.csv").has_z);
}

TEST(ParsePoints, RefusesDecimalCommasWithFileAndLine) {
  for (const std::string text :
       {"1,5;2,5\n", "1,5\t2,5\n", "1,5 2,5\n", "1,5,2,5\n3,0,4,1\n", "x;y\n1,5;2\n", "x,y\n1,5,2,5\n", "1,5, 2,5\n"}) {
    SCOPED_TRACE(text);
    const int line = text.starts_with('x') ? 2 : 1;
    EXPECT_THAT(refusal(text), HasSubstr("p.csv:" + std::to_string(line) + ": "));
    EXPECT_THAT(refusal(text), HasSubstr("decimal commas"));
  }
  // Whole numbers with a point somewhere are what they are.
  EXPECT_EQ(refusal("1,2,3,4\n1,2,3,4.0\n"), "");
}

TEST(ParsePoints, RefusesWhatIsNoTableOfPoints) {
  EXPECT_THAT(refusal(""), HasSubstr("p.csv: found no points"));
  EXPECT_THAT(refusal("# nothing\nx,y\n"), HasSubstr("p.csv: found no points"));
  EXPECT_THAT(refusal("1,2\n3,abc\n"), HasSubstr("p.csv:2: found \"abc\"; expected a number"));
  EXPECT_THAT(refusal("1,2\n3,\n"), HasSubstr("p.csv:2: found 1 column(s); expected 2"));
  EXPECT_THAT(refusal("1,2\n3,4,5\n"), HasSubstr("p.csv:2: found 3 column(s); expected 2"));
  EXPECT_THAT(refusal("1,2\nnan,4\n"), HasSubstr("p.csv:2: found \"nan\""));
  EXPECT_THAT(refusal("1\n2\n"), HasSubstr("p.csv:1: found 1 number(s)"));
  EXPECT_THAT(refusal("1 2 3 4 5\n"), HasSubstr("found 5 number(s)"));
  EXPECT_THAT(refusal("a,b\n1,2\n"), HasSubstr("p.csv:1: found the columns \"a,b\"; expected x and y"));
  EXPECT_THAT(refusal("x,x,y\n1,2,3\n"), HasSubstr("two columns \"x\""));
  EXPECT_THAT(refusal("x,y,w\n1,2,0\n"), HasSubstr("p.csv:2: found the weight 0"));
  EXPECT_THAT(refusal("x,y\n1,2,3\n"), HasSubstr("p.csv:2: found 3 column(s); expected 2"));
}

TEST(ParseWeights, OneColumn) {
  EXPECT_THAT(parse_weights("weight\n1\n2.5\n", "w.csv"), ElementsAre(1.0, 2.5));
  const auto message = [](const std::string& text) {
    try {
      parse_weights(text, "w.csv");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("1\n2,5\n"), HasSubstr("w.csv:2: "));
  EXPECT_THAT(message("1\n2,5\n"), HasSubstr("decimal commas"));
  EXPECT_THAT(message("1\n-1\n"), HasSubstr("w.csv:2: found the weight -1"));
  EXPECT_THAT(message("1 2\n"), HasSubstr("found 2 numbers; expected one weight"));
}

}  // namespace
}  // namespace isorim::io
