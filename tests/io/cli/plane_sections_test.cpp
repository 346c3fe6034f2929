#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/case/case_file.h"
#include "io/iges/reader.h"
#include "tests/io/cli/bad_case.h"
#include "tests/io/cli/program_test.h"

/// [[section]] in case files.
namespace isorim::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class PlaneSections : public ProgramTest {};

const std::string sphere = "[geometry]\ntype = 'sphere'\nradius = 1\n";
const std::string torus = "[geometry]\ntype = 'torus'\nmajor_radius = 2\nminor_radius = 0.5\n";

TEST_F(PlaneSections, AreInTheResultsAndFiles) {
  const ProgramResult result = run_case(torus +
                                        "[[section]]\nname = 'level'\nnormal = [0, 0, 2]\nfrom = 0\nto = 0.5\n"
                                        "step = 0.25\n[[section]]\nname = 'end'\npoint = [1, 0, 0]\n"
                                        "normal = [1, 0, 0]\noffsets = [1.5]\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1 curve of contact"));
  EXPECT_THAT(result.out, HasSubstr("1 point of contact"));
  const auto json = nlohmann::json::parse(read_file(folder() / "out/results.json"));
  const auto& planes = json.at("sections").at("level").at("planes");
  ASSERT_EQ(planes.size(), 3U);
  EXPECT_EQ(planes[1].at("offset"), 0.25);
  EXPECT_NEAR(planes[1].at("area").at("value").get<double>(), 8.0 * M_PI * std::sqrt(3.0 / 16.0), 1e-12);
  EXPECT_NEAR(planes[1].at("centroid")[2].get<double>(), 0.25, 1e-15);
  ASSERT_EQ(planes[1].at("loops").size(), 2U);
  const bool first_is_hole = planes[1].at("loops")[0].at("hole");
  const auto& hole = planes[1].at("loops")[first_is_hole ? 0 : 1];
  EXPECT_NEAR(hole.at("length").get<double>(), 2.0 * M_PI * (2.0 - std::sqrt(3.0 / 16.0)), 1e-9);
  EXPECT_EQ(hole.at("parent"), first_is_hole ? 1 : 0);
  EXPECT_TRUE(hole.at("spline").at("periodic"));
  EXPECT_EQ(planes[2].at("touching").size(), 1U);
  EXPECT_NEAR(planes[2].at("touching")[0].at("length").get<double>(), 4.0 * M_PI, 1e-9);
  const auto& end = json.at("sections").at("end").at("planes")[0];
  EXPECT_EQ(end.at("isolated")[0].at("point"), nlohmann::json({2.5, 0.0, 0.0}));
  EXPECT_EQ(end.at("isolated")[0].at("patch"), "torus");
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder() / "out"))
    if (entry.path().filename().string().starts_with("section_")) files.insert(entry.path().filename().string());
  EXPECT_THAT(files, UnorderedElementsAre("section_end.csv", "section_end.svg", "section_level.csv",
                                          "section_level.igs", "section_level.svg", "section_level.vtu",
                                          "section_level_1.svg", "section_level_2.svg", "section_level_3.svg"));
}

