#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkGenericCell.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::HasSubstr;

const std::string square = "[geometry]\ntype = 'rectangle'\nsize = [1, 1]\n";
const std::string sphere = "[geometry]\ntype = 'sphere'\nradius = 1\n";
const std::string box = "[geometry]\ntype = 'box'\nsize = [1, 1, 1]\n";
const std::string laplace = "[analysis]\nequation = 'laplace'\n";
const std::string elastic = "[analysis]\nequation = 'elasticity'\n[material]\nyoung = 10\npoisson = 0.25\n";

std::string condition(const std::string& keys) {
  return "[[boundary_condition]]\n" + keys + "\n";
}

class Analysis : public ProgramTest {
 protected:
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out" / "results.json")); }
  /// Runs a case that must be well, and gives its "analysis".
  nlohmann::json analysis_of(const std::string& text) const {
    const ProgramResult result = run_case(text);
    EXPECT_EQ(result.status, 0) << result.err;
    return results()["analysis"];
  }
  std::string out(const std::string& name) const { return (folder() / "out" / name).string(); }
};

template <class Reader>
auto* read_vtk(Reader& reader, const std::string& path) {
  reader.SetFileName(path.c_str());
  reader.Update();
  EXPECT_EQ(reader.GetErrorCode(), 0UL) << path;
  return reader.GetOutput();
}

double linear(const double* x) {
  return 1.0 + 2.0 * x[0] - 3.0 * x[1] + x[2];
}

/// A point of a cell and the value of a field there, by VTK's own shape functions.
struct Interpolated {
  std::array<double, 3> point{};
  double value = 0.0;
};
Interpolated interpolate(vtkUnstructuredGrid* grid, vtkIdType cell, const char* field, double r, double s,
                         int component = 0) {
  vtkNew<vtkGenericCell> generic;
  grid->GetCell(cell, generic);
  std::vector<double> shape(static_cast<std::size_t>(generic->GetNumberOfPoints()));
  const std::array<double, 3> at{r, s, 0.0};
  Interpolated result;
  int sub_cell = 0;
  generic->EvaluateLocation(sub_cell, at.data(), result.point.data(), shape.data());
  for (int i = 0; i < generic->GetNumberOfPoints(); ++i) {
    result.value += shape[static_cast<std::size_t>(i)] *
                    grid->GetPointData()->GetArray(field)->GetComponent(generic->GetPointId(i), component);
  }
  return result;
}

// --- Conditions ---------------------------------------------------------------------------------------------------

