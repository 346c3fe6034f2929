#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/program_test.h"

/// Propellers, as users meet them.
namespace isorim::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kaplan =
    "[geometry]\ntype = 'propeller'\nseries = 'kaplan'\ndiameter = 500\nblades = 4\narea_ratio = 0.6\n"
    "pitch_ratio = 0.9\n";
const std::string coarse = "[properties]\ntolerance = 1e-6\n";

class PropellerCase : public ProgramTest {
 protected:
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out/results.json")); }
};

TEST_F(PropellerCase, TellsAreasVolumesAndControlPoints) {
  const ProgramResult result = run_case(kaplan + "hub_ends = [-60, 70]\n" + coarse +
                                        "[expect]\ncontrol_points_round = { value = 25, atol = 0 }\n"
                                        "hub_volume = { value = 1021017.6124166828, rtol = 1e-12 }\n");
  ASSERT_EQ(result.status, 0) << result.err << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("4 blades, right-handed; 25 x 9 control points a blade"),
                                HasSubstr("expanded_area_ratio"), HasSubstr("blade_volume")));
  const nlohmann::json all = results();
  const nlohmann::json& screw = all["propeller"];
  EXPECT_EQ(screw["asked_area_ratio"], 0.6);
  EXPECT_EQ(screw["areas_outside_radius"], 50.0);
  EXPECT_EQ(screw["control_points"], (std::vector<int>{25, 9}));
  const double volume = all["properties"]["volume"]["value"];
  const double blade = screw["blade_volume"]["value"];
  const double hub = screw["hub_volume"]["value"];
  EXPECT_NEAR(4.0 * blade + hub, volume, 1e-9 * volume);
  EXPECT_EQ(screw["sections"].size(), 9u);
  EXPECT_NEAR(screw["sections"][4]["chord"].get<double>(), 147.675, 1e-9);
  EXPECT_LT(screw["projected_area_ratio"], screw["expanded_area_ratio"]);
}

// What is told of the screw does not change when the case cuts or scales it.
TEST_F(PropellerCase, TellsOfTheWholeScrewWhereTheShapeIsCut) {
  ASSERT_EQ(run_case(kaplan + coarse).status, 0);
  const nlohmann::json whole = results();
  ASSERT_EQ(
      run_case(kaplan + "transform = { scale = 0.5 }\nclip = { point = [0, 0, 10], normal = [0, 0, 1] }\n" + coarse)
          .status,
      0);
  const nlohmann::json cut = results();
  const double volume = whole["propeller"]["blade_volume"]["value"];
  EXPECT_NEAR(cut["propeller"]["blade_volume"]["value"].get<double>(), volume, 1e-9 * volume);
  EXPECT_EQ(cut["propeller"]["expanded_area_ratio"], whole["propeller"]["expanded_area_ratio"]);
  EXPECT_LT(cut["properties"]["volume"]["value"].get<double>(),
            0.2 * whole["properties"]["volume"]["value"].get<double>());
}

TEST_F(PropellerCase, MakesKnotsTheSameAsAsked) {
  ASSERT_EQ(run_case(kaplan + "hub_ratio = 0\nuniformisation = 'merge'\n" + coarse).status, 0);
  EXPECT_EQ(results()["propeller"]["control_points"][0], 193);
  const ProgramResult result =
      run_case(kaplan + "hub_ratio = 0\nuniformisation = 'insert_and_remove'\nremoval_tolerance = 0.1\n" + coarse);
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json screw = results()["propeller"];
  EXPECT_NEAR(screw["control_points"][0].get<int>(), 104, 8);
  EXPECT_EQ(screw["merged_control_points"], 193);
  EXPECT_GT(screw["knots_removed"], 0);
  EXPECT_LE(screw["removal_error"], 0.1);
  EXPECT_THAT(result.out, HasSubstr("(193 if all knots were merged"));
}

TEST_F(PropellerCase, WarnsOutsideTheRangeThatWasTested) {
  const ProgramResult fine = run_case(kaplan + coarse);
  EXPECT_THAT(fine.err, Not(HasSubstr("was tested")));
  const ProgramResult wide = run_case(kaplan + coarse, {"--set", "geometry.area_ratio=0.95"});
  EXPECT_EQ(wide.status, 0);
  EXPECT_THAT(wide.err,
              HasSubstr("the Kaplan series was tested with an area ratio from 0.55 to 0.75; here it is 0.95"));
}

