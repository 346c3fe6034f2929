#include "io/iges/reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/nurbs/surface.h"
#include "tests/io/cad/real_cases.h"
#include "tests/io/iges/file_text.h"

namespace isorim::io {
namespace {

using geometry::Interval;
using geometry::LoopSides;
using geometry::LooseFace;
using geometry::LooseLoop;
using geometry::LoosePiece;
using geometry::Point2;
using geometry::Point3;
using iges::EntityText;
using iges::FileText;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Parameters with the type number in front, cut into lines behind commas.
std::vector<std::string> lines_of(int type, const std::string& parameters) {
  std::vector<std::string> lines{""};
  std::string rest = std::to_string(type) + "," + parameters + ";";
  while (!rest.empty()) {
    const std::size_t end = rest.find(',');
    const std::string token = rest.substr(0, end == std::string::npos ? end : end + 1);
    if (lines.back().size() + token.size() > 64) lines.emplace_back();
    lines.back() += token;
    rest = rest.substr(token.size());
  }
  return lines;
}

struct Extra {
  int form = 0;
  int matrix = 0;
  std::string status = "00000000";
  int colour = 0;
  int level = 0;
};

/// Entity i (from 0) is D(2 i + 1).
EntityText entity(int type, const std::string& parameters, const Extra& extra = {}) {
  return {type, lines_of(type, parameters), extra.form, extra.matrix, extra.status, extra.colour, extra.level};
}

/// Of what is a part of something else.
const Extra part{.status = "00010000"};

std::string text_of(std::vector<EntityText> entities) {
  FileText text;
  text.entities = std::move(entities);
  return text.text();
}

CadModel read(std::vector<EntityText> entities, const IgesOptions& options = {}) {
  return read_iges(iges::parse(text_of(std::move(entities)), "test.igs"), options);
}

std::string message_of(std::vector<EntityText> entities, const IgesOptions& options = {}) {
  try {
    read(std::move(entities), options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

template <int Dim>
geometry::Point<Dim> start_of(const geometry::NurbsCurve<Dim>& curve) {
  return evaluate(curve, curve.domain().first);
}
template <int Dim>
geometry::Point<Dim> end_of(const geometry::NurbsCurve<Dim>& curve) {
  return evaluate(curve, curve.domain().last);
}

/// The largest distance between the ends of curves in parameter space, as points of the surface, and of their partners.
double largest_end_distance(const LooseFace& face) {
  double largest = 0.0;
  for (const LooseLoop& loop : face.loops)
    for (const LoosePiece& piece : loop.pieces) {
      if (!piece.pcurve || !piece.model_curve) continue;
      const Point3 first = evaluate(face.surface, start_of(*piece.pcurve));
      const Point3 last = evaluate(face.surface, end_of(*piece.pcurve));
      largest = std::max(
          {largest, (first - start_of(*piece.model_curve)).norm(), (last - end_of(*piece.model_curve)).norm()});
    }
  return largest;
}

/// The bilinear surface (2u, 3v, 0) over [0, 1]^2.
const std::string plate =
    "1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,0.,2.,0.,0.,0.,3.,0.,2.,3.,0.,"
    "0.,1.,0.,1.";

std::string pline(double u0, double v0, double u1, double v1) {
  return fmt::format("{},{},0.,{},{},0.", u0, v0, u1, v1);
}

/// A 144 on the plate, D1, bounded by the rectangle of its parameters; more entities from D21 on.
std::vector<EntityText> trimmed_plate() {
  return {entity(144, "3,1,0,5", {.colour = 2, .level = 7}),
          entity(128, plate, part),
          entity(142, "0,3,7,17,1", part),
          entity(102, "4,9,11,13,15", part),
          entity(110, pline(0, 0, 1, 0), part),
          entity(110, pline(1, 0, 1, 1), part),
          entity(110, pline(1, 1, 0, 1), part),
          entity(110, pline(0, 1, 0, 0), part),
          entity(102, "1,19", part),
          entity(106, "2,5,0.,0.,0.,2.,0.,0.,2.,3.,0.,0.,3.,0.,0.,0.,0.", {.form = 12, .status = "00010000"})};
}

TEST(IgesReader, ReadsATrimmedSurface) {
  const CadModel model = read(trimmed_plate());
  EXPECT_EQ(model.format, "IGES 5.3");
  EXPECT_EQ(model.unit, "mm");
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_THAT(model.curves, IsEmpty());
  ASSERT_EQ(model.faces.size(), 1U);
  const CadFace& face = model.faces[0];
  EXPECT_EQ(face.origin.entity, "144 at D1");
  EXPECT_EQ(face.origin.level, 7);
  EXPECT_EQ(face.origin.colour, (Colour{1.0, 0.0, 0.0}));
  EXPECT_EQ(face.solid, -1);
  EXPECT_EQ(face.face.sides, LoopSides::outer_first);
  EXPECT_FALSE(face.face.natural_outer_boundary);
  ASSERT_EQ(face.face.loops.size(), 1U);
  // Four curves in parameter space, one in space: only the former are taken.
  ASSERT_EQ(face.face.loops[0].pieces.size(), 4U);
  for (const LoosePiece& piece : face.face.loops[0].pieces) {
    EXPECT_TRUE(piece.pcurve);
    EXPECT_FALSE(piece.model_curve);
  }
  EXPECT_EQ(end_of(*face.face.loops[0].pieces[1].pcurve), Point2(1.0, 1.0));
  EXPECT_EQ(model.entities.size(), 6U);
  EXPECT_EQ(model.entities[2].type, "110");
  EXPECT_EQ(model.entities[2].count, 4);
  EXPECT_EQ(model.entities[2].description, "line");
}

TEST(IgesReader, TakesTheCurvesThatTheFilePrefersIfTheyCannotBePaired) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[2] = entity(142, "0,3,7,17,2", part);
  const CadModel model = read(entities);
  ASSERT_EQ(model.faces[0].face.loops[0].pieces.size(), 1U);
  EXPECT_TRUE(model.faces[0].face.loops[0].pieces[0].model_curve);
  EXPECT_FALSE(model.faces[0].face.loops[0].pieces[0].pcurve);
}

TEST(IgesReader, OneOfTheTwoCurvesMayBeMissing) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[2] = entity(142, "0,3,0,17,2", part);
  EXPECT_EQ(read(entities).faces[0].face.loops[0].pieces.size(), 1U);
  entities[2] = entity(142, "0,3,7,0,0", part);
  EXPECT_EQ(read(entities).faces[0].face.loops[0].pieces.size(), 4U);
  entities[2] = entity(142, "0,3,0,0,0", part);
  EXPECT_THAT(message_of(entities), AllOf(HasSubstr("test.igs"), HasSubstr("142 at D5"), HasSubstr("has no curve")));
}

TEST(IgesReader, PiecesWrittenBackwardsAreTurned) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[5] = entity(110, pline(1, 1, 1, 0), part);
  entities[4] = entity(110, pline(1, 0, 0, 0), part);
  const CadModel model = read(entities);
  const std::vector<LoosePiece>& pieces = model.faces[0].face.loops[0].pieces;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(end_of(*pieces[i].pcurve), start_of(*pieces[(i + 1) % 4].pcurve));
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("written backwards")));
}

