#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/bad_case.h"

/// Shapes fitted to points, as users meet them.
namespace isorim::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double pi = std::numbers::pi;

/// Points of a circle, one a line.
std::string circle(int count, double radius, const std::string& more = "", double from = 0.0) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const double angle = from + 2.0 * pi * i / count;
    text += fmt::format("{},{}{}\n", radius * std::cos(angle), radius * std::sin(angle), more);
  }
  return text;
}

class Fit : public ProgramTest {
 protected:
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out/results.json")); }
};

TEST_F(Fit, ARegionWithItsProperties) {
  write("circle.csv", circle(40, 2.0));
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'fit'\npoints = 'circle.csv'\ncontrol_points = 20\n"
      "[expect]\narea = { value = 12.566370614359172, rtol = 1e-4 }\nmax_distance = { value = 0, atol = 1e-3 }\n"
      "control_points = { value = 20 , atol = 0}\n");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("40 points"), HasSubstr("max distance"), HasSubstr("3 expectations of 3")));
  const nlohmann::json fit = results()["fit"];
  EXPECT_EQ(fit["control_points"], 20);
  EXPECT_LT(fit["max_distance"], 1e-3);
  EXPECT_LE(fit["rms_distance"], fit["max_distance"]);
  EXPECT_NEAR(fit["bending_energy"], 4.0 * pi * pi, 0.01);
  EXPECT_EQ(fit["curvature_sign_changes"], 0);
  EXPECT_GT(fit["seconds"], 0.0);
  // The worst point is one of the points given, and as far from the curve as is said.
  const std::vector<double> place = fit["worst_point"]["place"];
  EXPECT_NEAR(std::hypot(place[0], place[1]), 2.0, 1e-12);
  EXPECT_EQ(fit["worst_point"]["distance"], fit["max_distance"]);
}