TEST_F(PropellerCase, RefusesKeysThatDoNotGoTogether) {
  const ProgramResult result = run_case(kaplan + "removal_tolerance = 0.1\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("expected uniformisation = \"insert_and_remove\" beside it"));
}

// --- Blades by tables -----------------------------------------------------------------------------------------

const std::string own = "[geometry]\ntype = 'propeller'\ndiameter = 0.4\nblades = 3\n";
const std::string columns =
    "'r/R' = [0.2, 0.4, 0.6, 0.8, 0.95, 1.0]\n'c/D' = [0.18, 0.24, 0.28, 0.27, 0.18, 0.0]\n"
    "'t/D' = [0.04, 0.03, 0.02, 0.012, 0.006, 0.004]\n";
const std::string more_columns =
    "'P/D' = [0.9, 1.0, 1.05, 1.0, 0.95, 0.9]\nskew = [0, 2, 5, 10, 16, 20]\n'f/c' = [0.02, 0.02, 0.02, 0.02, 0.015, "
    "0.01]\n";

TEST_F(PropellerCase, TakesATableInlineOrFromAFile) {
  const ProgramResult inline_result = run_case(own + "[geometry.table]\n" + columns + more_columns + coarse);
  ASSERT_EQ(inline_result.status, 0) << inline_result.err;
  const nlohmann::json from_keys = results();
  EXPECT_EQ(from_keys["propeller"]["sections"].size(), 8u);
  EXPECT_TRUE(from_keys["geometry"]["closed"]);
  // The same in other measures: lengths, and the thickness over the chord.
  std::string table = "r/R,chord,thickness,pitch,skew,camber\n";
  const std::vector<std::vector<double>> rows{{0.2, 0.18, 0.04, 0.9, 0, 0.02},      {0.4, 0.24, 0.03, 1.0, 2, 0.02},
                                              {0.6, 0.28, 0.02, 1.05, 5, 0.02},     {0.8, 0.27, 0.012, 1.0, 10, 0.02},
                                              {0.95, 0.18, 0.006, 0.95, 16, 0.015}, {1.0, 0.0, 0.004, 0.9, 20, 0.01}};
  for (const auto& r : rows)
    table += fmt::format("{},{},{},{},{},{}\n", r[0], 0.4 * r[1], 0.4 * r[2], 0.4 * r[3], r[4], 0.4 * r[1] * r[5]);
  write("blade.csv", table);
  ASSERT_EQ(run_case(own + "table_file = 'blade.csv'\n" + coarse).status, 0);
  const double volume = from_keys["properties"]["volume"]["value"];
  EXPECT_NEAR(results()["properties"]["volume"]["value"].get<double>(), volume, 1e-9 * volume);
}

TEST_F(PropellerCase, RefusesTablesThatContradictThemselves) {
  const auto refused = [&](const std::string& table, const std::string& keys = "") {
    const ProgramResult result = run_case(own + keys + "[geometry.table]\n" + table);
    EXPECT_EQ(result.status, 2);
    return result.err;
  };
  EXPECT_THAT(refused(columns), HasSubstr("the column pitch is missing; expected \"pitch\" or \"P/D\""));
  EXPECT_THAT(refused(columns + more_columns, "pitch_ratio = 1.0\n"),
              HasSubstr("found pitch_ratio as a column and as a key"));
  EXPECT_THAT(refused(columns + "chord = [1, 1, 1, 1, 1, 1]\n", "pitch_ratio = 1.0\n"),
              HasSubstr("found the columns chord and c/D; expected one of them"));
  EXPECT_THAT(refused(columns + "skew = [1, 2]\n", "pitch_ratio = 1.0\n"),
              HasSubstr("case.toml:6: geometry.table: found 2 values of skew for 6 of r/R"));
  EXPECT_THAT(refused("'r/R' = [0.2, 0.6, 1.0]\nchord = [80, 90, 0]\nthickness = [10, 5, 1]\n", "pitch_ratio = 1.0\n"),
              HasSubstr("expected lengths in the unit of the diameter, or c/D"));
  EXPECT_THAT(refused("'r/R' = [0.2, 0.6, 1.0]\nchord = [0.1, 0.1, 0]\n", "pitch_ratio = 1.0\n"),
              HasSubstr("the column thickness is missing; expected \"thickness\", \"t/D\" or \"t/c\""));
  EXPECT_THAT(
      refused("'r/R' = [0.2, 0.6, 1.0]\nchord = [0.1, 0, 0]\nthickness = [0.01, 0.01, 0]\n", "pitch_ratio = 1.0\n"),
      HasSubstr("row 2 (r/R = 0.6): the chord is 0"));
  EXPECT_THAT(refused(columns, "series = 'kaplan'\narea_ratio = 0.6\npitch_ratio = 1.0\n"),
              HasSubstr("found 2 of \"series\""));
  EXPECT_THAT(run_case(own).err, HasSubstr("found none of \"series\", \"table\""));
}

