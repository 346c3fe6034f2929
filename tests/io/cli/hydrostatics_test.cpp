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
  // Symmetric fore and aft: centres amidships but for rounding, which is no curve.
  EXPECT_EQ(read_file(folder() / "out/curves_of_form.svg").find("lcb ("), std::string::npos);
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

// The table of a hull says where draughts, amidships and coefficients count from.
TEST_F(HydrostaticCases, OfAHullCountAsItsTableDoes) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'hull'\noffsets = 'wigley'\nscale = { length = 10, beam = 1, draught = 0.625 }\n"
      "[hydrostatics]\ndraught = 0.46875\n");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = results().at("hydrostatics");
  const auto value = [&](const char* name) { return json.at(name).at("value").get<double>(); };
  // hull_wigley.toml.
  EXPECT_NEAR(value("volume"), 1.7578125, 1e-12);
  EXPECT_NEAR(value("waterplane_area"), 6.25, 1e-12);
  EXPECT_EQ(value("length"), 10.0);
  EXPECT_EQ(value("beam"), 1.0);
  EXPECT_NEAR(value("cb"), 1.7578125 / (10.0 * 1.0 * 0.46875), 1e-12);
}

TEST_F(HydrostaticCases, HaveAddedMasses) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'sphere'\nradius = 1\ncentre = [1, 0, 0]\n[added_mass]\nwater_density = 3\ndegree = 2\n"
      "[expect]\n'added_mass.surge' = { value = 0.5, atol = 1e-9 }\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("added mass"));
  const auto json = results().at("added_mass");
  const double mass = 2.0 / 3.0 * std::numbers::pi * 3.0;
  EXPECT_NEAR(json.at("displaced_mass").get<double>(), 2.0 * mass, 1e-9);
  EXPECT_NEAR(json.at("matrix")[1][5].get<double>(), mass, 1e-8);
  EXPECT_NEAR(json.at("matrix")[4][4].get<double>(), mass, 1e-8);
  EXPECT_LT(json.at("error")[0][0].get<double>(), 1e-8);
  EXPECT_TRUE(json.at("waterplane").is_null());
}

TEST_F(HydrostaticCases, HaveHalfTheAddedMassOfADoubleBody) {
  // The lower half of a sphere: half of what the sphere has, about a centre in the water.
  const ProgramResult result =
      run_case("[geometry]\ntype = 'sphere'\nradius = 1\n[added_mass]\ndraught = 1\ndegree = 2\n");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = results().at("added_mass");
  EXPECT_NEAR(json.at("displaced_mass").get<double>(), 2.0 / 3.0 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(json.at("matrix")[0][0].get<double>(), std::numbers::pi / 3.0, 1e-4);
  EXPECT_NEAR(json.at("matrix")[2][2].get<double>(), std::numbers::pi / 3.0, 1e-4);
  EXPECT_NEAR(json.at("waterplane").get<double>(), 0.0, 1e-12);
}

TEST_F(HydrostaticCases, RefuseAddedMassesThatMeanNothing) {
  const std::string sphere = "[geometry]\ntype = 'sphere'\nradius = 1\n[added_mass]\n";
  const auto refused = [&](const std::string& keys, const char* fragment) {
    const ProgramResult result = run_case(sphere + keys);
    EXPECT_EQ(result.status, 2) << keys;
    EXPECT_THAT(result.err, HasSubstr(fragment));
  };
  refused("draught = 3\n", "draught: the water lies at z = 2; expected it between the lowest and the highest point");
  refused("draught = 1\ncentre = [0, 0, 1]\n", "centre: it lies at z = 1; expected it in the water");
  refused("refine = 0\n", "added_mass.refine");
  refused("baseline = 0\n", "needs a \"draught\"");
  refused("centre = [0, 0]\n", "found 2 coordinates; expected 3");
  const ProgramResult plane = run_case("[geometry]\ntype = 'circle'\nradius = 1\n[added_mass]\n");
  EXPECT_EQ(plane.status, 2);
  EXPECT_THAT(plane.err, HasSubstr("added masses are for solids"));
}

}  // namespace
}  // namespace isorim::testing
