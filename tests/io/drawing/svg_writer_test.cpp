#include "io/drawing/svg_writer.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "tests/io/drawing/samples.h"
#include "tests/io/svg/xml_check.h"

namespace isorim::io::drawing {
namespace {

using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;
using svg::XmlElement;

const Rectangle page{{-5.0, -10.0}, {205.0, 150.0}};

std::vector<XmlElement> named(const std::vector<XmlElement>& elements, const std::string& name) {
  std::vector<XmlElement> result;
  for (const XmlElement& element : elements)
    if (element.name == name) result.push_back(element);
  return result;
}

/// The path's segments in the drawing's coordinates.
std::vector<NurbsCurve<2>> curves_of(const std::string& data) {
  std::istringstream stream(data);
  std::vector<NurbsCurve<2>> curves;
  Point2 at = Point2::Zero();
  const auto read = [&] {
    Point2 point;
    stream >> point.x() >> point.y();
    return Point2(page.lower.x() + point.x(), page.upper.y() - point.y());
  };
  for (char letter = 0; stream >> letter;) {
    if (letter == 'Z') continue;
    const int count = letter == 'C' ? 3 : letter == 'Q' ? 2 : 1;
    Points<2> points(2, count + 1);
    points.col(0) = at;
    for (int i = 1; i <= count; ++i) points.col(i) = read();
    at = points.col(count);
    if (letter != 'M') curves.push_back(NurbsCurve<2>::from_points(geometry::KnotVector::bezier(count), points));
  }
  return curves;
}

TEST(SheetSvg, IsAsLargeAsThePage) {
  const auto elements = svg::parse_xml(to_svg({"Curves & more", curves_drawing(), page}));
  EXPECT_EQ(elements[0].attribute("width"), "210mm");
  EXPECT_EQ(elements[0].attribute("height"), "160mm");
  EXPECT_EQ(elements[0].attribute("viewBox"), "0 0 210 160");
  EXPECT_EQ(elements[1].text, "Curves & more");
}

TEST(SheetSvg, CurvesAreWithinAThousandthOfAMillimetre) {
  const auto paths = named(svg::parse_xml(to_svg({"", curves_drawing(), page})), "path");
  const auto curves = sample_curves();
  ASSERT_EQ(paths.size(), curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto drawn = geometry::join<2>(curves_of(paths[i].attribute("d")), 1e-9);
    EXPECT_LT(distance(drawn, curves[i]), 0.001) << i;
    EXPECT_EQ(paths[i].attribute("d").back() == 'Z', i == 3) << i;
  }
}

TEST(SheetSvg, LayersAreGroupsWithTheirLines) {
  Drawing drawing;
  const std::size_t axes = drawing.add_layer({"axes", {0, 70, 160}, 0.18, LineType::chain});
  drawing.add_layer({"empty"});
  drawing.add(axes, line({0.0, 0.0}, {10.0, 5.0}));
  const auto groups = named(svg::parse_xml(to_svg({"", drawing, {{0.0, 0.0}, {20.0, 10.0}}})), "g");
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].attribute("inkscape:label"), "axes");
  EXPECT_EQ(groups[0].attribute("stroke"), "#0046a0");
  EXPECT_EQ(groups[0].attribute("stroke-width"), "0.18");
  // ISO 128-2: 24, 3, 0.5, 3 line widths.
  EXPECT_EQ(groups[0].attribute("stroke-dasharray"), "4.32 0.54 0.09 0.54");
}

TEST(SheetSvg, TextsStandWhereTheyShould) {
  Drawing drawing;
  drawing.add_layer({"text"});
  drawing.add(0, Text{"a < b", {10.0, 5.0}, 7.18, Horizontal::right, Vertical::top});
  drawing.add(0, Text{"up", {3.0, 4.0}, 3.59, Horizontal::centre, Vertical::middle, 90.0});
  const auto texts = named(svg::parse_xml(to_svg({"", drawing, {{0.0, 0.0}, {20.0, 10.0}}})), "text");
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_EQ(texts[0].text, "a < b");
  EXPECT_DOUBLE_EQ(texts[0].number("font-size"), 10.0);
  EXPECT_DOUBLE_EQ(texts[0].number("x"), 10.0);
  EXPECT_DOUBLE_EQ(texts[0].number("y"), 5.0 + 7.18);
  EXPECT_EQ(texts[0].attribute("text-anchor"), "end");
  EXPECT_EQ(texts[1].attribute("transform"), "translate(3 6) rotate(-90)");
  EXPECT_DOUBLE_EQ(texts[1].number("y"), 0.5 * 3.59);
}

TEST(SheetSvg, CurvesThatJumpAreDrawnInParts) {
  Points<2> points(2, 4);
  points << 0.0, 5.0, 8.0, 9.0, 0.0, 5.0, 1.0, 2.0;
  const geometry::KnotVector knots(1, {0.0, 0.0, 0.5, 0.5, 1.0, 1.0});
  Drawing drawing;
  drawing.add_layer({"0"});
  drawing.add(0, Path{{NurbsCurve<2>::from_points(knots, points)}});
  const auto paths = named(svg::parse_xml(to_svg({"", drawing, {{0.0, 0.0}, {10.0, 10.0}}})), "path");
  EXPECT_EQ(paths.at(0).attribute("d"), "M0 10L5 5M8 9L9 8");
}

TEST(SheetSvg, RefusesSheetsWithoutArea) {
  EXPECT_THROW(to_svg({"", curves_drawing(), {}}), InputError);
}

}  // namespace
}  // namespace isorim::io::drawing
