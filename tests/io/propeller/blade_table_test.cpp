#include "io/propeller/blade_table.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refused(std::string_view text) {
  try {
    parse_blade_table(text, "blade.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(BladeTable, ReadsColumnsByTheirNames) {
  const BladeTableKeys table = parse_blade_table(
      "# a blade\n\nt/D, remark, \"r/R\", c/d, skew\n0.04,1,0.2,0.20,0\n0.02,2,0.6, 0.25 ,+3.5\r\n0.01,3,1,0,1e1\n",
      "x");
  EXPECT_THAT(table.radius_ratio, ElementsAre(0.2, 0.6, 1.0));
  EXPECT_THAT(table.chord_ratio, ElementsAre(0.20, 0.25, 0.0));
  EXPECT_THAT(table.thickness_ratio, ElementsAre(0.04, 0.02, 0.01));
  EXPECT_THAT(table.skew, ElementsAre(0.0, 3.5, 10.0));
  EXPECT_TRUE(table.chord.empty());
}

TEST(BladeTable, TakesOtherSeparators) {
  for (const char separator : {';', '\t', ','}) {
    std::string text = "r/R;chord\n0.2;30\n1;0\n";
    for (char& c : text)
      if (c == ';') c = separator;
    EXPECT_THAT(parse_blade_table(text, "x").chord, ElementsAre(30.0, 0.0));
  }
}

TEST(BladeTable, RefusesWithFileAndLine) {
  EXPECT_THAT(refused("chord,P/D\n1,2\n"), HasSubstr("blade.csv:1: found \"chord,P/D\"; expected a line of names"));
  EXPECT_THAT(refused("0.2,0.3\n"), HasSubstr("\"r/R\" among them; known are r/R, chord, c/D, pitch"));
  EXPECT_THAT(refused("r/R,chord,CHORD\n"), HasSubstr("found the column \"CHORD\" twice"));
  EXPECT_THAT(refused("r/R,chord\n0.2\n"), HasSubstr("blade.csv:2: found 1 columns; expected 2"));
  EXPECT_THAT(refused("r/R;chord\n0.2;\n"), HasSubstr("found \"\" as chord; expected a number"));
  EXPECT_THAT(refused("r/R;chord\n0,2;3\n"), HasSubstr("found \"0,2\" as r/R; expected a number with a decimal point"));
  EXPECT_THAT(refused("r/R,chord\n0.2,inf\n"), HasSubstr("found \"inf\" as chord"));
  EXPECT_THAT(refused("# nothing\n"), HasSubstr("the file is empty"));
}

}  // namespace
}  // namespace isorim::io