TEST(IgesReader, TheSurfacesOwnBoundaryMayBeTheOuterLoop) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[0] = entity(144, "3,0,1,0,5");
  const LooseFace face = read(entities).faces[0].face;
  EXPECT_TRUE(face.natural_outer_boundary);
  EXPECT_EQ(face.loops.size(), 1U);
  // Said to have one, but it is not there.
  entities[0] = entity(144, "3,1,0,0");
  const CadModel model = read(entities);
  EXPECT_TRUE(model.faces[0].face.natural_outer_boundary);
  EXPECT_THAT(model.faces[0].face.loops, IsEmpty());
  EXPECT_THAT(model.warnings,
              ElementsAre(HasSubstr("142 at D5: bounds no face"), HasSubstr("no outer boundary though it says so")));
}

TEST(IgesReader, NamesAndColoursComeFromTheEntitiesThatDefineThem) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[0] = entity(144, "3,1,0,5,0,1,21", {.colour = -23, .level = -25});
  entities.push_back(entity(406, "1,8HTop side", {.form = 15}));
  entities.push_back(entity(314, "100.,50.,0.,6HOrange"));
  entities.push_back(entity(406, "2,12,13", {.form = 1}));
  const CadModel model = read(entities);
  EXPECT_EQ(model.faces[0].origin.name, "Top side");
  EXPECT_EQ(model.faces[0].origin.colour, (Colour{1.0, 0.5, 0.0}));
  EXPECT_EQ(model.faces[0].origin.level, 12);
}

TEST(IgesReader, BlankedEntitiesAreLeftOutUnlessAskedFor) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[0].status = "01000000";
  const CadModel model = read(entities);
  // Nor does its surface become a face of its own.
  EXPECT_THAT(model.faces, IsEmpty());
  EXPECT_THAT(model.warnings, Contains(AllOf(HasSubstr("144 at D1"), HasSubstr("blanked"))));
  EXPECT_EQ(read(entities, {.include_blanked = true}).faces.size(), 1U);
}

TEST(IgesReader, DependentEntitiesThatNothingUsesAreLeftOutAndTold) {
  const CadModel model = read({entity(128, plate, part), entity(128, plate)});
  EXPECT_EQ(model.faces.size(), 1U);
  EXPECT_EQ(model.faces[0].origin.entity, "128 at D3");
  EXPECT_THAT(model.faces[0].face.loops, IsEmpty());
  EXPECT_THAT(model.warnings, ElementsAre(AllOf(HasSubstr("128 at D1"), HasSubstr("depends on another"))));
}

TEST(IgesReader, TypesThatAreNotReadAreCounted) {
  const CadModel model =
      read({entity(128, plate), entity(150, "1.,2.,3."), entity(150, "1.,2.,3."), entity(5001, "1")});
  EXPECT_THAT(model.warnings, ElementsAre("2 entities of type 150 (block) are not read",
                                          "1 entities of type 5001 (not in the standard) are not read"));
  EXPECT_EQ(model.entities[1].unsupported, 2);
}