TEST_F(Analysis, NamesThePatchesWithoutACondition) {
  const ProgramResult result = run_case(square + laplace + condition("on = ['top', 'left']\nkind = 'value'"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("no boundary condition holds on all of patches \"bottom\", \"right\""));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(Analysis, RefusesTwoConditionsOfTheSameRankInOnePlace) {
  const ProgramResult result =
      run_case(square + laplace + condition("on = ['top', 'left']\nname = 'a'\nkind = 'value'") +
               condition("on = 'left'\nkind = 'flux'") + condition("kind = 'flux'"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("the boundary conditions \"a\" (line 6) and \"left\" (line 10) both hold on patch "
                                    "\"left\""));
}

TEST_F(Analysis, RefusesAConditionThatHoldsNowhere) {
  const ProgramResult result =
      run_case(square + laplace + condition("where = 'x > 5'\nkind = 'value'") + condition("kind = 'value'"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("boundary_condition[1]: holds nowhere"));
}

TEST_F(Analysis, TakesTheMoreSpecialConditionWhateverTheOrder) {
  const nlohmann::json found = analysis_of(
      square + laplace + condition("kind = 'flux'") + condition("where = 'x < 1e-9'\nname = 'low'\nkind = 'value'") +
      condition("on = ['left', 'right']\nname = 'high'\nkind = 'value'\nvalue = 3"));
  EXPECT_EQ(found["boundary_conditions"]["all"]["elements"], 2);
  EXPECT_NEAR(found["boundary_conditions"]["low"]["flux"].get<double>(), -3.0, 1e-10);
  EXPECT_NEAR(found["boundary_conditions"]["high"]["flux"].get<double>(), 3.0, 1e-10);
}

TEST_F(Analysis, WarnsOfASelectionThatEndsInsideAnElement) {
  const ProgramResult result =
      run_case(square + laplace + condition("where = 'x > 0.7'\nkind = 'value'") + condition("kind = 'value'"));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("boundary conditions end inside 1 element of patch \"bottom\""));
}

TEST_F(Analysis, RefusesSymmetryOnACurvedPatch) {
  const ProgramResult result = run_case(sphere + elastic + condition("kind = 'symmetry'"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("boundary_condition[1]: the boundary is not flat at"));
}

TEST_F(Analysis, RefusesFluxesOutOfBalanceAndOpenBoundaries) {
  const ProgramResult unbalanced = run_case(square + laplace + condition("kind = 'flux'\nvalue = 1"));
  EXPECT_EQ(unbalanced.status, 2);
  EXPECT_THAT(unbalanced.err, HasSubstr("case.toml: only fluxes are prescribed"));
  const ProgramResult open = run_case(
      "[geometry]\ntype = 'revolve'\nangle = 180\nprofile = [{ type = 'line', from = [1, 0], to = [1, 1] }]\naxis = { "
      "direction = [0, 1, 0] }\n" +
      laplace + condition("kind = 'value'"));
  EXPECT_EQ(open.status, 2);
}

TEST_F(Analysis, SaysThatANullSpaceWasFixed) {
  const nlohmann::json found = analysis_of(square + laplace + condition("kind = 'flux'\nvalue = 'nx'"));
  ASSERT_EQ(found["messages"].size(), 1U);
  EXPECT_THAT(found["messages"][0].get<std::string>(), HasSubstr("up to a constant"));
}

// --- Numbers ------------------------------------------------------------------------------------------------------

TEST_F(Analysis, FindsAStretchedSquareOnRollersItsReactionsAndStresses) {
  const nlohmann::json found = analysis_of(
      square + elastic + condition("on = ['left', 'bottom']\nname = 'rollers'\nkind = 'symmetry'") +
      condition("on = 'right'\nkind = 'traction'\nvalue = { normal = 2 }") +
      condition("on = 'top'\nkind = 'traction'\npressure = 1") + "[[probe]]\nname = 'middle'\npoints = [[0.5, 0.5]]\n");
  const auto close = [](const nlohmann::json& list, const std::vector<double>& expected) {
    ASSERT_EQ(list.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(list[i].get<double>(), expected[i], 1e-9);
  };
  // Plane strain: szz = nu (sxx + syy).
  close(found["probes"]["middle"]["stress"][0], {2.0, -1.0, 0.25, 0.0});
  close(found["probes"]["middle"]["principal"][0], {2.0, 0.25, -1.0});
  close(found["boundary_conditions"]["rollers"]["force"], {-2.0, 1.0});
  close(found["boundary_conditions"]["right"]["force"], {2.0, 0.0});
  close(found["boundary_conditions"]["right"]["moment"], {-1.0});
  const double von_mises = std::sqrt((9.0 + 1.75 * 1.75 + 1.25 * 1.25) / 2.0);
  EXPECT_NEAR(found["probes"]["middle"]["von_mises"][0].get<double>(), von_mises, 1e-9);
  EXPECT_LT(found["balance"].get<double>(), 1e-10);
  EXPECT_GT(found["peak_memory"].get<double>(), 1e6);
}

TEST_F(Analysis, MixesDisplacementsWithTractionsOnOneFace) {
  // Simple shear by a traction along y on a face that is held along x.
  const nlohmann::json found =
      analysis_of(square + elastic + condition("on = 'left'\nkind = 'displacement'") +
                  condition("on = 'right'\nkind = 'displacement'\nvalue = { x = 0 }\ntraction = { y = 1 }") +
                  condition("kind = 'displacement'\nvalue = ['0', '']\ntraction = ['', '0']") +
                  "[[probe]]\nname = 'middle'\npoints = [[0.5, 0.5]]\n");
  const double shear_modulus = 4.0;
  EXPECT_NEAR(found["probes"]["middle"]["value"][0][1].get<double>(), 0.5 / shear_modulus, 1e-9);
  EXPECT_NEAR(found["probes"]["middle"]["stress"][0][3].get<double>(), 1.0, 1e-8);
}

TEST_F(Analysis, IntegratesWhatTheIntegrandSaysOfTheSolution) {
  const ProgramResult result =
      run_case("[geometry]\ntype = 'circle'\nradius = 2\n" + laplace + condition("kind = 'value'\nvalue = '3*x'") +
               "[[integral]]\nname = 'energy'\nover = 'boundary'\nintegrand = 'u*q'\n"
               "[[integral]]\nname = 'plain'\nover = 'boundary'\nintegrand = 'x*nx'\n");
  EXPECT_EQ(result.status, 0) << result.err;
  // int |grad u|^2 dA = 9 pi r^2.
  EXPECT_NEAR(results()["integrals"]["energy"]["value"].get<double>(), 36.0 * M_PI, 1e-8);
  EXPECT_NEAR(results()["integrals"]["plain"]["value"].get<double>(), 4.0 * M_PI, 1e-12);
}

TEST_F(Analysis, MeasuresErrorsWithoutTheFreeConstant) {
  const nlohmann::json errors = analysis_of(square + laplace + condition("kind = 'flux'\nvalue = '2*nx'") +
                                            "[[probe]]\nname = 'p'\npoints = [[0.2, 0.3]]\n"
                                            "[exact]\nvalue = '2*x + 17'\ngradient = [2, 0]\n")["errors"];
  for (const char* name : {"boundary_l2", "boundary_max", "probe_max", "probe_gradient_max", "flux_max"}) {
    EXPECT_LT(errors[name].get<double>(), 1e-10) << name;
  }
}

TEST_F(Analysis, MissesAnExpectationWithStatus1) {
  const ProgramResult result =
      run_case(square + laplace + condition("kind = 'value'\nvalue = 'x'") +
               "[[probe]]\nname = 'p'\npoints = [[0.25, 0.3]]\n[expect]\n'p.value' = { value = "
               "0.26, atol = 1e-3 }\n'p.gradient' = { value = [1, 0], atol = 1e-8 }\n");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.err, HasSubstr("the expectation of p.value is missed"));
  EXPECT_THAT(result.out, HasSubstr("p.gradient x"));
}

// --- Files --------------------------------------------------------------------------------------------------------

/// A linear field on a sphere lies in the space; its values on exact rational cells must be exact.
TEST_F(Analysis, WritesExactFieldsOnBezierCells) {
  analysis_of(sphere + laplace + condition("kind = 'value'\nvalue = '1 + 2*x - 3*y + z'") +
              "[discretisation]\ndegree = 3\nrefine = 1\n");
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  vtkUnstructuredGrid* grid = read_vtk(*reader, out("solution.vtu"));
  ASSERT_EQ(grid->GetNumberOfCells(), 32);
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
    const Interpolated potential = interpolate(grid, cell, "potential", 0.3, 0.6);
    EXPECT_NEAR(potential.value, linear(potential.point.data()), 1e-8);
    // On the sphere the normal is the position.
    const Interpolated flux = interpolate(grid, cell, "flux", 0.3, 0.6);
    EXPECT_NEAR(flux.value, linear(flux.point.data()) - 1.0, 1e-7);
    EXPECT_EQ(grid->GetCellData()->GetArray("condition")->GetComponent(cell, 0), 0.0);
  }
}

/// Degree 1 on quadratic rational elements is polynomial: the cells have the degree of both together.
TEST_F(Analysis, WritesPolynomialFieldsOnRationalCells) {
  analysis_of("[geometry]\ntype = 'circle'\nradius = 1\n" + laplace +
              condition("kind = 'value'\nvalue = 'atan2(y, x)*(x > 0)'") +
              "[discretisation]\ndegree = 1\nrefine = 2\n");
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  vtkUnstructuredGrid* grid = read_vtk(*reader, out("solution.vtu"));
  ASSERT_EQ(grid->GetNumberOfCells(), 16);
  EXPECT_EQ(grid->GetCellData()->GetArray("HigherOrderDegrees")->GetComponent(0, 0), 3.0);
  for (vtkIdType cell = 0; cell < 16; ++cell) {
    // Linear in the parameter, hence in the middle the mean of the ends; and the cell is still the circle.
    const Interpolated first = interpolate(grid, cell, "potential", 0.0, 0.0);
    const Interpolated middle = interpolate(grid, cell, "potential", 0.5, 0.0);
    const Interpolated last = interpolate(grid, cell, "potential", 1.0, 0.0);
    EXPECT_NEAR(middle.value, 0.5 * (first.value + last.value), 1e-12);
    EXPECT_NEAR(std::hypot(middle.point[0], middle.point[1]), 1.0, 1e-14);
  }
}

TEST_F(Analysis, WritesPointwiseFieldsOnFacets) {
  analysis_of(box + elastic + condition("kind = 'displacement'\nvalue = ['0.1*x + 0.05*y', '0.02*z', '-0.03*z']"));
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  vtkUnstructuredGrid* grid = read_vtk(*reader, out("fields.vtu"));
  ASSERT_GT(grid->GetNumberOfPoints(), 6 * 9);
  const std::array<double, 6> stress{10.0 / 1.25 * (0.1 + 0.07 / 2.0),
                                     10.0 / 1.25 * (0.07 / 2.0),
                                     10.0 / 1.25 * (-0.03 + 0.07 / 2.0),
                                     4.0 * 0.05,
                                     4.0 * 0.02,
                                     0.0};
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    const std::array<double, 3> x{grid->GetPoint(i)[0], grid->GetPoint(i)[1], grid->GetPoint(i)[2]};
    EXPECT_NEAR(grid->GetPointData()->GetArray("displacement")->GetComponent(i, 0), 0.1 * x[0] + 0.05 * x[1], 1e-9);
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(grid->GetPointData()->GetArray("stress")->GetComponent(i, k), stress[static_cast<std::size_t>(k)],
                  1e-7);
    }
  }
}

TEST_F(Analysis, WritesGridsWithWhatLiesOutsideBlanked) {
  analysis_of("[geometry]\ntype = 'circle'\nradius = 1.5\n" + laplace +
              condition("kind = 'value'\nvalue = '1 + 2*x - 3*y'") +
              "[[grid]]\nname = 'plane'\nfrom = [-2.5, -1]\nto = [2.5, 1]\ncounts = [11, 5]\n");
  vtkNew<vtkXMLImageDataReader> reader;
  vtkImageData* image = read_vtk(*reader, out("grid_plane.vti"));
  ASSERT_EQ(image->GetNumberOfPoints(), 55);
  const auto* ghosts =
      vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  ASSERT_NE(ghosts, nullptr);
  int inside = 0;
  for (vtkIdType i = 0; i < 55; ++i) {
    const std::array<double, 3> x{image->GetPoint(i)[0], image->GetPoint(i)[1], 0.0};
    const double level = (x[0] * x[0] + x[1] * x[1]) / 2.25;
    const bool hidden = const_cast<vtkUnsignedCharArray*>(ghosts)->GetValue(i) != 0;
    if (std::abs(level - 1.0) < 1e-9) continue;
    EXPECT_EQ(hidden, level > 1.0);
    if (hidden) continue;
    ++inside;
    EXPECT_NEAR(image->GetPointData()->GetArray("potential")->GetComponent(i, 0), linear(x.data()), 1e-9);
    EXPECT_NEAR(image->GetPointData()->GetArray("gradient")->GetComponent(i, 1), -3.0, 1e-8);
  }
  EXPECT_GT(inside, 15);
}

TEST_F(Analysis, WritesTurnedRectanglesAsImages) {
  analysis_of(
      box + laplace + condition("kind = 'value'\nvalue = '1 + 2*x - 3*y + z'") +
      "[[grid]]\nname = 'cut'\ncorner = [0.2, 0.2, 0.1]\nsides = [[0.5, 0.5, 0], [0, 0, 0.8]]\ncounts = [3, 4]\n");
  vtkNew<vtkXMLImageDataReader> reader;
  vtkImageData* image = read_vtk(*reader, out("grid_cut.vti"));
  ASSERT_EQ(image->GetNumberOfPoints(), 12);
  const std::array<double, 3> last{image->GetPoint(11)[0], image->GetPoint(11)[1], image->GetPoint(11)[2]};
  EXPECT_NEAR(last[0], 0.7, 1e-12);
  EXPECT_NEAR(last[1], 0.7, 1e-12);
  EXPECT_NEAR(last[2], 0.9, 1e-12);
  for (vtkIdType i = 0; i < 12; ++i) {
    const std::array<double, 3> x{image->GetPoint(i)[0], image->GetPoint(i)[1], image->GetPoint(i)[2]};
    EXPECT_NEAR(image->GetPointData()->GetArray("potential")->GetComponent(i, 0), linear(x.data()), 1e-9);
  }
}

TEST_F(Analysis, WritesProbesAsLinesAndTables) {
  write("points.csv", "# x, y\n0.25, 0.5\n0.75 0.5 # with blanks\n\n3;3\n");
  const nlohmann::json found = analysis_of(square + laplace + condition("kind = 'value'\nvalue = '1 + 2*x - 3*y'") +
                                           "[[probe]]\nname = 'line'\nfrom = [0.1, 0.1]\nto = [0.9, 0.5]\ncount = 5\n"
                                           "[[probe]]\nname = 'file'\nfile = 'points.csv'\n");
  vtkNew<vtkXMLPolyDataReader> reader;
  vtkPolyData* data = read_vtk(*reader, out("probe_line.vtp"));
  EXPECT_EQ(data->GetNumberOfLines(), 1);
  ASSERT_EQ(data->GetNumberOfPoints(), 5);
  EXPECT_NEAR(data->GetPointData()->GetArray("potential")->GetComponent(4, 0), 1.3, 1e-10);
  EXPECT_EQ(found["probes"]["file"]["location"], nlohmann::json({"inside", "inside", "outside"}));
  EXPECT_TRUE(found["probes"]["file"]["value"][2].is_null());
  EXPECT_THAT(found["messages"][0].get<std::string>(), HasSubstr("1 of 3 points lie outside the domain"));
  std::istringstream table(read_file(out("probe_file.csv")));
  std::string heading;
  std::string first;
  std::getline(table, heading);
  std::getline(table, first);
  EXPECT_EQ(heading, "x,y,location,u,du_dx,du_dy");
  EXPECT_THAT(first, ::testing::StartsWith("0.25,0.5,1,"));
}

TEST_F(Analysis, RefusesAFileOfPointsWithFileAndLine) {
  write("points.csv", "0.25, 0.5\n0.75, half\n");
  const ProgramResult result =
      run_case(square + laplace + condition("kind = 'value'") + "[[probe]]\nname = 'file'\nfile = 'points.csv'\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("points.csv:2: found \"0.75, half\"; expected 2 numbers"));
}

TEST_F(Analysis, KeepsEverythingInHdf5) {
  analysis_of(square + laplace + condition("kind = 'value'\nvalue = 'x'") +
              "[[probe]]\nname = 'p'\npoints = [[0.25, 0.5], [0.5, 0.5]]\n");
  const hid_t file = H5Fopen(out("results.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  std::array<double, 2> values{};
  const hid_t set = H5Dopen2(file, "/analysis/probes/p/value", H5P_DEFAULT);
  ASSERT_GE(set, 0);
  H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set);
  EXPECT_NEAR(values[0], 0.25, 1e-10);
  EXPECT_NEAR(values[1], 0.5, 1e-10);
  for (const char* name : {"/analysis/space/rows", "/analysis/space/potential", "/analysis/space/flux",
                           "/analysis/space/elements/nets", "/analysis/boundary_conditions/all/flux"}) {
    EXPECT_GT(H5Lexists(file, name, H5P_DEFAULT), 0) << name;
  }
  H5Fclose(file);
}

}  // namespace
}  // namespace isorim::testing