TEST_F(PlaneSections, WritePointsOnTheSurface) {
  ASSERT_EQ(run_case(torus + "[[section]]\nname = 'a'\nnormal = [1, 2, 3]\noffsets = [0.1, 0.2]\n").status, 0);
  std::istringstream csv(read_file(folder() / "out/section_a.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "offset,kind,curve,x,y,z,plane_x,plane_y,tangent_x,tangent_y,tangent_z,patch,element,u,v");
  int rows = 0;
  while (std::getline(csv, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 15U);
    const double x = std::stod(fields[3]);
    const double y = std::stod(fields[4]);
    const double z = std::stod(fields[5]);
    EXPECT_NEAR((x + 2.0 * y + 3.0 * z) / std::sqrt(14.0), std::stod(fields[0]), 1e-14);
    EXPECT_NEAR(std::hypot(std::hypot(x, y) - 2.0, z), 0.5, 1e-14);
    EXPECT_EQ(fields[11], "\"torus\"");
    ++rows;
  }
  EXPECT_GT(rows, 100);
}

/// The curves in space come back from the IGES file.
TEST_F(PlaneSections, WriteIgesCurves) {
  ASSERT_EQ(run_case(sphere + "[[section]]\nname = 'a'\nnormal = [0, 0, 1]\noffsets = [0.6, -0.6]\n").status, 0);
  const io::CadModel model = io::read_iges(folder() / "out/section_a.igs");
  ASSERT_EQ(model.curves.size(), 2U);
  for (const io::CadCurve& found : model.curves) {
    const geometry::NurbsCurve<3>& curve = found.curve;
    for (const double s : {0.0, 0.3, 0.9}) {
      const geometry::Interval domain = curve.domain();
      const geometry::Point3 x = evaluate(curve, domain.first + s * domain.length());
      EXPECT_NEAR(x.norm(), 1.0, 3e-8);
      EXPECT_NEAR(std::abs(x.z()), 0.6, 1e-14);
    }
  }
}

TEST_F(PlaneSections, MayBeExpected) {
  const std::string text =
      sphere + "[[section]]\nname = 'a'\nnormal = [0, 0, 1]\nfrom = 0\nto = 0.6\ncount = 2\n[expect]\n";
  EXPECT_EQ(run_case(text + "'a.area' = { value = [3.141592653589793, 2.0106192982974678], rtol = 1e-14 }\n").status,
            0);
  EXPECT_EQ(run_case(text + "'a.area' = { value = [3.141592653589793, 2.1], rtol = 1e-3 }\n").status, 1);
  const ProgramResult short_list = run_case(text + "'a.area' = { value = 3.1, rtol = 1 }\n");
  EXPECT_EQ(short_list.status, 2);
  EXPECT_THAT(short_list.err, HasSubstr("expected a list of 2 reals"));
}

TEST_F(PlaneSections, PlanesThatMissAreNoError) {
  const ProgramResult result = run_case(sphere + "[[section]]\nname = 'a'\nnormal = [0, 0, 1]\noffsets = [3]\n");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("nothing"));
  const auto json = nlohmann::json::parse(read_file(folder() / "out/results.json"));
  EXPECT_EQ(json["sections"]["a"]["planes"][0]["status"], "empty");
}

TEST(SectionOffsets, MeetTheirEnds) {
  io::PlaneSectionKeys keys;
  EXPECT_EQ(section_offsets(keys), std::vector<double>{0.0});
  keys.from = 0.0;
  keys.to = 0.3;
  keys.step = 0.1;
  EXPECT_EQ(section_offsets(keys), (std::vector<double>{0.0, 0.1, 0.2, 0.3}));
  keys.to = 0.35;
  EXPECT_EQ(section_offsets(keys).size(), 4U);
  keys.step.reset();
  keys.count = 3;
  EXPECT_EQ(section_offsets(keys), (std::vector<double>{0.0, 0.175, 0.35}));
}

class BadSection : public BadCaseTest {};

TEST_P(BadSection, IsRefused) {
  expect_refusal();
}

std::string section(const std::string& keys) {
  return sphere + "[[section]]\n" + keys;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSection,
    ::testing::Values(
        BadCase{"Plane",
                "[geometry]\ntype = 'circle'\nradius = 1\n[[section]]\nname = 'a'\nnormal = [0, 0, 1]\n",
                {"plane sections are for solids"}},
        BadCase{"NoNormal", section("name = 'a'\n"), {"\"normal\"", "is missing"}},
        BadCase{"ZeroNormal", section("name = 'a'\nnormal = [0, 0, 0]\n"), {"the normal is zero"}},
        BadCase{"ShortNormal", section("name = 'a'\nnormal = [0, 1]\n"), {"found 2 coordinates; expected 3"}},
        BadCase{"ShortPoint",
                section("name = 'a'\nnormal = [0, 0, 1]\npoint = [0]\n"),
                {"section[1].point", "expected a list of coordinates"}},
        BadCase{"Name", section("name = 'a b'\nnormal = [0, 0, 1]\n"), {"expected letters, digits, _ and -"}},
        BadCase{"Both",
                section("name = 'a'\nnormal = [0, 0, 1]\noffsets = [1]\nfrom = 0\nto = 1\nstep = 1\n"),
                {"both \"offsets\" and a range"}},
        BadCase{"HalfARange", section("name = 'a'\nnormal = [0, 0, 1]\nfrom = 0\n"), {"either \"step\" or \"count\""}},
        BadCase{"StepAndCount",
                section("name = 'a'\nnormal = [0, 0, 1]\nfrom = 0\nto = 1\nstep = 1\ncount = 2\n"),
                {"either \"step\" or \"count\""}},
        BadCase{"Backwards",
                section("name = 'a'\nnormal = [0, 0, 1]\nfrom = 1\nto = 0\nstep = 0.1\n"),
                {"from = 1 above to = 0"}},
        BadCase{"TooMany",
                section("name = 'a'\nnormal = [0, 0, 1]\nfrom = 0\nto = 1\nstep = 1e-9\n"),
                {"more than 100000"}},
        BadCase{"OneBetweenTwo",
                section("name = 'a'\nnormal = [0, 0, 1]\nfrom = 0\nto = 1\ncount = 1\n"),
                {"found 1 plane"}},
        BadCase{"NoStep", section("name = 'a'\nnormal = [0, 0, 1]\nfrom = 0\nto = 1\nstep = 0\n"), {"> 0"}},
        BadCase{"Twice",
                section("name = 'a'\nnormal = [0, 0, 1]\n[[section]]\nname = 'a'\nnormal = [0, 0, 1]\n"),
                {"the name \"a\" is taken by another section"}},
        BadCase{"Unknown",
                section("name = 'a'\nnormal = [0, 0, 1]\n[expect]\n'a.aera' = { value = 1, rtol = 1 }\n"),
                {"\"a.aera\"", "did you mean \"a.area\""}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace isorim::testing