TEST(IgesReader, MatricesAreChained) {
  // D5 of the line turns x to y; its own D7 moves along x.
  const CadModel model = read({entity(110, "1.,0.,0.,2.,0.,0.", {.matrix = 3}),
                               entity(124, "0.,-1.,0.,0.,1.,0.,0.,0.,0.,0.,1.,0.", {.matrix = 5}),
                               entity(124, "1.,0.,0.,10.,0.,1.,0.,0.,0.,0.,1.,0.", {.matrix = 7}),
                               entity(124, "-1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.", {.form = 1})});
  ASSERT_EQ(model.curves.size(), 1U);
  EXPECT_EQ(start_of(model.curves[0].curve), Point3(-10.0, 1.0, 0.0));
  EXPECT_EQ(end_of(model.curves[0].curve), Point3(-10.0, 2.0, 0.0));
}

TEST(IgesReader, MatricesOfAFaceMoveItsSurfaceAndItsCurvesInSpaceOnly) {
  std::vector<EntityText> entities = trimmed_plate();
  entities[0] = entity(144, "3,1,0,5", {.matrix = 21});
  entities[2] = entity(142, "0,3,0,17,2", part);
  entities[1].transformation = 23;
  entities.push_back(entity(124, "1.,0.,0.,5.,0.,1.,0.,0.,0.,0.,1.,0."));
  entities.push_back(entity(124, "1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,4."));
  const LooseFace face = read(entities).faces[0].face;
  EXPECT_EQ(evaluate(face.surface, {1.0, 0.0}), Point3(7.0, 0.0, 4.0));
  EXPECT_EQ(start_of(*face.loops[0].pieces[0].model_curve), Point3(5.0, 0.0, 0.0));
}

/// A half circle turned about z: a sphere, whose generatrix has angles from 3 pi / 2 to 5 pi / 2.
std::vector<EntityText> sphere_with(const std::string& first, const std::string& second) {
  return {entity(144, "3,1,0,11"),
          entity(120, "5,7,0.,6.283185307179586", part),
          entity(110, "0.,0.,0.,0.,0.,1.", part),
          entity(100, "0.,0.,0.,0.,-1.,0.,1.", {.matrix = 9, .status = "00010000"}),
          entity(124, "1.,0.,0.,0.,0.,0.,-1.,0.,0.,1.,0.,0."),
          entity(142, "0,3,13,0,1", part),
          entity(102, "2,15,17", part),
          entity(110, first, part),
          entity(110, second, part)};
}

TEST(IgesReader, AnglesMayBeGivenOnAnotherTurn) {
  // From -pi / 2 to pi / 2, a turn below the arc's own, on a quarter of the sphere.
  const CadModel model = read(sphere_with("-1.5707963267948966,1.,0.,1.5707963267948966,1.,0.",
                                          "1.5707963267948966,2.,0.,-1.5707963267948966,2.,0."));
  const LooseFace& face = model.faces[0].face;
  EXPECT_THAT(model.warnings, IsEmpty());
  for (const LoosePiece& piece : face.loops[0].pieces) {
    EXPECT_EQ(piece.pcurve->degree(), 1);
    const Interval domain = face.surface.knots_u().domain();
    for (const Point2& end : {start_of(*piece.pcurve), end_of(*piece.pcurve)})
      EXPECT_NEAR(std::min(std::abs(end.x() - domain.first), std::abs(end.x() - domain.last)), 0.0, 1e-15);
  }
  const Point3 middle = evaluate(face.surface, evaluate(*face.loops[0].pieces[0].pcurve, 0.5));
  EXPECT_LE((middle - Point3(std::cos(1.0), std::sin(1.0), 0.0)).norm(), 1e-15);
}

TEST(IgesReader, SlantedLinesInAnglesAreFittedAndTold) {
  const CadModel model = read(sphere_with("-1.,1.,0.,1.,2.,0.", "1.,2.,0.,-1.,1.,0."));
  const LooseFace& face = model.faces[0].face;
  for (const double s : {0.1, 0.37, 0.8}) {
    const Point3 p = evaluate(face.surface, evaluate(*face.loops[0].pieces[0].pcurve, s));
    const double u = -1.0 + 2.0 * s;
    const double v = 1.0 + s;
    EXPECT_LE((p - Point3(std::cos(u) * std::cos(v), std::cos(u) * std::sin(v), std::sin(u))).norm(), 1e-12);
  }
  ASSERT_EQ(model.approximations.size(), 1U);
  EXPECT_THAT(model.approximations[0].entity, HasSubstr("2 curves in the parameters of round surfaces"));
  EXPECT_LE(model.approximations[0].deviation, model.approximations[0].tolerance);
}

/// A quarter cylinder (122) with one curve across it, in the given parameters, and its partner in space.
std::vector<EntityText> tabulated(const std::string& pcurve) {
  return {entity(144, "3,1,0,9"),    entity(122, "5,2.,0.,3.", part), entity(100, "0.,0.,0.,2.,0.,0.,2.", part),
          entity(110, pcurve, part), entity(142, "0,3,7,11,1", part), entity(110, "0.,2.,0.,0.,2.,3.", part)};
}

