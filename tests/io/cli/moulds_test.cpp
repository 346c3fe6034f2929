#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string ball = "[geometry]\ntype = \"sphere\"\nradius = 3.0\n[output]\nvtk = false\nhdf5 = false\n";

class Moulds : public ProgramTest {};

TEST_F(Moulds, OfAnySolidAreWritten) {
  const auto result = run_case(ball + "[drawings]\nunit = \"cm\"\n[moulds]\nboard_thickness = 2.0\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("moulds: 4 boards of 20 mm, z = -40 to 40 mm"));
  EXPECT_THAT(result.err, HasSubstr("the plane z = -40 mm does not meet the body"));
  const std::string table = read_file(folder() / "out/moulds.csv");
  EXPECT_THAT(table, HasSubstr("\n2,-20,0,1570.7963,2827.4334,"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/moulds/004.svg"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out/moulds/005.svg"));
  EXPECT_THAT(read_file(folder() / "out/moulds.dxf"), HasSubstr("CORTE-20_"));
  EXPECT_THAT(read_file(folder() / "out/moulds.pdf"), HasSubstr("/Count 4"));
  // Warnings are results, too.
  EXPECT_THAT(read_file(folder() / "out/results.json"), HasSubstr("4 boards of 20 mm"));
}

TEST_F(Moulds, OnlyTheFormatsAskedFor) {
  const auto result = run_case(ball + "[drawings]\nformats = [\"dxf\"]\n[moulds]\nheights = [0.0, 1.0]\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/moulds.dxf"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out/moulds.pdf"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out/moulds.svg"));
}

TEST_F(Moulds, ContradictionsAreRefused) {
  const auto refused = [&](const std::string& keys, const std::string& message) {
    const auto result = run_case(ball + keys);
    EXPECT_EQ(result.status, 2) << keys;
    EXPECT_THAT(result.err, HasSubstr(message)) << keys;
  };
  refused("[moulds]\n", "expected either \"board_thickness\", or \"heights\"");
  refused("[moulds]\nboard_thickness = 1.0\nheights = [1.0]\n", "expected either \"board_thickness\"");
  refused("[moulds]\nboard_thickness = 0.0\n", "> 0");
  refused("[moulds]\nheights = [1.0, 1.0]\n", "expected heights that rise");
  refused("[moulds]\nstep = 1.0\nfrom = 0.0\n", "expected \"from\" and \"to\" with \"step\"");
  refused("[moulds]\nstep = 1.0\nfrom = 0.0\nto = -1.0\n", "found from = 0 not below to = -1");
  refused("[moulds]\nstep = 1e-5\nfrom = 0.0\nto = 1.0\n", "more than 5000 sections");
  refused("[moulds]\nheights = [7.0]\n", "moulds: no plane meets the body");
  refused("[drawings]\nformats = [\"dwg\"]\n", "found \"dwg\"; expected \"pdf\", \"svg\" or \"dxf\"");
  refused("[drawings]\nsheets = \"a5\"\n", "\"a4\"");
}

TEST_F(Moulds, OfAPropellerAreItsFirstBladeWithItsOverview) {
  const auto result = run_case(R"(title = "Ka 4-60"
[geometry]
type = "propeller"
series = "kaplan"
diameter = 500.0
blades = 4
area_ratio = 0.6
pitch_ratio = 0.9
transform = { translate = [100.0, 0.0, 50.0] }
[properties]
tolerance = 1e-6
[output]
vtk = false
hdf5 = false
[drawings]
sheets = "a4"
[moulds]
from = 40.0
to = 250.0
step = 70.0
)");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the plane z = 40 mm does not meet the body"));
  EXPECT_THAT(result.err, HasSubstr("the plane z = 250 mm only touches the body: nothing to cut"));
  EXPECT_THAT(result.err, Not(HasSubstr("failed")));
  EXPECT_THAT(read_file(folder() / "out/moulds.dxf"), HasSubstr("CORTE110_parting"));
  EXPECT_THAT(read_file(folder() / "out/overview.dxf"), HasSubstr("expanded outline and sections"));
  EXPECT_THAT(read_file(folder() / "out/overview.pdf"), HasSubstr("row A, column 1, sheet 1 of"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/overview.svg"));
}

}  // namespace
}  // namespace isorim::testing
