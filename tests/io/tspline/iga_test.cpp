#include "io/tspline/iga.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/solids.h"
#include "tests/geometry/random_splines.h"
#include "tests/geometry/tspline/extracted_surfaces.h"
#include "tests/io/tspline/expect_same.h"

namespace isorim::io::tspline {
namespace {

using geometry::ExtractedSurface;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Two bilinear squares side by side, with all that the format has.
const char* const two_squares = R"(# a comment
type surface   # and another
nodeN 6
elemN 2

node 0 0 0 1
node 1 0 0 1
node 2.5e0 0 0 2
node 0 1 0 1
node +1 1 0 1
node 2 1 0 1
belem 4 1 1
0 1 3 4
1 0 0 0
0 1 0 0
0 0 1 0
0 0 0 1
belem 4 1 1
1 2 4 5
1 0 0 0  0 1 0 0  0 0 1 0
0 0 0 1
set 2 node corners 0 2
set 1 elem left 0
set 2 side ends 0 LEFT 1 RIGHT
domain 2 6
0 1
0 1 2 3 4 5
0
1
)";

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), by);
}

std::string refusal(const std::string& text) {
  try {
    model_of(parse_iga(text), "iga");
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing was refused)";
}

TEST(Iga, ReadsEverythingThatTheFormatHas) {
  const ExtractionData data = parse_iga(two_squares);
  ASSERT_EQ(data.elements.size(), 2u);
  ASSERT_EQ(data.points.cols(), 6);
  EXPECT_EQ(data.points.col(2), Eigen::Vector4d(5, 0, 0, 2)) << "points are multiplied by their weight";
  EXPECT_THAT(data.elements[1].functions, ::testing::ElementsAre(1, 2, 4, 5));
  EXPECT_EQ(data.elements[1].rows, Eigen::MatrixXd::Identity(4, 4));
  EXPECT_THAT(data.warnings,
              ::testing::ElementsAre("sets are not used: corners (2 node), left (1 elem), ends (2 side)"));
  ASSERT_EQ(data.entities.size(), 3u);
  EXPECT_EQ(data.entities[2].count, 3);
}

TEST(Iga, ReadsLinesInAnyOrderAndOtherEnds) {
  const std::string text = two_squares;
  const std::size_t nodes = text.find("node 0");
  const std::size_t elements = text.find("belem");
  const std::size_t sets = text.find("set");
  std::string shuffled = text.substr(elements, sets - elements) + text.substr(nodes, elements - nodes) +
                         text.substr(sets, text.find("domain") - sets) + "\telemN 2\r\nnodeN 6\r\ntype plane";
  const ExtractionData expected = parse_iga(text);
  const ExtractionData data = parse_iga("\xEF\xBB\xBF" + shuffled);
  EXPECT_EQ(data.points, expected.points);
  EXPECT_EQ(data.elements.size(), 2u);
}

TEST(Iga, WhatIsWrittenIsReadBitForBit) {
  geometry::testing::Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    // Continuous, or it would fall into parts.
    const int p = random.integer(1, 4);
    const auto u = geometry::testing::random_knots(random, p, geometry::testing::Ends::clamped, p);
    const auto v = geometry::testing::random_knots(random, p, geometry::testing::Ends::unclamped, 1);
    const auto nurbs = geometry::testing::random_surface<3>(random, u, v);
    const ExtractedSurface surface = geometry::extracted_surface(nurbs);
    const CadModel model = model_of(parse_iga(iga_text(surface, "twice\nover")), "iga");
    expect_same_bits(model.t_splines[0].surface, surface);
    EXPECT_THAT(model.warnings, ::testing::IsEmpty());
  }
}

TEST(Iga, NodesThatWereMovedCountAndNotTheirExactProducts) {
  const std::string text = std::string(two_squares) + "#isorim point 2 4.9999999999999991 0 0\n" +
                           "#isorim point 5 2.1 1 0\n" + "#isorim cell 1 2 3.5 0 1\n";
  const ExtractionData data = parse_iga(text);
  EXPECT_EQ(data.points(0, 2), 4.9999999999999991);
  EXPECT_EQ(data.points(0, 5), 2.0);
  EXPECT_THAT(data.warnings, ::testing::Contains(HasSubstr("the node has been moved since")));
  EXPECT_EQ(data.elements[1].domain[0].last, 3.5);
  EXPECT_EQ(data.elements[0].domain[0].last, 1.0);
  EXPECT_THAT(refusal(std::string(two_squares) + "#isorim point 6 1 0 0\n"),
              HasSubstr("line 30: in what isorim added, line 1: found \"6\"; expected a node from 0 to 5"));
  EXPECT_THAT(refusal(std::string(two_squares) + "#isorim cell 1 1 1 0 1\n"), HasSubstr("its domain from 1 to 1"));
}

