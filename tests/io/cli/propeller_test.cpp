#include <string>
#include <vector>

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

}  // namespace
}  // namespace isorim::testing
