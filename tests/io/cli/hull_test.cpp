#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/bad_case.h"

/// Hulls, as users meet them.
namespace isorim::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string series60 = std::string(ISORIM_SOURCE_DIR) + "/cases/hull/series60_cb060.csv";

class Hull : public ProgramTest {
 protected:
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out/results.json")); }
};

TEST_F(Hull, WigleyIsExactAtAnyScale) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'hull'\noffsets = 'wigley'\nscale = { length = 8, beam = 2, draught = 1.5 }\n"
      "[expect]\nvolume = { value = 10.666666666666666, rtol = 1e-13 }\nprismatic = { value = 0.6666666666666667 , "
      "rtol = "
      "1e-13}\n");
  EXPECT_EQ(result.status, 0) << result.err;
  const nlohmann::json hull = results()["hull"];
  EXPECT_EQ(hull["length"], 8.0);
  EXPECT_EQ(hull["after_perpendicular"], -4.0);
  EXPECT_EQ(hull["curvature_sign_changes"], 0);
  EXPECT_LT(hull["offset_distance"], 1e-14);
  EXPECT_TRUE(results()["geometry"]["closed"]);
}

TEST_F(Hull, WhatIsAbsentOfTheScaleFollowsTheLength) {
  const ProgramResult result =
      run_case("[geometry]\ntype = 'hull'\noffsets = 'wigley'\nscale = { length = 10, draught = 1 }\n");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(results()["hull"]["beam"], 1.0);
  EXPECT_EQ(results()["hull"]["draught"], 1.0);
}

TEST_F(Hull, IsDerivedToAPrismaticCoefficient) {
  const ProgramResult result =
      run_case("[geometry]\ntype = 'hull'\noffsets = '" + series60 +
               "'\nshift = { prismatic = 0.65, lcb = -1 }\n"
               "[expect]\nprismatic = { value = 0.65, rtol = 1e-11 }\nlcb = { value = -1, atol "
               "= 1e-9 }\noffset_distance = { value = 0, atol = 1e-13 }\n");
  EXPECT_EQ(result.status, 0) << result.err << result.out;
}

TEST_F(Hull, DrawsItsLinesPlan) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'hull'\noffsets = 'wigley'\nscale = { length = 10 }\n"
      "[lines_plan]\nwaterlines = [0.2, 0.4]\nbuttocks = [0.25]\ndiagonals = [[0.6, 30], [0.5, 60]]\n");
  EXPECT_EQ(result.status, 0) << result.err;
  const std::string svg = read_file(folder() / "out/lines_plan.svg");
  for (const char* text : {"SHEER PLAN", "BODY PLAN", "HALF-BREADTH PLAN", "WL 0.4", "B 0.25", "D2", "1:20"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(read_file(folder() / "out/lines_plan.dxf"), HasSubstr("AC1015"));
  EXPECT_TRUE(read_file(folder() / "out/lines_plan.pdf").starts_with("%PDF"));
  // Waterlines of the table of points follow the formula.
  const std::string points = read_file(folder() / "out/lines.csv");
  std::size_t found = 0;
  for (std::size_t at = points.find("\nwaterline,0.2,"); at != std::string::npos;
       at = points.find("\nwaterline,0.2,", at + 1)) {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    ASSERT_EQ(std::sscanf(points.c_str() + at, "\nwaterline,0.2,1,%lf,%lf,%lf", &x, &y, &z), 3);
    EXPECT_NEAR(z, 0.2, 1e-13);
    EXPECT_NEAR(y, 0.5 * (1.0 - 0.04 * x * x) * (1.0 - (z / 0.625 - 1.0) * (z / 0.625 - 1.0)), 1e-12);
    ++found;
  }
  EXPECT_GT(found, 5u);
}

TEST_F(Hull, LivesInALibrary) {
  const std::string library = path("hulls.h5");
  EXPECT_EQ(run({"hulls", "import", library, series60, "--name", "s60"}).status, 0);
  EXPECT_THAT(run({"hulls", "list", library}).out, AllOf(HasSubstr("s60"), HasSubstr("Series 60"), HasSubstr("25")));
  const ProgramResult again = run({"hulls", "import", library, series60, "--name", "s60"});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("has a hull \"s60\" already"));
  EXPECT_EQ(run({"hulls", "import", library, series60, "--name", "s60", "--replace"}).status, 0);
  EXPECT_EQ(run({"hulls", "export", library, "s60", path("back.csv")}).status, 0);
  EXPECT_THAT(read_file(path("back.csv")), HasSubstr("name,Series 60 Cb 0.60"));
  const ProgramResult from_library = run_case("[geometry]\ntype = 'hull'\noffsets = 's60'\nlibrary = 'hulls.h5'\n");
  EXPECT_EQ(from_library.status, 0) << from_library.err;
  const double prismatic = results()["hull"]["prismatic"];
  EXPECT_EQ(run_case("[geometry]\ntype = 'hull'\noffsets = 'back.csv'\n").status, 0);
  EXPECT_EQ(results()["hull"]["prismatic"], prismatic);
  EXPECT_EQ(run({"hulls", "remove", library, "s60"}).status, 0);
  EXPECT_EQ(run({"hulls", "export", library, "s60", path("back.csv")}).status, 2);
}