TEST(IgesReader, OtherConventionsAreRecognisedByTheCurvesInSpace) {
  // The standard has u in [0, 1]; some programs write the directrix's own parameter.
  const CadModel standard = read(tabulated("1.,0.,0.,1.,1.,0."));
  EXPECT_THAT(standard.warnings, IsEmpty());
  EXPECT_LE(largest_end_distance(standard.faces[0].face), 1e-15);
  const CadModel other = read(tabulated("1.5707963267948966,0.,0.,1.5707963267948966,1.,0."));
  EXPECT_THAT(other.warnings, ElementsAre(HasSubstr("another convention")));
  EXPECT_LE(largest_end_distance(other.faces[0].face), 1e-15);
}

TEST(IgesReader, CurvesInSpaceThatLieElsewhereAreDropped) {
  std::vector<EntityText> entities = tabulated("1.,0.,0.,1.,1.,0.");
  entities[5] = entity(110, "9.,2.,0.,9.,2.,3.", part);
  const CadModel model = read(entities);
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("lie elsewhere")));
  EXPECT_FALSE(model.faces[0].face.loops[0].pieces[0].model_curve);
}

TEST(IgesReader, CurvesInSpaceRunAsTheirPartners) {
  std::vector<EntityText> entities = tabulated("1.,0.,0.,1.,1.,0.");
  entities[5] = entity(110, "0.,2.,3.,0.,2.,0.", part);
  EXPECT_LE(largest_end_distance(read(entities).faces[0].face), 1e-15);
}

TEST(IgesReader, BoundedSurfacesKeepTheirDirections) {
  const std::vector<EntityText> entities{entity(143, "1,3,1,5"),
                                         entity(128, plate, part),
                                         entity(141, "1,3,3,2,7,1,1,11,9,2,1,13", part),
                                         entity(110, "0.,0.,0.,2.,3.,0.", part),
                                         entity(110, "0.,0.,0.,2.,3.,0.", part),
                                         entity(110, pline(0, 0, 1, 1), part),
                                         entity(110, pline(1, 1, 0, 0), part)};
  const CadModel model = read(entities);
  const LooseFace& face = model.faces[0].face;
  EXPECT_EQ(face.sides, LoopSides::left);
  ASSERT_EQ(face.loops[0].pieces.size(), 2U);
  EXPECT_EQ(largest_end_distance(face), 0.0);
  EXPECT_EQ(start_of(*face.loops[0].pieces[1].model_curve), Point3(2.0, 3.0, 0.0));
}

/// A unit sphere (196) as a solid, its poles told by vertices.
std::vector<EntityText> sphere_solid() {
  return {entity(186, "3,1,0", {.colour = 3}),
          entity(514, "1,5,1", {.form = 1, .status = "00010000"}),
          entity(510, "7,1,1,15", {.form = 1, .status = "00010000"}),
          entity(196, "9,1.,11,13", {.form = 1, .status = "00010000"}),
          entity(116, "0.,0.,0.", part),
          entity(123, "0.,0.,1.", part),
          entity(123, "1.,0.,0.", part),
          entity(508, "4,1,17,1,0,1,0,19,0,21,1,0,1,0,27,1,17,2,1,1,0,29,0,21,1,1,1,0,31",
                 {.form = 1, .status = "00010000"}),
          entity(502, "2,0.,0.,1.,0.,0.,-1.", {.form = 1, .status = "00010000"}),
          entity(110, "360.,90.,0.,0.,90.,0.", part),
          entity(504, "1,23,17,2,17,1", {.form = 1, .status = "00010001"}),
          entity(100, "0.,0.,0.,0.,-1.,0.,1.", {.matrix = 25, .status = "00010000"}),
          entity(124, "1.,0.,0.,0.,0.,0.,-1.,0.,0.,1.,0.,0."),
          entity(110, "0.,90.,0.,0.,-90.,0.", part),
          entity(110, "0.,-90.,0.,360.,-90.,0.", part),
          entity(110, "360.,-90.,0.,360.,90.,0.", part)};
}

TEST(IgesReader, ReadsASolidWithPolesAndASeam) {
  const CadModel model = read(sphere_solid());
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_THAT(model.curves, IsEmpty());
  ASSERT_EQ(model.faces.size(), 1U);
  const CadFace& face = model.faces[0];
  EXPECT_EQ(face.solid, 0);
  EXPECT_EQ(face.origin.colour, (Colour{0.0, 1.0, 0.0}));
  EXPECT_EQ(face.face.sides, LoopSides::left);
  ASSERT_EQ(face.face.loops[0].pieces.size(), 4U);
  EXPECT_LE(largest_end_distance(face.face), 1e-15);
  const std::vector<LoosePiece>& pieces = face.face.loops[0].pieces;
  EXPECT_EQ(pieces[0].edge, -1);
  EXPECT_FALSE(pieces[0].model_curve);
  // Both sides of the seam are one edge.
  EXPECT_EQ(pieces[1].edge, 0);
  EXPECT_EQ(pieces[3].edge, 0);
  EXPECT_EQ(start_of(*pieces[3].pcurve), Point2(1.0, 0.0));
  EXPECT_EQ(end_of(*pieces[3].pcurve), Point2(1.0, 1.0));
}

