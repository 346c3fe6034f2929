#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "geometry/trimming/loose_face.h"
#include "io/iges/reader.h"
#include "io/iges/writer.h"
#include "tests/io/iges/boundaries.h"
#include "tests/io/iges/entities.h"

/// What is written is what is read.
namespace isorim::io::iges {
namespace {

using geometry::Boundary;
using geometry::OrientedBoundary;
using ::testing::IsEmpty;

/// The coordinates of files: what no double can give back is rounded once for all.
geometry::NurbsSurface<3> as_from_file(const geometry::NurbsSurface<3>& surface) {
  const Eigen::VectorXd weights = surface.weights();
  return geometry::NurbsSurface<3>::from_points(surface.knots_u(), surface.knots_v(), surface.control_points(),
                                                {weights.data(), static_cast<std::size_t>(weights.size())});
}

Boundary<3> as_from_file(Boundary<3> boundary) {
  for (auto& patch : boundary.patches) {
    if (auto* surface = std::get_if<geometry::NurbsSurface<3>>(&patch.shape)) *surface = as_from_file(*surface);
    if (auto* face = std::get_if<geometry::TrimmedSurface>(&patch.shape)) {
      patch.shape = geometry::TrimmedSurface(as_from_file(face->surface()), face->loops());
    }
  }
  return boundary;
}

std::string text_of(const OrientedBoundary<3>& oriented, Form form) {
  return iges_text(oriented, {.form = form, .title = "round trip", .date = "20260101.120000"}).text;
}

OrientedBoundary<3> read_back(const std::string& text) {
  const CadModel model = read_iges(parse(text, "written.igs"));
  EXPECT_THAT(model.warnings, IsEmpty());
  Boundary<3> boundary;
  for (const CadFace& face : model.faces) {
    geometry::AssembledFace assembled = assemble_face(face.face);
    EXPECT_THAT(assembled.repairs.notes, IsEmpty()) << face.origin.entity;
    boundary.patches.push_back({face.origin.name, std::move(assembled.shape), 1});
  }
  return orient(boundary);
}

void expect_same_patch(const geometry::Patch<3>& a, const geometry::Patch<3>& b) {
  SCOPED_TRACE(b.name);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.orientation, b.orientation);
  ASSERT_EQ(a.shape.index(), b.shape.index());
  expect_same_bits(surface_of(a.shape), surface_of(b.shape));
  const auto loops_a = trim_loops(a.shape);
  const auto loops_b = trim_loops(b.shape);
  ASSERT_EQ(loops_a.size(), loops_b.size());
  for (std::size_t i = 0; i < loops_a.size(); ++i) {
    ASSERT_EQ(loops_a[i].curves.size(), loops_b[i].curves.size());
    for (std::size_t k = 0; k < loops_a[i].curves.size(); ++k) {
      expect_same_bits(loops_a[i].curves[k], loops_b[i].curves[k]);
    }
  }
}

struct Shape {
  const char* name;
  Boundary<3> boundary;
  /// Vertices lie inside pcurves, which solids cut there.
  bool has_cut_pcurves = false;
};

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.name;
}

Boundary<3> hollow_ball() {
  Boundary<3> boundary = geometry::sphere(1.0);
  append(boundary, geometry::ellipsoid({0.3, 0.4, 0.5}), "_void");
  append(boundary, geometry::cube(1.0, {2, 0, 0}), "_apart");
  return boundary;
}

class IgesRoundTrip : public ::testing::TestWithParam<Shape> {};

TEST_P(IgesRoundTrip, GivesTheSameBitsInEitherForm) {
  const OrientedBoundary<3> oriented = orient(as_from_file(GetParam().boundary));
  for (const Form form : {Form::faces, Form::solids}) {
    SCOPED_TRACE(form == Form::faces ? "faces" : "solids");
    const std::string text = text_of(oriented, form);
    const OrientedBoundary<3> back = read_back(text);
    EXPECT_EQ(back.topology.closed, oriented.topology.closed);
    ASSERT_EQ(back.boundary.patches.size(), oriented.boundary.patches.size());
    const bool is_cut = form == Form::solids && GetParam().has_cut_pcurves;
    for (std::size_t i = 0; i < back.boundary.patches.size() && !is_cut; ++i) {
      expect_same_patch(back.boundary.patches[i], oriented.boundary.patches[i]);
    }
    EXPECT_EQ(text_of(back, form), text);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, IgesRoundTrip,
    ::testing::Values(Shape{"sphere", geometry::sphere(1.0, {0.1, 0.2, 0.3})},
                      Shape{"torus", geometry::torus(2.0, 0.5, {1, 1, 1})},
                      Shape{"cube", geometry::cube(1.0, {0.1, 0.2, 0.3})}, Shape{"cone", geometry::cone(1.0, 0.0, 2.0)},
                      Shape{"cylinder", geometry::cylinder(1.0, 2.0)}, Shape{"drilled_plate", drilled_plate(), true},
                      Shape{"trimmed_sphere", trimmed_sphere()}, Shape{"hollow_ball", hollow_ball()}),
    [](const auto& shape) { return std::string(shape.param.name); });

}  // namespace
}  // namespace isorim::io::iges