TEST_F(Hull, IsFairedWithinATolerance) {
  const std::string library = path("hulls.h5");
  ASSERT_EQ(run({"hulls", "import", library, series60, "--name", "s60"}).status, 0);
  const ProgramResult faired = run({"hulls", "export", library, "s60", path("fair.csv"), "--fair", "0.00025"});
  ASSERT_EQ(faired.status, 0) << faired.err;
  EXPECT_THAT(faired.out, HasSubstr("half-breadths moved, by 0.00025 at most"));
  EXPECT_EQ(run({"hulls", "import", library, path("fair.csv"), "--name", "fair"}).status, 0);
  EXPECT_EQ(run({"hulls", "export", library, "s60", path("bad.csv"), "--fair", "0"}).status, 2);
}

// As in a case: the measures fall, no offset is off by more than what is allowed.
TEST_F(Hull, IsFairedInACase) {
  const std::string hull = "[geometry]\ntype = 'hull'\noffsets = '" + series60 + "'\nscale = { length = 120 }\n";
  ASSERT_EQ(run_case(hull).status, 0);
  const nlohmann::json before = results()["hull"];
  EXPECT_FALSE(before.contains("fairing"));
  const ProgramResult result = run_case(hull + "fair = 0.004\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("faired: "));
  const nlohmann::json after = results()["hull"];
  const nlohmann::json& fairing = after["fairing"];
  EXPECT_EQ(fairing["tolerance"], 0.004);
  EXPECT_GT(fairing["moved"], 50);
  EXPECT_LE(fairing["largest_move"], 0.004 * (1.0 + 1e-12));
  EXPECT_LT(fairing["roughness"], 0.9 * fairing["roughness_before"].get<double>());
  EXPECT_EQ(fairing["bending_energy_before"], before["bending_energy"]);
  const int changes =
      fairing["station_sign_changes_before"].get<int>() + fairing["waterline_sign_changes_before"].get<int>();
  EXPECT_EQ(changes, before["curvature_sign_changes"]);
  EXPECT_LT(after["curvature_sign_changes"], changes);
  // Of the offsets as given from the faired surface.
  EXPECT_GT(after["offset_distance"], 1e-4);
  EXPECT_LE(after["offset_distance"], 0.004 * (1.0 + 1e-9));
  EXPECT_LT(before["offset_distance"], 1e-11);
}

TEST_F(Hull, ALibraryStaysAsItIsWhenAnImportFails) {
  const std::string library = path("hulls.h5");
  ASSERT_EQ(run({"hulls", "import", library, series60, "--name", "s60"}).status, 0);
  const std::string before = read_file(library);
  std::string bad = read_file(series60);
  bad.replace(bad.find("0.831"), 5, "-0.831");
  write(path("bad.csv"), bad);
  const ProgramResult result = run({"hulls", "import", library, path("bad.csv")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("bad.csv:23: column 2 (tangent): found the half-breadth -0.831"),
                                HasSubstr("expected none below 0")));
  EXPECT_EQ(read_file(library), before);
  EXPECT_EQ(run({"hulls", "import", path("none.h5"), path("bad.csv")}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(path("none.h5")));
}

class BadHull : public BadCaseTest {};

TEST_P(BadHull, IsRefused) {
  expect_refusal();
}

const std::string wigley = "[geometry]\ntype = 'hull'\noffsets = 'wigley'\n";
const std::vector<BadCase> bad_hulls{
    {"NoSuchName",
     "[geometry]\ntype = 'hull'\noffsets = 'wigly'\n",
     {"found offsets = \"wigly\"; expected a file (.csv)"}},
    {"NoSuchFile", "[geometry]\ntype = 'hull'\noffsets = 'none.csv'\n", {"none.csv"}},
    {"NoSuchLibrary", wigley + "library = 'none.h5'\n", {"none.h5: there is no such file"}},
    {"FairByNothing", wigley + "fair = 0\n", {"geometry.fair", "found 0"}},
    {"FairByText", wigley + "fair = true\n", {"geometry.fair"}},
    {"NegativeScale", wigley + "scale = { beam = -1 }\n", {"geometry.scale.beam"}},
    {"ImpossibleShift", wigley + "shift = { prismatic = 0.99 }\n", {"would move stations past one another"}},
    {"FlatDiagonal", wigley + "[lines_plan]\ndiagonals = [[1, 90]]\n", {"found a diagonal at 90 degrees"}},
    {"ButtockAmidships", wigley + "[lines_plan]\nbuttocks = [0]\n", {"found a buttock at 0"}},
    {"LinesOfASphere",
     "[geometry]\ntype = 'sphere'\nradius = 1\n[lines_plan]\n",
     {"found a lines plan of a shape that is no hull"}},
};
INSTANTIATE_TEST_SUITE_P(Hulls, BadHull, ::testing::ValuesIn(bad_hulls), bad_case_name);

}  // namespace
}  // namespace isorim::testing