TEST(IgesReader, AnglesInRadiansAreRecognised) {
  std::vector<EntityText> entities = sphere_solid();
  entities[9] = entity(110, "6.283185307179586,1.5707963267948966,0.,0.,1.5707963267948966,0.", part);
  entities[13] = entity(110, "0.,1.5707963267948966,0.,0.,-1.5707963267948966,0.", part);
  entities[14] = entity(110, "0.,-1.5707963267948966,0.,6.283185307179586,-1.5707963267948966,0.", part);
  entities[15] = entity(110, "6.283185307179586,-1.5707963267948966,0.,6.283185307179586,1.5707963267948966,0.", part);
  const CadModel model = read(entities);
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("another convention")));
  EXPECT_LE(largest_end_distance(model.faces[0].face), 1e-15);
}

TEST(IgesReader, SolidsAreCopiedWithEdgesOfTheirOwn) {
  std::vector<EntityText> entities = sphere_solid();
  entities[0].status = "00010000";
  entities.push_back(entity(430, "1", {.form = 1, .matrix = 37}));
  entities.push_back(entity(430, "1", {.form = 1}));
  entities.push_back(entity(124, "1.,0.,0.,5.,0.,1.,0.,0.,0.,0.,1.,0."));
  const CadModel model = read(entities);
  ASSERT_EQ(model.faces.size(), 2U);
  EXPECT_EQ(model.faces[0].solid, 0);
  EXPECT_EQ(model.faces[1].solid, 1);
  EXPECT_NE(model.faces[0].face.loops[0].pieces[1].edge, model.faces[1].face.loops[0].pieces[1].edge);
  EXPECT_LE((evaluate(model.faces[0].face.surface, {0.0, 1.0}) - Point3(5.0, 0.0, 1.0)).norm(), 1e-15);
  EXPECT_LE(largest_end_distance(model.faces[0].face), 1e-15);
}

TEST(IgesReader, TopologyThatPointsNowhereIsRefusedWithItsPlace) {
  const std::vector<EntityText> good = sphere_solid();
  std::vector<EntityText> bad = good;
  bad[7] = entity(508, "1,0,21,2,1,0", {.form = 1, .status = "00010000"});
  EXPECT_THAT(message_of(bad), AllOf(HasSubstr("508 at D15"), HasSubstr("edge 2 of 504 at D21, which has 1")));
  bad = good;
  bad[10] = entity(504, "1,23,17,3,17,1", {.form = 1, .status = "00010001"});
  EXPECT_THAT(message_of(bad), AllOf(HasSubstr("504 at D21"), HasSubstr("vertex 3")));
  bad = good;
  bad[2] = entity(510, "23,1,1,15", {.form = 1, .status = "00010000"});
  EXPECT_THAT(message_of(bad), AllOf(HasSubstr("100 at D23"), HasSubstr("a surface")));
  bad = good;
  bad[3] = entity(196, "9,-1.,11,13", {.form = 1, .status = "00010000"});
  EXPECT_THAT(message_of(bad), AllOf(HasSubstr("196 at D7"), HasSubstr("radius is -1")));
}

TEST(IgesReader, EdgesOnLinesWithoutEndsEndAtTheirVertices) {
  const std::vector<EntityText> entities{
      entity(510, "3,1,1,7", {.form = 1}),
      entity(190, "5,19", {.status = "00010000"}),
      entity(116, "0.,0.,0.", part),
      entity(508, "2,0,9,1,1,0,0,9,2,1,0", {.form = 1, .status = "00010000"}),
      entity(504, "2,11,15,1,15,2,13,15,2,15,1", {.form = 1, .status = "00010001"}),
      entity(110, "0.,0.,0.,1.,0.,0.", {.form = 2, .status = "00010600"}),
      entity(106, "2,3,4.,0.,0.,4.,2.,0.,0.,0.,0.", {.form = 12, .status = "00010000"}),
      entity(502, "2,0.,0.,0.,4.,0.,0.", {.form = 1, .status = "00010000"}),
      entity(124, "1.,0.,0.,5.,0.,1.,0.,0.,0.,0.,1.,0."),
      entity(123, "0.,0.,1.", part)};
  const CadModel model = read(entities);
  const LooseFace& face = model.faces[0].face;
  ASSERT_EQ(face.loops[0].pieces.size(), 2U);
  EXPECT_EQ(end_of(*face.loops[0].pieces[0].model_curve), Point3(4.0, 0.0, 0.0));
  EXPECT_NE(face.loops[0].pieces[0].edge, face.loops[0].pieces[1].edge);
  // The plane reaches as far as its loop.
  EXPECT_EQ(evaluate(face.surface, {face.surface.knots_u().domain().last, face.surface.knots_v().domain().last}),
            Point3(4.0, 2.0, 0.0));
}

