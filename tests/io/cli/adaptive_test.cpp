#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::HasSubstr;

/// u = r^(2/3) cos(2 phi / 3) in an L.
const std::string corner =
    "[geometry]\ntype = 'polygon'\npoints = [[0, 0], [0, -1], [1, -1], [1, 1], [-1, 1], [-1, 0]]\n"
    "[definitions]\nv = '(x^2 + y^2)^(1/3)*cos(2/3*atan2(y - x, x + y))'\n"
    "[analysis]\nequation = 'laplace'\n[exact]\nvalue = 'v'\n"
    "[[probe]]\nname = 'p'\npoints = [[0.3, 0.4], [-0.05, 0.05]]\n"
    "[[boundary_condition]]\nkind = 'value'\nvalue = 'v'\n";

class Adaptive : public ProgramTest {
 protected:
  nlohmann::json analysis() const {
    return nlohmann::json::parse(read_file(folder() / "out" / "results.json"))["analysis"];
  }
};

TEST_F(Adaptive, TellsTheStepsToTheTolerance) {
  const ProgramResult result =
      run_case(corner +
               "[discretisation]\ndegree = 3\nadapt = { tolerance = 1e-4 }\n[expect]\nsteps = { value = 10, "
               "atol = 5 }\nestimate = { value = 0, atol = 1e-4 }\n");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("adaptive refinement, tolerance 0.0001 reached"));
  const nlohmann::json found = analysis();
  const nlohmann::json& adaptive = found["adaptive"];
  EXPECT_EQ(adaptive["end"], "tolerance_reached");
  EXPECT_TRUE(adaptive["reached"].get<bool>());
  const nlohmann::json& steps = adaptive["steps"];
  ASSERT_GT(steps.size(), 3U);
  for (std::size_t k = 1; k < steps.size(); ++k) {
    EXPECT_GT(steps[k]["unknowns"], steps[k - 1]["unknowns"]);
    EXPECT_GT(steps[k - 1]["estimate"], 1e-4);
  }
  EXPECT_LE(steps.back()["estimate"], 1e-4);
  EXPECT_EQ(steps.back()["unknowns"], found["unknowns"]);
  EXPECT_EQ(steps.back()["errors"]["probe_max"], found["errors"]["probe_max"]);
  EXPECT_LT(steps.back()["errors"]["probe_max"], 0.02 * steps.front()["errors"]["probe_max"].get<double>());
}

TEST_F(Adaptive, KeepsTheStepsInHdf5) {
  EXPECT_EQ(run_case(corner + "[discretisation]\nadapt = { tolerance = 1e-3 }\n").status, 0);
  const hid_t file = H5Fopen((folder() / "out" / "results.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t set = H5Dopen2(file, "/analysis/adaptive/probe_max", H5P_DEFAULT);
  ASSERT_GE(set, 0);
  const hid_t space = H5Dget_space(set);
  std::vector<double> errors(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, errors.data());
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  const nlohmann::json steps = analysis()["adaptive"]["steps"];
  ASSERT_EQ(errors.size(), steps.size());
  EXPECT_EQ(errors.back(), steps.back()["errors"]["probe_max"].get<double>());
}

TEST_F(Adaptive, AToleranceThatIsNotReachedIsStatus3WithResults) {
  const ProgramResult result = run_case(corner + "[discretisation]\nadapt = { tolerance = 1e-6, max_unknowns = 40 }\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("adapt: the estimate of the relative error is"));
  EXPECT_THAT(result.err,
              HasSubstr("the tolerance 1e-06 is not reached: the next step would have more than max_unknowns = 40"));
  EXPECT_LE(analysis()["unknowns"], 40);
  EXPECT_EQ(analysis()["adaptive"]["end"], "max_unknowns");
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "solution.vtu"));
  const ProgramResult steps = run_case(corner + "[discretisation]\nadapt = { tolerance = 1e-6, max_steps = 2 }\n");
  EXPECT_EQ(steps.status, 3);
  EXPECT_THAT(steps.err, HasSubstr("is not reached: max_steps = 2"));
}

TEST_F(Adaptive, FalseIsNone) {
  EXPECT_EQ(run_case(corner + "[discretisation]\nadapt = false\n").status, 0);
  EXPECT_FALSE(analysis().contains("adaptive"));
}

/// The condition changes inside elements, whose parts keep the condition of the whole.
TEST_F(Adaptive, ConditionsMayEndInsideElements) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'circle'\nradius = 1\n[analysis]\nequation = 'laplace'\n"
      "[[boundary_condition]]\nwhere = 'x + 0.3*y > 0'\nname = 'a'\nkind = 'value'\nvalue = 'exp(x)*sin(y)'\n"
      "[[boundary_condition]]\nkind = 'flux'\nvalue = 'exp(x)*(sin(y)*nx + cos(y)*ny)'\n"
      "[exact]\nvalue = 'exp(x)*sin(y)'\n[[probe]]\nname = 'p'\npoints = [[0.3, 0.4], [-0.3, "
      "0.6]]\n[discretisation]\nadapt = { tolerance = 1e-6 }\n");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("boundary conditions end inside 2 elements of patch"));
  EXPECT_LT(analysis()["errors"]["probe_max"], 1e-6);
  EXPECT_NEAR(analysis()["boundary_conditions"]["a"]["measure"].get<double>(), 3.141592653589793, 1e-9);
}

/// Trimmed faces as a whole, the others locally; in elasticity, with a symmetry plane.
TEST_F(Adaptive, TrimmedFacesAreBisectedAsAWhole) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'box'\nsize = [1, 1, 1]\nclip = [{ point = [0.6, 0, 0], normal = [1, 0.3, 0] }]\n"
      "[analysis]\nequation = 'elasticity'\n[material]\nyoung = 1\npoisson = 0.3\n"
      "[[boundary_condition]]\non = 'x_min'\nkind = 'displacement'\n"
      "[[boundary_condition]]\nwhere = 'z < 1e-9'\nkind = 'symmetry'\n"
      "[[boundary_condition]]\nname = 'rest'\nkind = 'traction'\nvalue = ['y', '0', '0']\n"
      "[discretisation]\ndegree = 2\nadapt = { tolerance = 1e-4, max_unknowns = 900 }\n[solve]\ntolerance = 1e-7\n");
  EXPECT_EQ(result.status, 3) << result.err;
  const nlohmann::json steps = analysis()["adaptive"]["steps"];
  ASSERT_GT(steps.size(), 1U);
  EXPECT_LT(steps.back()["estimate"], steps.front()["estimate"]);
}

}  // namespace
}  // namespace isorim::testing