TEST_F(PropellerCase, TakesThePointsOfItsSections) {
  std::string sections;
  for (const double ratio : {0.2, 0.5, 0.8, 1.0}) {
    const double chord = 0.1 - 0.05 * ratio;
    std::string points = "x,y\n";
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{
             {-0.5, 0}, {-0.25, 0.06}, {0, 0.08}, {0.3, 0.05}, {0.5, 0.01}, {0.3, 0}, {0, 0}, {-0.25, 0}, {-0.5, 0}})
      points += fmt::format("{},{}\n", chord * x, chord * y);
    write(fmt::format("s{}.csv", ratio), points);
    sections += fmt::format("[[geometry.section]]\n'r/R' = {}\nfile = 's{}.csv'\n", ratio, ratio);
  }
  const ProgramResult result = run_case(own + "pitch_ratio = 1.0\n" + sections + coarse);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(results()["propeller"]["control_points"], (std::vector<int>{9, 4}));
  EXPECT_NEAR(results()["propeller"]["sections"][1]["chord"].get<double>(), 0.075, 1e-12);
}

// --- Hubs and sections ------------------------------------------------------------------------------------------

// The hub's volume, a truncated cone's, is exact; moulds and areas know where the blades stand.
TEST_F(PropellerCase, StandsOnHubsThatTaper) {
  const ProgramResult result = run_case(kaplan +
                                        "[[geometry.hub_profile]]\ntype = 'polyline'\n"
                                        "points = [[-100, 70], [100, 50]]\n"
                                        "[moulds]\nheights = [58, 100]\n[drawings]\nformats = ['svg']\n" +
                                        coarse +
                                        "[expect]\nhub_volume = { value = 2282890.6616085833, rtol = 1e-10 }\n"
                                        "closure_defect = { value = 0, atol = 1e-14 }\n");
  ASSERT_EQ(result.status, 0) << result.err << result.out;
  EXPECT_NEAR(results()["propeller"]["areas_outside_radius"].get<double>(), 60.0, 1e-12);
  // The rectangle round what the plane z = 58 leaves of the hub under the blade; a plane at 100 misses the hub.
  const std::string table = read_file(folder() / "out/moulds.csv");
  const auto half_width_on = [&](int line) {
    std::istringstream lines(table);
    std::string text;
    for (int i = 0; i <= line; ++i) std::getline(lines, text);
    std::istringstream cells(text);
    for (int i = 0; i < 6; ++i) std::getline(cells, text, ',');
    return text.empty() ? 0.0 : std::stod(text);
  };
  // The blade's foot begins at X = -37 or so: the hub has a radius of about 63.7 there.
  EXPECT_NEAR(half_width_on(1), std::sqrt(63.7 * 63.7 - 58.0 * 58.0), 1.0);
  EXPECT_EQ(half_width_on(2), 0.0);
}