TEST(IgesReader, BoundedPlanesAreFaces) {
  const CadModel model = read({entity(108, "0.,0.,2.,6.,3,0.,0.,3.,1.", {.form = 1}),
                               entity(106, "1,5,3.,0.,0.,1.,1.,0.,2.,-1.,1.,0.,0.", {.form = 63, .status = "00010000"}),
                               entity(108, "0.,0.,1.,0.,0,0.,0.,0.,0.")});
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_NEAR(evaluate(model.faces[0].face.surface, {0.0, 0.0}).z(), 3.0, 1e-15);
  EXPECT_THAT(model.warnings, ElementsAre(AllOf(HasSubstr("108 at D5"), HasSubstr("without ends"))));
}

TEST(IgesReader, BoundedPlanesHaveTheHolesOfTheirChildren) {
  const CadModel model =
      read({entity(108, "0.,0.,1.,0.,3,0.,0.,0.,0.", {.form = 1}),
            entity(106, "1,5,0.,0.,0.,4.,0.,4.,4.,0.,4.,0.,0.", {.form = 63, .status = "00010000"}),
            entity(108, "0.,0.,1.,0.,7,0.,0.,0.,0.", {.form = -1, .status = "00010000"}),
            entity(106, "1,5,0.,1.,1.,2.,1.,2.,2.,1.,2.,1.,1.", {.form = 63, .status = "00010000"}),
            entity(402, "1,1,1,5", {.form = 9}), entity(108, "0.,0.,1.,0.,7,0.,0.,0.,0.", {.form = -1})});
  ASSERT_EQ(model.faces.size(), 1U);
  ASSERT_EQ(model.faces[0].face.loops.size(), 2U);
  EXPECT_EQ(start_of(*model.faces[0].face.loops[1].pieces[0].model_curve), Point3(1.0, 1.0, 0.0));
  EXPECT_THAT(model.warnings, ElementsAre(AllOf(HasSubstr("108 at D11"), HasSubstr("hole of no plane"))));
}

TEST(IgesReader, SubfiguresAreScaledTurnedAndMoved) {
  // The inner figure holds a line; the outer one an instance of it at twice the size.
  const CadModel model =
      read({entity(408, "3,10.,0.,0.,3.", {.matrix = 13}), entity(308, "1,5HOuter,1,5", {.status = "00000200"}),
            entity(408, "7,0.,1.,0.,2.", part), entity(308, "0,5HInner,2,9,11", {.status = "00000200"}),
            entity(110, "1.,0.,0.,2.,0.,0.", part), entity(116, "0.,0.,1.", {.status = "01010000"}),
            entity(124, "0.,-1.,0.,0.,1.,0.,0.,0.,0.,0.,1.,0.")});
  ASSERT_EQ(model.curves.size(), 1U);
  // (1, 0, 0) -> (2, 1, 0) -> (6, 3, 0) -> (-3, 6, 0) -> (7, 6, 0)
  EXPECT_LE((start_of(model.curves[0].curve) - Point3(7.0, 6.0, 0.0)).norm(), 1e-14);
  EXPECT_THAT(model.points, IsEmpty());
  EXPECT_THAT(model.warnings, ElementsAre(AllOf(HasSubstr("116 at D11"), HasSubstr("blanked"))));
}

TEST(IgesReader, GroupsLeaveTheirMembersAlone) {
  const CadModel model =
      read({entity(402, "2,3,5", {.form = 1}), entity(110, "0.,0.,0.,1.,0.,0.", {.status = "00020000"}),
            entity(110, "0.,1.,0.,1.,1.,0.", {.status = "00020000"})});
  EXPECT_EQ(model.curves.size(), 2U);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(IgesReader, PointsAndCurvesOnTheirOwnAreKept) {
  const CadModel model =
      read({entity(116, "1.,2.,3.,0"), entity(106, "1,2,5.,0.,0.,1.,1.", {.form = 1}),
            entity(106, "1,3,0.,0.,0.,1.,0.,1.,1.", {.form = 63}), entity(102, "2,9,11"),
            entity(110, "0.,0.,0.,1.,0.,0.", part), entity(110, "1.,0.,0.,2.,0.,0.", part),
            entity(110, "0.,0.,0.,1.,0.,0.", {.form = 2}), entity(110, "0.,0.,0.,1.,0.,0.", {.status = "00000600"})});
  ASSERT_EQ(model.points.size(), 3U);
  EXPECT_EQ(model.points[2], Point3(1.0, 1.0, 5.0));
  ASSERT_EQ(model.curves.size(), 3U);
  // Form 63 is closed, whether its file says so or not.
  EXPECT_EQ(end_of(model.curves[0].curve), Point3(0.0, 0.0, 0.0));
  EXPECT_EQ(model.curves[1].origin.entity, "102 at D7");
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("line without ends"), HasSubstr("use flag")));
}

