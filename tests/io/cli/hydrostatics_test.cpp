#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/program_test.h"

/// [hydrostatics] in case files.
namespace isorim::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class HydrostaticCases : public ProgramTest {
 protected:
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out/results.json")); }
};

const std::string box = "[geometry]\ntype = 'box'\nsize = [4, 2, 1]\ncorner = [-2, -1, 0]\n[hydrostatics]\n";

TEST_F(HydrostaticCases, AreInTheResultsAndFiles) {
  const ProgramResult result =
      run_case(box +
               "draught = 0.4\nwater_density = 1025\nloading = { mass = 3280, centre_of_gravity = [0, 0, 0.3] }\n"
               "curves_of_form = { draughts = [0.2, 0.4] }\nbonjean = { stations = [0], draughts = { from = 0.25, to = "
               "1, count = "
               "4 } }\nrighting_arms = { heels = { from = 0, to = 20, step = 10 } }\n"
               "cross_curves = { displacements = [3280], heels = [0, 10] }\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("displacement"));
  const auto json = results().at("hydrostatics");
  const auto value = [&](const char* name) { return json.at(name).at("value").get<double>(); };
  EXPECT_NEAR(value("displacement"), 3280.0, 1e-9);
  EXPECT_NEAR(value("volume"), 3.2, 1e-13);
  EXPECT_NEAR(value("vcb"), 0.2, 1e-14);
  EXPECT_NEAR(value("kmt"), 0.2 + 4.0 / 4.8, 1e-13);
  EXPECT_NEAR(value("cb"), 1.0, 1e-13);
  EXPECT_LT(json.at("volume").at("error").get<double>(), 1e-12);
  EXPECT_NEAR(json.at("curves_of_form").at("volume")[0].get<double>(), 1.6, 1e-13);
  EXPECT_EQ(json.at("curves_of_form").at("draught"), nlohmann::json({0.2, 0.4}));
  EXPECT_NEAR(json.at("bonjean").at("area")[3].get<double>(), 2.0, 1e-13);
  EXPECT_EQ(json.at("equilibria").at("stable"), nlohmann::json({1.0}));
  const double t = std::tan(std::numbers::pi / 18.0);
  const double gm = 0.2 + 4.0 / 4.8 - 0.3;
  EXPECT_NEAR(json.at("righting_arms").at("arm")[1].get<double>(),
              std::sin(std::atan(t)) * (gm + 0.5 * 4.0 / 4.8 * t * t), 1e-12);
  EXPECT_NEAR(json.at("cross_curves").at("arm")[1].get<double>(),
              json.at("righting_arms").at("arm")[1].get<double>() + 0.3 * std::sin(std::atan(t)), 1e-12);
  EXPECT_THAT(read_file(folder() / "out/curves_of_form.csv"), StartsWith("draught,trim,heel,displacement,volume,lcb"));
  EXPECT_THAT(read_file(folder() / "out/righting_arms.csv"), StartsWith("heel,arm,area,draught,trim,gmt\n0,"));
  for (const char* name : {"curves_of_form.svg", "bonjean.svg", "righting_arms.svg", "cross_curves.svg"})
    EXPECT_THAT(read_file(folder() / "out" / name), HasSubstr("class=\"series\"")) << name;
}

TEST_F(HydrostaticCases, FloatAtTheDraughtOfTheirLoading) {
  const ProgramResult result = run_case(
      box +
      "loading = { mass = 3.2, centre_of_gravity = [0.1, 0, 0.3] }\n[expect]\n"
      "'equilibria.stable' = { value = [1], atol = 0 }\n'hydrostatics.volume' = { value = 3.2, rtol = 1e-12 }\n");
  ASSERT_EQ(result.status, 0) << result.err << result.out;
  const auto json = results().at("hydrostatics");
  // G lies ahead of amidships: down by the bow.
  EXPECT_LT(json.at("trim").at("value").get<double>(), -0.5);
}

TEST_F(HydrostaticCases, WarnOfBodiesThatSinkOrAreUnstable) {
  const ProgramResult sinks = run_case(box +
                                       "loading = { mass = 9, centre_of_gravity = [0, 0, 0.3] }\n"
                                       "righting_arms = { heels = [0, 10] }\n");
  EXPECT_EQ(sinks.status, 0) << sinks.err;
  EXPECT_THAT(sinks.err, HasSubstr("the body sinks"));
  const ProgramResult lolls = run_case(box + "loading = { mass = 4, centre_of_gravity = [0, 0, 0.98] }\n");
  EXPECT_EQ(lolls.status, 0) << lolls.err;
  EXPECT_THAT(lolls.err, HasSubstr("is not stable"));
}

TEST_F(HydrostaticCases, RefuseAnOpenBoundary) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'patches'\n[[geometry.patches]]\ntype = 'disc'\nname = 'disc'\nradius = 1\n"
      "[hydrostatics]\ndraught = 1\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("hydrostatics need a closed boundary"));
}

}  // namespace
}  // namespace isorim::testing