TEST_F(PropellerCase, SaysThatASectionOnlyTouchesTheTip) {
  const ProgramResult result = run_case(kaplan + coarse +
                                        "[[section]]\nname = 'tip'\nnormal = [0, 0, 1]\noffsets = [240, 250]\n"
                                        "[output]\nsvg = true\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("degenerate: the plane only touches"));
  EXPECT_THAT(result.err, HasSubstr("section \"tip\" at 250: the plane only touches the boundary"));
  const nlohmann::json planes = results()["sections"]["tip"]["planes"];
  EXPECT_EQ(planes[0]["status"], "ok");
  EXPECT_EQ(planes[1]["status"], "touching");
  EXPECT_THAT(read_file(folder() / "out/section_tip.svg"), HasSubstr("the plane at 250 only touches"));
}

// --- Files ----------------------------------------------------------------------------------------------------

/// Six times the volume inside the triangles of a binary STL file.
double volume_of_stl(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  double sum = 0.0;
  for (std::uint32_t k = 0; k < count; ++k) {
    std::array<float, 9> p{};
    std::memcpy(p.data(), bytes.data() + 84 + 50 * static_cast<std::size_t>(k) + 12, 36);
    const auto at = [&](std::size_t i) { return static_cast<double>(p[i]); };
    sum += at(0) * (at(4) * at(8) - at(5) * at(7)) - at(1) * (at(3) * at(8) - at(5) * at(6)) +
           at(2) * (at(3) * at(7) - at(4) * at(6));
  }
  return sum / 6.0;
}

/// Written as IGES and read again, with trimmed blades and hub: the same area, volume and moments. As STL: within what
/// the tolerance of 0.05 mm costs.
class PropellerFiles : public PropellerCase, public ::testing::WithParamInterface<const char*> {};

TEST_P(PropellerFiles, KeepTheScrew) {
  const std::string fine = "[properties]\ntolerance = 1e-10\n";
  const std::string screw = kaplan + GetParam() + fine;
  ASSERT_EQ(run_case(screw).status, 0);
  const nlohmann::json direct = results()["properties"];
  ASSERT_EQ(run({"convert", (folder() / "case.toml").string(), (folder() / "screw.igs").string()}).status, 0);
  const ProgramResult again = run_case("[geometry]\ntype = 'file'\npath = 'screw.igs'\n" + fine);
  ASSERT_EQ(again.status, 0) << again.err;
  const nlohmann::json all = results();
  EXPECT_TRUE(all["geometry"]["closed"]);
  EXPECT_LE(all["geometry"]["closure_defect"].get<double>(), 1e-12);
  for (const char* name : {"area", "volume"}) {
    const double value = direct[name]["value"];
    EXPECT_NEAR(all["properties"][name]["value"].get<double>(), value, 1e-9 * value) << name;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double moment = direct["inertia"]["value"][i][i];
    EXPECT_NEAR(all["properties"]["inertia"]["value"][i][i].get<double>(), moment, 1e-9 * moment);
  }
  write("mesh.toml", screw + "[output]\nstl_tolerance = 0.05\n");
  ASSERT_EQ(run({"convert", (folder() / "mesh.toml").string(), (folder() / "screw.stl").string()}).status, 0);
  const double volume = direct["volume"]["value"];
  const double area = direct["area"]["value"];
  EXPECT_NEAR(volume_of_stl(read_file(folder() / "screw.stl")), volume, 0.05 * area);
}

INSTANTIATE_TEST_SUITE_P(Hubs, PropellerFiles,
                         ::testing::Values("hub_ends = [-60, 70]\n", "hub_ratio = 0\n",
                                           "[[geometry.hub_profile]]\ntype = 'polyline'\n"
                                           "points = [[-100, 70], [-10, 60], [100, 50]]\n"));

// --- Edits ----------------------------------------------------------------------------------------------------

TEST_F(PropellerCase, MovesControlPointsAsTold) {
  ASSERT_EQ(run_case(kaplan + coarse).status, 0);
  const double before = results()["propeller"]["blade_volume"]["value"];
  const ProgramResult result = run_case(kaplan +
                                        "[[geometry.edit]]\n'r/R' = 0.7\npoint = 7\nmove_x = 2.0\n"
                                        "[[geometry.edit]]\n'r/R' = 0.7\npoint = 8\nmove_y = -0.5\n"
                                        "[[geometry.edit]]\n'r/R' = 0.6\npoint = 9\nsmooth = true\n" +
                                        coarse);
  ASSERT_EQ(result.status, 0) << result.err;
  const double after = results()["propeller"]["blade_volume"]["value"];
  EXPECT_GT(std::abs(after - before), 1.0);
  EXPECT_LT(std::abs(after - before), 0.05 * before);
}

TEST_F(PropellerCase, RefusesEditsOfWhatIsNotThere) {
  const auto refused = [&](const std::string& edit) {
    return run_case(kaplan + "[[geometry.edit]]\n" + edit + coarse).err;
  };
  EXPECT_THAT(refused("'r/R' = 0.65\npoint = 7\nmove_x = 2.0\n"), HasSubstr("the blade has sections at 0.2, 0.3"));
  EXPECT_THAT(refused("'r/R' = 0.6\npoint = 25\nmove_x = 2.0\n"),
              HasSubstr("section 5, control point 25: expected one from 2 to 24"));
  EXPECT_THAT(refused("'r/R' = 0.6\npoint = 7\n"), HasSubstr("expected exactly one of \"move_x\""));
}

}  // namespace
}  // namespace isorim::testing