TEST(IgesReader, WhatHasNoExactFormIsListed) {
  // The parabolic sheet (u, v, u^2): of 16 coefficients each, x has that of s, y of t, z of s^2.
  std::string sheet = "3,0,1,1,0.,1.,0.,1.";
  for (const int place : {1, 4, 2})
    for (int k = 0; k < 16; ++k) sheet += k == place ? ",1." : ",0.";
  const CadModel model = read(
      {entity(130, "3,1,0,0,0,0.5,0.,0.,0.,0.,0.,1.,0.,3."), entity(104, "0.25,0.,1.,0.,0.,-1.,0.,2.,0.,2.,0.", part),
       entity(118, "7,9,0,0"), entity(104, "1.,0.,0.,0.,-1.,0.,0.,0.,0.,1.,1.", part),
       entity(110, "0.,0.,1.,1.,0.,1.", part), entity(140, "0.,0.,1.,0.25,13"), entity(114, sheet, part)});
  EXPECT_EQ(model.curves.size(), 1U);
  EXPECT_EQ(model.faces.size(), 2U);
  ASSERT_EQ(model.approximations.size(), 3U);
  EXPECT_EQ(model.approximations[0].entity, "130 (offset curve) at D1");
  EXPECT_EQ(model.approximations[1].entity, "118 (surface ruled by arc length) at D5");
  EXPECT_EQ(model.approximations[2].entity, "140 (offset surface) at D11");
  for (const Approximation& approximation : model.approximations)
    EXPECT_LE(approximation.deviation, approximation.tolerance) << approximation.entity;
  // The sheet moved along its normal, which is z at u = 0.
  EXPECT_LE((evaluate(model.faces[1].face.surface, {0.0, 0.5}) - Point3(0.0, 0.5, 0.25)).norm(), 1e-10);
}

TEST(IgesReader, OffsetsOfEndlessSurfacesAreExact) {
  std::vector<EntityText> entities = sphere_solid();
  entities[2] = entity(510, "33,1,1,15", {.form = 1, .status = "00010000"});
  entities.push_back(entity(140, "1.,0.,0.,0.5,7", part));
  entities[10] = entity(504, "1,35,17,2,17,1", {.form = 1, .status = "00010001"});
  entities.push_back(entity(100, "0.,0.,0.,0.,-1.5,0.,1.5", {.matrix = 25, .status = "00010000"}));
  const CadModel model = read(entities);
  EXPECT_THAT(model.approximations, IsEmpty());
  EXPECT_LE(largest_end_distance(model.faces[0].face), 1e-15);
}

TEST(IgesReader, FlagsThatContradictTheDataAreToldOnce) {
  const std::string weighted = "2,2,0,0,1,0,0.,0.,0.,1.,1.,1.,1.,0.5,1.,0.,0.,0.,1.,1.,0.,2.,0.,0.,0.,1.,0.,0.,1.";
  const CadModel model = read({entity(126, weighted), entity(126, weighted)});
  EXPECT_FALSE(model.curves[0].curve.is_polynomial());
  EXPECT_THAT(model.warnings, ElementsAre(AllOf(HasSubstr("126 at D1 and 1 more"), HasSubstr("PROP3"))));
}

TEST(IgesReader, WeightsThatAreNotPositiveAreRefusedWithTheEntity) {
  const auto curve = [](const std::string& weight) {
    return entity(126, "2,2,0,0,0,0,0.,0.,0.,1.,1.,1.,1.," + weight + ",1.,0.,0.,0.,1.,1.,0.,2.,0.,0.,0.,1.,0.,0.,1.");
  };
  EXPECT_THAT(message_of({curve("0.")}), AllOf(HasSubstr("test.igs: 126 at D1"), HasSubstr("weight 1 is 0")));
  EXPECT_THAT(message_of({curve("-0.5")}), HasSubstr("weight 1 is -0.5"));
}

TEST(IgesReader, BadEntitiesMayBeSkippedAndAreAllTold) {
  const std::vector<EntityText> entities{entity(110, "0.,0.,0.,1.,0.,0."), entity(100, "0.,0.,0.,0.,0.,1.,0."),
                                         entity(110, "0.,0.")};
  EXPECT_THAT(message_of(entities),
              AllOf(HasSubstr("2 entities cannot be read"), HasSubstr("100 at D3"), HasSubstr("110 at D5")));
  const CadModel model = read(entities, {.skip_bad_entities = true});
  EXPECT_EQ(model.curves.size(), 1U);
  EXPECT_THAT(model.warnings,
              ElementsAre(AllOf(HasSubstr("left out"), HasSubstr("100 at D3")), HasSubstr("110 at D5")));
}

TEST(IgesReader, ScalesOfTheModelSpaceAreTakenBack) {
  FileText text;
  text.global[1] = "2.,2,2HMM,1,0.01,15H20260101.000000,1E-6,10.,2HMe,4HHere,11,0,";
  text.entities = {entity(110, "0.,0.,0.,3.,0.,0.")};
  const CadModel model = read_iges(iges::parse(text.text(), "test.igs"));
  EXPECT_EQ(end_of(model.curves[0].curve), Point3(1.5, 0.0, 0.0));
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("scale of 2")));
}

