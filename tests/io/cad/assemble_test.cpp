#include "io/cad/assemble.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"

namespace isorim::io {
namespace {

using geometry::Boundary;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point3;
using geometry::Points;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

CadCurve loose_circle(double radius) {
  CadCurve curve{geometry::embed(geometry::circle_curve(radius)), {}};
  curve.origin.entity = "100 at D1";
  return curve;
}

CadFace whole_face(const NurbsSurface<3>& surface, const std::string& name = "") {
  return {{.surface = surface, .loops = {}}, {.entity = "128 at D1", .name = name, .colour = std::nullopt}, -1};
}

/// The six faces of a box in inches; two of them with one name.
CadModel box_model() {
  CadModel model;
  model.format = "IGES 5.3";
  model.reader = "isorim";
  model.unit = "in";
  model.unit_in_millimetres = 25.4;
  for (const auto& patch : geometry::box({1.0, 2.0, 3.0}).patches) {
    model.faces.push_back(whole_face(geometry::surface_of(patch.shape)));
  }
  model.faces[1].origin.name = "lid";
  model.faces[4].origin.name = "lid";
  model.faces[2].origin.level = 7;
  for (CadFace& face : model.faces) face.solid = 0;
  return model;
}

/// The unit square in z = 0 with a circular hole; only curves in space.
CadModel plate_model() {
  CadModel model;
  Points<3> corners(3, 4);
  corners << -2, 2, -2, 2,  //
      -2, -2, 2, 2,         //
      0, 0, 0, 0;
  CadFace face = whole_face(NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), corners));
  Points<3> square(3, 5);
  square << -1, 1, 1, -1, -1,  //
      -1, -1, 1, 1, -1,        //
      0, 0, 0, 0, 0;
  geometry::LooseLoop outer;
  for (int i = 0; i < 4; ++i) {
    outer.pieces.push_back(
        {std::nullopt, NurbsCurve<3>::from_points(KnotVector::bezier(1), square.middleCols(i, 2)), -1});
  }
  const NurbsCurve<3> circle = geometry::embed(geometry::circle_curve(0.5));
  face.face.loops = {outer, {{{std::nullopt, circle, -1}}}};
  model.faces.push_back(face);
  return model;
}

std::vector<std::string> names(const AssembledModel& model) {
  std::vector<std::string> list;
  std::visit(
      [&](const auto& boundary) {
        for (const auto& patch : boundary.patches) list.push_back(patch.name);
      },
      model.boundary);
  return list;
}

std::string refusal(const CadModel& model, const AssemblyOptions& options = {}) {
  try {
    assemble(model, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing was refused)";
}

TEST(Assemble, PatchesHaveUniqueNames) {
  const AssembledModel model = assemble(box_model());
  EXPECT_THAT(names(model), ElementsAre("face_1", "lid", "face_3", "face_4", "lid_2", "face_6"));
  EXPECT_EQ(model.facts.solids, 1);
  EXPECT_EQ(model.facts.faces, 6);
  ASSERT_EQ(model.facts.patches.size(), 6U);
  EXPECT_EQ(model.facts.patches[2].origin.level, 7);
}

TEST(Assemble, KeepsEveryBitInTheFilesOwnUnit) {
  const CadModel cad = box_model();
  const AssembledModel model = assemble(cad);
  EXPECT_EQ(model.facts.unit, "in");
  EXPECT_EQ(model.facts.scale, 1.0);
  const auto& boundary = std::get<Boundary<3>>(model.boundary);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(geometry::surface_of(boundary.patches[i].shape).homogeneous(), cad.faces[i].face.surface.homogeneous());
  }
}

TEST(Assemble, ConvertsUnits) {
  CadModel cad = box_model();
  cad.approximations.push_back({"130 at D7", 2.0, 1.0});
  const AssembledModel model = assemble(cad, {.unit = "cm"});
  EXPECT_EQ(model.facts.unit, "cm");
  EXPECT_EQ(model.facts.file_unit, "in");
  EXPECT_DOUBLE_EQ(model.facts.scale, 2.54);
  EXPECT_DOUBLE_EQ(model.facts.approximations[0].deviation, 2.54);
  double largest = 0.0;
  for (const auto& patch : std::get<Boundary<3>>(model.boundary).patches) {
    largest = std::max(largest, geometry::surface_of(patch.shape).control_points().maxCoeff());
  }
  EXPECT_DOUBLE_EQ(largest, 3.0 * 2.54);
}