TEST(Iga, PartsThatShareNoFunctionAreSurfacesOfTheirOwn) {
  const ExtractedSurface ball =
      geometry::extracted_surface(std::get<geometry::NurbsSurface<3>>(geometry::sphere(1.0).patches[0].shape));
  geometry::HomogeneousPoints<3> points(4, 2 * ball.function_count() + 1);
  points.leftCols(ball.function_count()) = ball.homogeneous();
  points.col(ball.function_count()) << 0, 0, 0, 1;
  points.rightCols(ball.function_count()) = ball.homogeneous();
  std::vector<geometry::ExtractionElement> elements = ball.elements();
  for (geometry::ExtractionElement element : ball.elements()) {
    for (std::int32_t& function : element.functions) function += ball.function_count() + 1;
    elements.push_back(element);
  }
  const CadModel model = model_of(parse_iga(iga_text(ExtractedSurface(points, elements))), "iga");
  ASSERT_EQ(model.t_splines.size(), 2u);
  expect_same_rows(model.t_splines[0].surface, ball);
  expect_same_rows(model.t_splines[1].surface, ball);
  EXPECT_THAT(model.warnings, ::testing::Contains(HasSubstr("1 function lives on no element")));
}

TEST(Iga, RefusalsNameTheLine) {
  EXPECT_THAT(refusal(replaced(two_squares, "surface", "volume")), AllOf(HasSubstr("line 2"), HasSubstr("volume")));
  EXPECT_THAT(refusal(replaced(two_squares, "surface", "sheet")), HasSubstr("line 2: found the type \"sheet\""));
  EXPECT_THAT(refusal(replaced(two_squares, "nodeN 6", "nodes 6")),
              HasSubstr("line 3: found \"nodes\"; expected one of"));
  EXPECT_THAT(refusal(replaced(two_squares, "nodeN 6", "nodeN 7")),
              HasSubstr("found 6 lines \"node\" in the file; nodeN announces 7"));
  EXPECT_THAT(refusal(replaced(two_squares, "elemN 2", "elemN 2\nelemN 2")), HasSubstr("line 5: found a second elemN"));
  EXPECT_THAT(refusal(replaced(two_squares, "node 1 0 0 1", "node 1 0 x 1")),
              HasSubstr("line 7: found \"x\"; expected a coordinate"));
  EXPECT_THAT(refusal(replaced(two_squares, "node 1 0 0 1", "node 1 0 nan 1")), HasSubstr("found \"nan\""));
  EXPECT_THAT(refusal(replaced(two_squares, "node 1 0 0 1", "node 1 0 1e999 1")), HasSubstr("found \"1e999\""));
  EXPECT_THAT(refusal(replaced(two_squares, "node 1 0 0 1", "node 1 0 0 -1")),
              HasSubstr("line 7: the weight of node 1 is -1"));
  EXPECT_THAT(refusal(replaced(two_squares, "0 1 3 4", "0 1 3 6")),
              HasSubstr("line 12: element 0: node 6 does not exist; expected 0 to 5"));
  EXPECT_THAT(refusal(replaced(two_squares, "0 0 0 1\nset", "0 0 1\nset")),
              HasSubstr("line 22: row 3 of element 1 has 3 coefficients; expected 4"));
  EXPECT_THAT(refusal(replaced(two_squares, "belem 4 1 1", "belem 4 0 1")),
              HasSubstr("line 12: found \"0\"; expected a degree from 1 to 30"));
  EXPECT_THAT(refusal(replaced(two_squares, "belem 4 1 1", "belem 400000000 30 30")),
              HasSubstr("line 12: found 400000000"));
  EXPECT_THAT(refusal(replaced(two_squares, "belem 4 1 1", "belem 40 3 3")),
              HasSubstr("the file is too short for them"));
  EXPECT_THAT(refusal(replaced(two_squares, "1 RIGHT", "1 EAST")), HasSubstr("found the side \"EAST\""));
  EXPECT_THAT(refusal(replaced(two_squares, "1 RIGHT", "2 RIGHT")),
              HasSubstr("line 24: element 2 of a set does not exist"));
  EXPECT_THAT(refusal("type surface\n"), HasSubstr("ends without a node"));
  EXPECT_THAT(refusal(""), HasSubstr("ends without a node"));
  EXPECT_THAT(refusal(replaced(two_squares, "1 0 0 0\n0 1 0 0", "1 0 0 0\n0 0 0 0")),
              HasSubstr("element 0 in Bézier form: weight (1, 0) is 0"));
}

}  // namespace
}  // namespace isorim::io::tspline