TEST(IgesReader, CirclesOfPointersAreRefused) {
  EXPECT_THAT(message_of({entity(102, "2,3,5"), entity(102, "1,5", part), entity(102, "1,3", part)}),
              HasSubstr("refers to itself"));
  EXPECT_THAT(message_of({entity(110, "0.,0.,0.,1.,0.,0.", {.matrix = 3}),
                          entity(124, "1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.", {.matrix = 3})}),
              HasSubstr("without end"));
  EXPECT_THAT(message_of({entity(408, "3,0.,0.,0.,1."), entity(308, "0,1HA,1,5"), entity(408, "3,0.,0.,0.,1.", part)}),
              AnyOf(HasSubstr("refers to itself"), HasSubstr("amount to more")));
  EXPECT_THAT(message_of({entity(144, "3,1,0,5"), entity(140, "0.,0.,1.,1.,3", part), entity(142, "0,3,0,3,1", part)}),
              HasSubstr("refers to itself"));
}

TEST(IgesReader, NestingWithoutEndIsRefused) {
  std::vector<EntityText> deep;
  for (int i = 0; i < 5000; ++i) deep.push_back(entity(102, std::to_string(1) + "," + std::to_string(2 * i + 3), part));
  deep[0].status = "00000000";
  deep.push_back(entity(110, "0.,0.,0.,1.,0.,0.", part));
  EXPECT_THAT(message_of(deep), HasSubstr("nested deeper"));
  // Twice as many curves on each level.
  std::vector<EntityText> wide;
  for (int i = 0; i < 60; ++i) wide.push_back(entity(102, fmt::format("2,{},{}", 2 * i + 3, 2 * i + 3), part));
  wide[0].status = "00000000";
  wide.push_back(entity(110, "0.,0.,0.,1.,0.,0.", part));
  EXPECT_THAT(message_of(wide, {.largest_size = 100'000}), HasSubstr("more than 100000 numbers"));
}

TEST(IgesReader, CountsBeyondTheRecordAreRefused) {
  EXPECT_THAT(message_of({entity(126, "2000000000,3,0,0,0,0,0.,1.")}),
              AllOf(HasSubstr("126 at D1"), HasSubstr("2000000000")));
  EXPECT_THAT(message_of({entity(128, "60000,60000,1,1,0,0,0,0,0,0.,1.")}), HasSubstr("60000"));
  EXPECT_THAT(message_of({entity(114, "3,0,50000,50000,0.,1.")}), HasSubstr("114 at D1"));
  EXPECT_THAT(message_of({entity(112, "3,0,3,2000000000,0.,1.")}), HasSubstr("112 at D1"));
  EXPECT_THAT(message_of({entity(102, "2000000000,1")}), HasSubstr("102 at D1"));
}

TEST(IgesReader, CurvesInParameterSpaceMeetThoseInSpaceInAllMadeFiles) {
  const std::filesystem::path folder = std::filesystem::path(ISORIM_SOURCE_DIR) / "cases/cad";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".igs") continue;
    ++files;
    const CadModel model = read_iges(entry.path());
    const bool has_all_digits = entry.path().stem().string().ends_with("_p17");
    for (const CadFace& face : model.faces)
      EXPECT_LE(largest_end_distance(face.face), has_all_digits ? 5e-14 : 2e-9) << entry.path() << face.origin.entity;
    EXPECT_EQ(model.warnings, std::vector<std::string>{}) << entry.path();
  }
  EXPECT_EQ(files, 100);
}

TEST(IgesReader, RealFilesArriveWithAllTheirFaces) {
  const std::filesystem::path folder = real_cases();
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
  struct Expectation {
    const char* file;
    std::size_t faces;
    const char* unit;
    /// How well curves in parameter space and in space agree in this file, in its unit.
    double distance;
  };
  const Expectation expectations[] = {{"bladex_propeller_and_shaft.igs", 22, "mm", 5e-3},
                                      {"bladex_shaft.igs", 7, "m", 1e-7},
                                      {"bladex_upper.igs", 1, "mm", 1e-12},
                                      {"ext2mesh_piece.igs", 15, "mm", 0.0},
                                      {"ext2mesh_srfOfRev.igs", 14, "in", 1e-11},
                                      {"igesio_rounded_cube.igs", 7, "mm", 1e-7},
                                      {"poseidon_Pump_Carriage.igs", 111, "mm", 0.0},
                                      {"poseidon_Pump_Cover_Slide.igs", 16, "mm", 0.0},
                                      {"poseidon_Scope_Base.igs", 248, "mm", 0.0},
                                      {"pygem_test_pipe.igs", 4, "m", 1e-8},
                                      {"pygem_test_pipe_hollow.igs", 6, "m", 1e-5},
                                      {"pyiges_sample.igs", 0, "m", 0.0}};
  for (const Expectation& expected : expectations) {
    const CadModel model = read_iges(folder / expected.file);
    EXPECT_EQ(model.faces.size(), expected.faces) << expected.file;
    EXPECT_EQ(model.unit, expected.unit) << expected.file;
    EXPECT_THAT(model.curves, IsEmpty()) << expected.file;
    for (const CadFace& face : model.faces)
      EXPECT_LE(largest_end_distance(face.face), expected.distance) << expected.file << " " << face.origin.entity;
  }
}

}  // namespace
}  // namespace isorim::io
