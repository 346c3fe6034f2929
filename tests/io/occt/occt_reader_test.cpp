// STEP files written by OpenCASCADE itself, read back and measured: what arrives must be the shape, not an
// approximation of it.
#include "io/occt/occt_reader.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "geometry/trimming/loose_face.h"
#include "io/cad/read_cad.h"
#include "io/cli/program.h"
#include "io/iges/writer.h"
#include "solver/properties.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;
constexpr double pi = std::numbers::pi;

class StepFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const TopoDS_Shape& shape, const char* unit = "MM") {
    const std::filesystem::path path =
        std::filesystem::path(::testing::TempDir()) /
        (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".step");
    // Read by the constructor.
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("write.step.unit", unit);
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    EXPECT_EQ(writer.Write(path.string().c_str()), IFSelect_RetDone);
    return path;
  }

  static solver::GeometricProperties<3> measure(const CadModel& model) {
    geometry::Boundary<3> boundary;
    for (const CadFace& face : model.faces)
      boundary.patches.push_back({face.origin.entity, geometry::assemble_face(face.face).shape});
    const auto oriented = geometry::orient(boundary);
    EXPECT_TRUE(oriented.topology.closed);
    return solver::geometric_properties(geometry::bezier_elements(oriented.boundary));
  }
};

TEST_F(StepFile, PrimitivesArriveExactly) {
  const auto sphere = measure(read_step(write(BRepPrimAPI_MakeSphere(2.0).Shape())));
  EXPECT_NEAR(sphere.domain->measure.value, 32.0 * pi / 3.0, 1e-12 * 34);
  EXPECT_NEAR(sphere.boundary_measure.value, 16.0 * pi, 1e-12 * 50);
  const auto torus = measure(read_step(write(BRepPrimAPI_MakeTorus(3.0, 1.0).Shape())));
  EXPECT_NEAR(torus.domain->measure.value, 6.0 * pi * pi, 1e-12 * 60);
  const auto cone = measure(read_step(write(BRepPrimAPI_MakeCone(2.0, 0.0, 3.0).Shape())));
  EXPECT_NEAR(cone.domain->measure.value, 4.0 * pi, 1e-12 * 13);
  const auto frustum = measure(read_step(write(BRepPrimAPI_MakeCone(2.0, 1.0, 3.0).Shape())));
  EXPECT_NEAR(frustum.domain->measure.value, 7.0 * pi, 1e-12 * 22);
}

TEST_F(StepFile, HolesArriveExactly) {
  const TopoDS_Shape hole = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(1, 1, -1), gp::DZ()), 0.5, 5.0).Shape();
  const TopoDS_Shape plate = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape(), hole).Shape();
  const CadModel model = read_step(write(plate));
  ASSERT_EQ(model.faces.size(), 7U);
  for (const CadFace& face : model.faces) EXPECT_EQ(face.solid, 0);
  const auto properties = measure(model);
  EXPECT_NEAR(properties.domain->measure.value, 6.0 - pi / 4.0, 1e-12 * 6);
  EXPECT_NEAR(properties.boundary_measure.value, 22.0 - pi / 2.0 + pi, 1e-12 * 22);
  EXPECT_TRUE(model.approximations.empty());
}

TEST_F(StepFile, KeepsItsUnit) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(25.4, 50.8, 76.2).Shape();
  const CadModel inches = read_step(write(box, "INCH"));
  EXPECT_EQ(inches.unit, "in");
  EXPECT_DOUBLE_EQ(inches.unit_in_millimetres, 25.4);
  EXPECT_NEAR(measure(inches).domain->measure.value, 6.0, 1e-12 * 6);
  const CadModel millimetres = read_step(write(box, "MM"));
  EXPECT_EQ(millimetres.unit, "mm");
  EXPECT_NEAR(measure(millimetres).domain->measure.value, 25.4 * 50.8 * 76.2, 1e-12 * 1e5);
}

TEST_F(StepFile, SaysWhoReadIt) {
  const CadModel model = read_step(write(BRepPrimAPI_MakeBox(1.0, 1.0, 1.0).Shape()));
  EXPECT_THAT(model.reader, HasSubstr("OpenCASCADE 7"));
  EXPECT_THAT(model.format, HasSubstr("STEP AUTOMOTIVE_DESIGN"));
  bool counts_faces = false;
  for (const EntityCount& count : model.entities) counts_faces |= count.type == "AdvancedFace" && count.count == 6;
  EXPECT_TRUE(counts_faces);
}

TEST_F(StepFile, RunsFromTheCommandLine) {
  const std::filesystem::path path = write(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
  std::ostringstream out, err;
  const int status =
      cli::run_program({"run", path.string(), "-o", (path.parent_path() / "step_out").string()}, out, err);
  EXPECT_EQ(status, 0) << err.str();
  EXPECT_THAT(out.str(), HasSubstr("STEP"));
  EXPECT_THAT(out.str(), ::testing::ContainsRegex("volume +(6|5.99999999999999[0-9]*|6.00000000000000[0-9]*) "));
}

// Loose faces of which the edges do not even touch, sewn.
TEST(RepairedIges, ClosesWhatIsOpenInTheFile) {
  geometry::Boundary<3> box = geometry::box({1, 1, 1});
  for (std::size_t i = 0; i < box.patches.size(); ++i) {
    geometry::Vector3 shift = geometry::Vector3::Zero();
    shift[static_cast<Eigen::Index>(i / 2)] = 1e-3;
    box.patches[i].shape = geometry::transform(box.patches[i].shape, geometry::translation<3>(shift));
  }
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "open_box.igs";
  iges::write_iges(path, geometry::orient(box));
  const CadModel model = read_cad(path, {.repair = 5e-3});
  EXPECT_THAT(model.reader, HasSubstr("repaired"));
  EXPECT_EQ(model.faces.size(), 6U);
  geometry::Boundary<3> boundary;
  geometry::OrientationOptions options{.largest_relative_gap = 0.02};
  for (const CadFace& face : model.faces) {
    const geometry::AssembledFace assembled = geometry::assemble_face(face.face);
    boundary.patches.push_back({face.origin.entity, assembled.shape});
    options.shared_edges.push_back(assembled.edges);
  }
  const auto oriented = geometry::orient(boundary, options);
  EXPECT_TRUE(oriented.topology.closed);
}

TEST_F(StepFile, RefusesWhatIsNone) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "broken.step";
  std::ofstream(path) << "ISO-10303-21;\nthis is no STEP file\n";
  try {
    read_step(path);
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("broken.step"));
  }
  EXPECT_THROW(read_step("/nonexistent.step"), InputError);
}

}  // namespace
}  // namespace isorim::io
