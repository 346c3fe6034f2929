#include "io/iges/t_splines.h"

#include <algorithm>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "io/iges/reader.h"
#include "io/iges/writer.h"
#include "tests/geometry/random_splines.h"
#include "tests/geometry/tspline/extracted_surfaces.h"
#include "tests/io/tspline/expect_same.h"

namespace isorim::io::iges {
namespace {

using geometry::Boundary;
using geometry::ExtractedSurface;
using geometry::OrientedBoundary;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A torus with hanging edges.
Boundary<3> torus() {
  Boundary<3> boundary = geometry::testing::extracted(geometry::torus(3.0, 1.0, {0.1, 0.2, 0.3}));
  const auto& whole = std::get<ExtractedSurface>(boundary.patches[0].shape);
  boundary.patches[0].shape =
      geometry::testing::cut_element(geometry::testing::cut_element(whole, 3, 0, 0.3), 7, 1, 0.6);
  return boundary;
}

const ExtractedSurface& surface_at(const Boundary<3>& boundary, std::size_t patch = 0) {
  return std::get<ExtractedSurface>(boundary.patches[patch].shape);
}

std::string text_of(const Boundary<3>& boundary, Form form = Form::solids) {
  return iges_text(orient(boundary), {.form = form, .title = "T-spline", .date = "20260101.120000"}).text;
}

CadModel read_back(const std::string& text) {
  return read_iges(parse(text, "written.igs"));
}

/// The file with every line changed by the function, which sees columns 1 to 72 and the section's letter.
template <class Change>
std::string changed(const std::string& text, Change change) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    std::string line = text.substr(at, end - at);
    std::string columns = line.substr(0, 72);
    change(columns, line[72]);
    result += columns.substr(0, 72) + line.substr(72) + '\n';
    at = end + 1;
  }
  return result;
}

TEST(IgesTSplines, WhatIsWrittenIsReadBitForBit) {
  geometry::testing::Random random(21);
  for (int trial = 0; trial < 10; ++trial) {
    const auto u = geometry::testing::random_knots(random, random.integer(1, 4));
    const auto v = geometry::testing::random_knots(random, random.integer(1, 4));
    const Boundary<3> boundary{
        {{"sheet", geometry::extracted_surface(geometry::testing::random_surface<3>(random, u, v)), 1}}};
    OrientedBoundary<3> oriented{boundary, {}};
    oriented.topology.shells.push_back({{0}, false, false});
    const CadModel model = read_back(iges_text(oriented).text);
    EXPECT_THAT(model.warnings, IsEmpty());
    EXPECT_THAT(model.faces, IsEmpty());
    ASSERT_EQ(model.t_splines.size(), 1u);
    tspline::expect_same_bits(model.t_splines[0].surface, surface_at(boundary));
    EXPECT_EQ(model.t_splines[0].origin.name, "sheet");
  }
}

TEST(IgesTSplines, BothFormsKeepNamesColoursAndOtherPatches) {
  Boundary<3> boundary = torus();
  boundary.patches.push_back({"again", boundary.patches[0].shape, 1});
  geometry::AffineMap<3> aside;
  aside.translation << 10, 0, 0;
  boundary.patches[1].shape = transform(surface_at(boundary, 1), aside);
  boundary.patches.push_back(
      {"ball", transform(geometry::sphere(1.0).patches[0].shape, {aside.linear, -aside.translation}), 1});
  for (const Form form : {Form::solids, Form::faces}) {
    const OrientedBoundary<3> oriented = orient(boundary);
    WriterOptions options{.form = form, .looks = {{Colour{1, 0, 0}, 3}, {}, {}}};
    const IgesText file = iges_text(oriented, options);
    EXPECT_EQ(file.report.solids, form == Form::solids ? 1 : 0);
    const CadModel model = read_back(file.text);
    EXPECT_THAT(model.warnings, IsEmpty());
    ASSERT_EQ(model.t_splines.size(), 2u);
    EXPECT_EQ(model.faces.size(), 1u);
    for (std::size_t i = 0; i < 2; ++i) tspline::expect_same_bits(model.t_splines[i].surface, surface_at(boundary, i));
    EXPECT_EQ(model.t_splines[0].origin.name, boundary.patches[0].name);
    EXPECT_EQ(model.t_splines[0].origin.level, 3);
    EXPECT_EQ(model.t_splines[0].origin.colour, (Colour{1, 0, 0}));
    EXPECT_EQ(model.t_splines[1].origin.name, "again");
  }
}