TEST_F(Fit, WritesDrawingAndErrorTable) {
  write("circle.csv", circle(30, 2.0));
  ASSERT_EQ(run_case("[geometry]\ntype = 'fit'\npoints = 'circle.csv'\ncontrol_points = 10\n").status, 0);
  const std::string svg = read_file(folder() / "out/fit.svg");
  for (const char* part : {"class=\"data\"", "class=\"comb\"", "class=\"control polygon\"", "class=\"curves\""}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
  const std::string table = read_file(folder() / "out/fit_points.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 31);
  EXPECT_TRUE(fs::exists(folder() / "out/boundary.vtu"));
}

TEST_F(Fit, AToleranceIsMetOrReported) {
  write("circle.csv", circle(60, 2.0));
  const std::string text = "[geometry]\ntype = 'fit'\npoints = 'circle.csv'\n";
  ASSERT_EQ(run_case(text + "tolerance = 1e-3\n").status, 0);
  EXPECT_LE(results()["fit"]["max_distance"], 1e-3);
  EXPECT_EQ(results()["fit"]["tolerance_met"], true);
}

TEST_F(Fit, OpenCurvesHaveALengthAlone) {
  write("arc.csv", "0 0\n1 0.5\n2 0.8\n3 0.9\n4 0.8\n5 0.5\n6 0\n");
  const ProgramResult result =
      run_case("[geometry]\ntype = 'fit'\npoints = 'arc.csv'\nclosed = false\ncontrol_points = 5\n");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no area"));
  EXPECT_NEAR(results()["properties"]["perimeter"]["value"], 6.34, 0.05);
}

TEST_F(Fit, CloudsAreReducedAndOrdered) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(0.0, 2.0 * pi);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::string text;
  for (int i = 0; i < 8000; ++i) {
    const double t = angle(random);
    const double radius = i % 4 == 0 ? 0.5 : 1.0;
    text += fmt::format("{},{}\n", radius * std::cos(t) + noise(random), radius * std::sin(t) + noise(random));
  }
  write("cloud.csv", text + "5,5\n");
  for (const std::string cell : {"", "cell = [0.04, 0.04]\n"}) {
    SCOPED_TRACE(cell);
    const ProgramResult result = run_case("[geometry]\ntype = 'fit'\npoints = 'cloud.csv'\norder = 'contours'\n" +
                                          cell + "control_points = 10\nweights = 'counts'\n");
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json json = results();
    EXPECT_EQ(json["fit"]["curves"].size(), 2U);
    EXPECT_EQ(json["fit"]["points"]["read"], 8001);
    EXPECT_GE(json["fit"]["dropped"]["outlier"], 1);
    EXPECT_NEAR(json["properties"]["area"]["value"], 0.75 * pi, 0.01);
  }
  const ProgramResult density = run_case(
      "[geometry]\ntype = 'fit'\npoints = 'cloud.csv'\norder = 'density'\ncell = [0.1, 0.1]\ncontrol_points = 10\n");
  ASSERT_EQ(density.status, 0) << density.err;
  EXPECT_GT(results()["fit"]["dropped"]["not reached"], 1000);
  EXPECT_NEAR(results()["properties"]["area"]["value"], pi, 0.1);
}

TEST_F(Fit, SectionsMakeABody) {
  for (int k = 0; k < 4; ++k) {
    write(fmt::format("s{}.csv", k), circle(48, 1.0 + 0.5 * k, "", 0.3 * k));
    write(fmt::format("t{}.csv", k), circle(48, 1.0 + 0.5 * k, fmt::format(",{}", k), 0.3 * k));
  }
  // Frusta of a cone, radii 1 to 2.5 over a height of 3.
  const double exact = pi * (1.0 + 2.5 + 6.25);
  const std::string more =
      "control_points = 16\n[expect]\nvolume = { value = " + fmt::format("{}", exact) + ", rtol = 1e-3 }\n";
  const ProgramResult heights = run_case(
      "[geometry]\ntype = 'fit'\nsections = ['s0.csv', 's1.csv', 's2.csv', 's3.csv']\nheights = [0, 1, 2, 3]\n" + more);
  EXPECT_EQ(heights.status, 0) << heights.err << heights.out;
  EXPECT_EQ(results()["fit"]["body"]["sections"], 4);
  // Sections that start in corresponding points share their knots.
  EXPECT_EQ(results()["fit"]["body"]["control_points_along"], 19);
  EXPECT_TRUE(results()["geometry"]["closed"]);
  const ProgramResult space =
      run_case("[geometry]\ntype = 'fit'\nsections = ['t0.csv', 't1.csv', 't2.csv', 't3.csv']\n" + more);
  EXPECT_EQ(space.status, 0) << space.err << space.out;
  EXPECT_LT(results()["fit"]["body"]["off_plane"], 1e-12);
}

TEST_F(Fit, SlicesOfACloudMakeABodyWithTips) {
  std::string cloud = "x,y,z\n";
  for (int k = -9; k <= 9; ++k) {
    const double z = 0.1 * k;
    cloud += circle(60, std::sqrt(1.0 - z * z), fmt::format(",{}", z), 0.1 * k);
  }
  write("cloud.csv", cloud);
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'fit'\npoints = 'cloud.csv'\nslices = { thickness = 0.1 }\norder = 'contours'\n"
      "control_points = 12\nstart_tip = [0, 0, -1]\nend_tip = [0, 0, 1]\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(results()["geometry"]["patches"], 1);
  EXPECT_NEAR(results()["properties"]["volume"]["value"], 4.0 / 3.0 * pi, 0.005);
}

TEST_F(Fit, BranchingBodiesAreRefusedByName) {
  std::string cloud;
  for (int k = 0; k < 3; ++k) {
    cloud += circle(60, 1.0, fmt::format(",{}", k));
    if (k == 2) cloud += circle(30, 0.4, ",2.0");
  }
  write("cloud.csv", cloud);
  const ProgramResult result =
      run_case("[geometry]\ntype = 'fit'\npoints = 'cloud.csv'\nslices = { thickness = 1 }\norder = 'contours'\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("the body branches: section 2 (z = 1) has 1 loop(s), section 3 (z = 2) has 2"));
}

TEST_F(Fit, FilesThatAreAtFaultAreNamedWithTheirLine) {
  const std::string text = "[geometry]\ntype = 'fit'\npoints = 'p.csv'\ncontrol_points = 6\n";
  const auto refusal = [&](const std::string& points, const std::string& more = "") {
    write("p.csv", points);
    const ProgramResult result = run_case(text + more);
    EXPECT_EQ(result.status, 2) << result.out;
    EXPECT_FALSE(fs::exists(folder() / "out"));
    EXPECT_THAT(result.err, HasSubstr("case.toml:1: geometry: "));
    return result.err;
  };
  EXPECT_THAT(refusal("0;0\n1,5;2\n"), AllOf(HasSubstr("p.csv:2: "), HasSubstr("decimal commas")));
  EXPECT_THAT(refusal("0,0\n1,zwei\n"), HasSubstr("p.csv:2: found \"zwei\""));
  EXPECT_THAT(refusal(""), HasSubstr("p.csv: found no points"));
  EXPECT_THAT(refusal("0,0\n1,0\n0,1\n"), HasSubstr("contour: "));
  EXPECT_THAT(refusal("1,1\n1,1\n1,1\n"), HasSubstr("contour: "));
  EXPECT_THAT(refusal("0,0,0\n1,0,0\n1,1,1\n0,1,1\n"), HasSubstr("found z from 0 to 1"));
  write("w.csv", "1\n2\n");
  EXPECT_THAT(refusal(circle(12, 1.0), "weights = 'w.csv'\n"), HasSubstr("found 2 weights for 12 points"));
  EXPECT_THAT(refusal(circle(12, 1.0), "weights = 'curvatur'\n"), HasSubstr("cannot open"));
  EXPECT_THAT(refusal(circle(12, 1.0, ",0,2"), "order = 'contours'\n"), HasSubstr("found weights of single points"));
  EXPECT_THAT(refusal("0,0\n9,9\n5,1\n0,7\n", "order = 'contours'\n"), HasSubstr("no group of at least 6 points"));
}

TEST_F(Fit, SectionsThatAreAtFaultAreNamed) {
  write("a.csv", circle(20, 1.0, ",0"));
  write("flat.csv", circle(20, 1.0));
  write("line.csv", "0,0,1\n1,0,1\n2,0,1\n3,0,1\n4,0,1\n");
  write("bent.csv", "0,0,1\n1,0,1\n1,1,2\n0,1,1\n-1,1,1\n-1,0,1\n");
  const auto refusal = [&](const std::string& other, const std::string& more = "") {
    const ProgramResult result =
        run_case("[geometry]\ntype = 'fit'\nsections = ['a.csv', '" + other + "']\ncontrol_points = 6\n" + more);
    EXPECT_EQ(result.status, 2) << result.out;
    return result.err;
  };
  EXPECT_THAT(refusal("flat.csv"), AllOf(HasSubstr("flat.csv"), HasSubstr("expected x, y, z, or the key \"heights\"")));
  EXPECT_THAT(refusal("line.csv"), AllOf(HasSubstr("line.csv"), HasSubstr("lie on a line")));
  EXPECT_THAT(refusal("bent.csv"), AllOf(HasSubstr("bent.csv"), HasSubstr("from the plane of the section")));
  EXPECT_THAT(refusal("none.csv"), HasSubstr("none.csv"));
  EXPECT_THAT(refusal("flat.csv", "heights = [0, 1]\n"), HasSubstr("\"heights\" are for files of x, y alone"));
  EXPECT_THAT(refusal("a.csv"), HasSubstr("coincide"));
}

class BadFit : public BadCaseTest {};

TEST_P(BadFit, IsRefusedWithStatus2AndNothingWritten) {
  expect_refusal();
}

BadCase bad(const std::string& name, const std::string& keys, const std::vector<std::string>& fragments) {
  return {name, "[geometry]\ntype = 'fit'\n" + keys + "\n", fragments};
}

INSTANTIATE_TEST_SUITE_P(
    Keys, BadFit,
    ::testing::Values(
        bad("NoPoints", "", {"found neither; expected exactly one of \"points\" and \"sections\""}),
        bad("BothSources", "points = 'a'\nsections = ['b']", {"found both; expected exactly one"}),
        bad("NoSuchFile", "points = 'nowhere.csv'", {"case.toml:1: geometry: ", "nowhere.csv"}),
        bad("PointsNoText", "points = 3", {"geometry.points: found the integer 3"}),
        bad("BothCounts", "points = 'a'\ncontrol_points = 9\ntolerance = 0.1", {"both \"control_points\" and"}),
        bad("FewControlPoints", "points = 'a'\ncontrol_points = 3", {"control_points = 3 for degree 3"}),
        bad("ControlPointsReal", "points = 'a'\ncontrol_points = 9.5", {"geometry.control_points: found"}),
        bad("ToleranceZero", "points = 'a'\ntolerance = 0", {"geometry.tolerance: found 0"}),
        bad("DegreeZero", "points = 'a'\ndegree = 0", {"geometry.degree: found 0"}),
        bad("ClosedText", "points = 'a'\nclosed = 'yes'", {"geometry.closed: found the text \"yes\""}),
        bad("Method", "points = 'a'\nmethod = 'fre'", {"geometry.method: found", "(did you mean \"free\"?)"}),
        bad("PereiraOpen", "points = 'a'\nmethod = 'pereira'\nclosed = false", {"closed curves of degree 3 alone"}),
        bad("Parameters", "points = 'a'\nparameters = 'arc'", {"geometry.parameters: found"}),
        bad("Knots", "points = 'a'\nknots = 'random'", {"geometry.knots: found"}),
        bad("Corrections", "points = 'a'\ncorrections = -1", {"geometry.corrections: found -1"}),
        bad("KnotSteps", "points = 'a'\nknot_steps = -1", {"geometry.knot_steps: found -1"}),
        bad("PeakSteps", "points = 'a'\npeak_steps = 1.5", {"geometry.peak_steps: found"}),
        bad("Fairness", "points = 'a'\nfairness = -1", {"geometry.fairness: found -1"}),
        bad("CornerAngle", "points = 'a'\ncorner_angle = 200", {"geometry.corner_angle: found 200"}),
        bad("Order", "points = 'a'\norder = 'sorted'", {"geometry.order: found"}),
        bad("CellWithoutOrder", "points = 'a'\ncell = [1, 1]", {"found \"cell\""}),
        bad("CellZero", "points = 'a'\norder = 'density'\ncell = [1, 0]", {"geometry.cell"}),
        bad("CountsWithoutOrder", "points = 'a'\nweights = 'counts'", {"found weights = \"counts\""}),
        bad("LargestGap", "points = 'a'\nlargest_gap = 2", {"geometry.largest_gap: found 2"}),
        bad("LeastPoints", "points = 'a'\nleast_points = 1", {"geometry.least_points: found 1"}),
        bad("Reach", "points = 'a'\nreach = 0", {"geometry.reach: found 0"}),
        bad("SlicesOfSections", "sections = ['a']\nslices = { thickness = 1 }", {"found \"slices\" beside"}),
        bad("SlicesAsGiven", "points = 'a'\nslices = { thickness = 1 }", {"found \"slices\" with points as given"}),
        bad("SliceThickness", "points = 'a'\norder = 'contours'\nslices = { thickness = 0 }", {"thickness: found 0"}),
        bad("SliceAxis", "points = 'a'\norder = 'contours'\nslices = { axis = 'w', thickness = 1 }", {"axis: found"}),
        bad("NoThickness", "points = 'a'\norder = 'contours'\nslices = { axis = 'x' }", {"\"thickness\" (real) is"}),
        bad("Heights", "sections = ['a', 'b']\nheights = [1]", {"found 1 heights for 2 sections"}),
        bad("TipOfRegion", "points = 'a'\nend_tip = [0, 0, 1]", {"found a key of bodies"}),
        bad("TipOfRing", "sections = ['a']\nends = 'closed'\nend_tip = [0, 0, 1]", {"a closed body has no tips"}),
        bad("EvenRing", "sections = ['a']\nends = 'closed'\ndegree_across = 2", {"closed bodies need an odd one"}),
        bad("OpenSections", "sections = ['a']\nclosed = false", {"the sections of a body are closed"}),
        bad("Ends", "sections = ['a']\nends = 'open'", {"geometry.ends: found"}),
        bad("Start", "sections = ['a']\nstart = 'here'", {"geometry.start: found"}),
        bad("Uniformisation", "sections = ['a']\nuniformisation = 'all'", {"geometry.uniformisation: found"}),
        bad("InsertedKnots", "sections = ['a']\ninserted_knots = 0", {"geometry.inserted_knots: found 0"}),
        bad("RemovalTolerance", "sections = ['a']\nremoval_tolerance = -1", {"geometry.removal_tolerance: found -1"}),
        bad("UnknownKey", "points = 'a'\ncontrolpoints = 9", {"(did you mean \"control_points\"?)"})),
    bad_case_name);

}  // namespace
}  // namespace isorim::testing