TEST(Assemble, SelectsByNameAndLevel) {
  EXPECT_THAT(names(assemble(box_model(), {.names = {"lid"}})), ElementsAre("lid", "lid_2"));
  EXPECT_THAT(names(assemble(box_model(), {.levels = {7}})), ElementsAre("face_3"));
  EXPECT_THAT(refusal(box_model(), {.names = {"lod"}}),
              AllOf(HasSubstr("no face is selected"), HasSubstr("the names are \"lid\", the levels 0, 7")));
}

TEST(Assemble, RefusesAModelOfPointsAlone) {
  CadModel model;
  model.points.assign(4, Point3::Zero());
  model.entities.push_back({"116", "point", 4, 0});
  EXPECT_THAT(refusal(model), AllOf(HasSubstr("found 0 faces, 0 curves and 4 points"), HasSubstr("4 x 116 (point)"),
                                    HasSubstr("expected surfaces or curves")));
}

TEST(Assemble, ListsFacesThatCannotBeTaken) {
  CadModel cad = box_model();
  geometry::LoosePiece far;
  far.model_curve = geometry::transform(geometry::embed(geometry::circle_curve(0.1)),
                                        geometry::translation<3>(geometry::Vector3(50.0, 50.0, 50.0)));
  cad.faces[3].face.loops = {{{far}}};
  cad.faces[3].origin.entity = "144 at D9";
  const AssembledModel model = assemble(cad);
  EXPECT_EQ(std::get<Boundary<3>>(model.boundary).patches.size(), 5U);
  EXPECT_EQ(model.facts.patches.size(), 5U);
  ASSERT_EQ(model.facts.refused.size(), 1U);
  EXPECT_EQ(model.facts.refused[0].name, "face_4");
  EXPECT_EQ(model.facts.refused[0].entity, "144 at D9");
  EXPECT_FALSE(model.facts.refused[0].reason.empty());
}

TEST(Assemble, CurvesAloneAreADrawing) {
  CadModel model;
  model.curves.push_back(loose_circle(2.0));
  model.curves.push_back(loose_circle(1.0));
  EXPECT_THAT(names(assemble(model)), ElementsAre("curve_1", "curve_2"));
  EXPECT_THAT(refusal(model, {.dimension = 3}), HasSubstr("expected faces"));
}

TEST(Assemble, CurvesOfNoPlaneAreRefused) {
  CadModel model;
  const NurbsCurve<3> circle = geometry::embed(geometry::circle_curve(2.0));
  const auto turn = geometry::rotation(geometry::Axis{Point3::Zero(), geometry::Vector3::UnitX()}, 0.3);
  model.curves = {{circle, {}}, {geometry::transform(circle, turn), {}}};
  EXPECT_THAT(refusal(model), AllOf(HasSubstr("found 0 faces, 2 curves"), HasSubstr("lie in no plane")));
}

TEST(Assemble, FlatFacesAreADrawingWhenAskedFor) {
  EXPECT_TRUE(std::holds_alternative<Boundary<3>>(assemble(plate_model()).boundary));
  const AssembledModel model = assemble(plate_model(), {.dimension = 2});
  EXPECT_THAT(names(model),
              ElementsAre("face_1_edge_1", "face_1_edge_2", "face_1_edge_3", "face_1_edge_4", "face_1_edge_5"));
  const NurbsCurve<2>& hole = std::get<Boundary<2>>(model.boundary).patches[4].shape;
  for (double t = hole.domain().first; t <= hole.domain().last; t += 0.1 * hole.domain().length()) {
    EXPECT_NEAR(evaluate(hole, t).norm(), 0.5, 1e-15);
  }
}

TEST(Assemble, LooseCurvesBesideFacesAreMentioned) {
  CadModel model = box_model();
  model.curves.push_back(loose_circle(2.0));
  EXPECT_THAT(assemble(model).facts.warnings, ElementsAre(HasSubstr("1 curve that no face uses")));
}

}  // namespace
}  // namespace isorim::io