TEST(IgesTSplines, OtherProgramsSeeTheElementsInAnOrderedGroup) {
  const Boundary<3> boundary = torus();
  const File file = parse(text_of(boundary), "written.igs");
  const auto count = [&](int type, int form) {
    return std::ranges::count_if(file.entities, [&](const Entity& e) { return e.type == type && e.form == form; });
  };
  EXPECT_EQ(count(128, 0), static_cast<long>(surface_at(boundary).elements().size()));
  EXPECT_EQ(count(402, 15), 1);
  EXPECT_EQ(count(406, 15), 1);
  EXPECT_EQ(count(406, 27), 1);
  for (const Entity& entity : file.entities) {
    if (entity.type != 128) continue;
    EXPECT_EQ(entity.subordinate, 2);
    Parameters p(file, entity);
    EXPECT_EQ(p.integer(), 2);
  }
}

/// As readers see the file that know nothing of the group: the surfaces alone.
TEST(IgesTSplines, TheSurfacesAloneAreTheSameBoundary) {
  const Boundary<3> boundary = torus();
  const std::string text = changed(text_of(boundary), [](std::string& line, char section) {
    const std::size_t at = line.find("8HT-spline");
    if (section == 'P' && at != std::string::npos) line[at + 2] = 'X';
  });
  const CadModel model = read_back(text);
  EXPECT_THAT(model.t_splines, IsEmpty());
  ASSERT_EQ(model.faces.size(), surface_at(boundary).elements().size());
  for (std::size_t e = 0; e < model.faces.size(); ++e) {
    const auto wanted = bezier_surface(surface_at(boundary), static_cast<int>(e));
    EXPECT_LE((model.faces[e].face.surface.homogeneous() - wanted.homogeneous()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(IgesTSplines, EditedSurfacesAreUsedAndTold) {
  const Boundary<3> boundary = torus();
  bool edited = false;
  const std::string text = changed(text_of(boundary), [&](std::string& line, char section) {
    const std::size_t at = line.find("4.1,");
    if (edited || section != 'P' || line.find('H') != std::string::npos || at == std::string::npos) return;
    line.replace(at, 4, "4.2,");
    edited = true;
  });
  ASSERT_TRUE(edited);
  const CadModel model = read_back(text);
  EXPECT_THAT(model.t_splines, IsEmpty());
  EXPECT_EQ(model.faces.size(), surface_at(boundary).elements().size());
  EXPECT_THAT(model.warnings, Contains(AllOf(HasSubstr("have been edited since"), HasSubstr("is not element"))));
}

TEST(IgesTSplines, ADamagedTextIsToldAndTheSurfacesAreUsed) {
  const Boundary<3> boundary = torus();
  const std::string text = changed(text_of(boundary), [&](std::string& line, char section) {
    if (section == 'P' && line.find("elemN 18") != std::string::npos)
      line.replace(line.find("elemN 18"), 8, "elemN 19");
  });
  ASSERT_NE(text, text_of(boundary));
  const CadModel model = read_back(text);
  EXPECT_THAT(model.t_splines, IsEmpty());
  EXPECT_EQ(model.faces.size(), 18u);
  EXPECT_THAT(model.warnings, Contains(AllOf(HasSubstr("damaged T-spline"), HasSubstr("digest"))));
}

TEST(IgesTSplines, NinePrintedDecimalsAreNoEdit) {
  const Boundary<3> boundary = torus();
  // Points and weights with ten digits, as programs print that rewrite files; strings stay.
  bool in_strings = false;
  const std::string text = changed(text_of(boundary), [&](std::string& line, char section) {
    in_strings = in_strings || (section == 'P' && line.find("8HT-spline") != std::string::npos);
    if (section != 'P' || in_strings) return;
    const std::size_t at = line.find("0.7071067811865476,");
    if (at != std::string::npos) line.replace(at, 19, "0.7071067812,      ");
  });
  ASSERT_NE(text, text_of(boundary));
  const CadModel model = read_back(text);
  ASSERT_EQ(model.t_splines.size(), 1u);
  tspline::expect_same_bits(model.t_splines[0].surface, surface_at(boundary));
}

TEST(IgesTSplines, TheDigestIsFnv1a) {
  EXPECT_EQ(digest_of(""), 0xcbf29ce484222325U);
  EXPECT_EQ(digest_of("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(digest_of("foobar"), 0x85944171f73967e8U);
}

}  // namespace
}  // namespace isorim::io::iges
