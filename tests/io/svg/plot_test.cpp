#include "io/svg/plot.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/io/svg/xml_check.h"

namespace isorim::io::svg {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Plot convergence_plot() {
  Plot plot;
  plot.title = "Error of the volume";
  plot.x = {{"points", Scale::logarithmic}, {}};
  plot.y = {{"relative error", Scale::logarithmic}, {}};
  plot.series = {{"Gauss", {10.0, 100.0, 1000.0}, {1e-2, 1e-6, 1e-10}}};
  return plot;
}

struct PixelFrame {
  double left, top, right, bottom;
};

PixelFrame frame_of(const std::vector<XmlElement>& elements) {
  const XmlElement frame = with_class(elements, "frame").at(0);
  return {frame.number("x"), frame.number("y"), frame.number("x") + frame.number("width"),
          frame.number("y") + frame.number("height")};
}

/// Circles outside the legend, filled with this colour.
std::vector<XmlElement> circles(const std::vector<XmlElement>& elements, const std::string& fill) {
  std::vector<XmlElement> result;
  std::string group_fill;
  for (const XmlElement& element : elements) {
    if (element.attribute("class") == "legend") break;
    if (element.name == "g") group_fill = element.attribute("fill");
    if (element.name == "circle" && group_fill == fill) result.push_back(element);
  }
  return result;
}

bool contains_text(const std::vector<XmlElement>& elements, const std::string& text) {
  return std::any_of(elements.begin(), elements.end(), [&](const XmlElement& e) { return e.text == text; });
}

constexpr const char* first_colour = "#0072b2";
constexpr const char* hollow = "#fff";
/// Pixels are written with two decimals.
constexpr double rounding = 0.0051;

TEST(SvgPlot, PointsStandAtTheirPlaces) {
  const auto elements = parse_xml(to_svg(convergence_plot()));
  const PixelFrame frame = frame_of(elements);
  const auto points = circles(elements, first_colour);
  ASSERT_EQ(points.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const double fraction = 0.5 * i;
    EXPECT_NEAR(points[static_cast<std::size_t>(i)].number("cx"), frame.left + fraction * (frame.right - frame.left),
                3 * rounding);
    EXPECT_NEAR(points[static_cast<std::size_t>(i)].number("cy"), frame.top + fraction * (frame.bottom - frame.top),
                3 * rounding);
  }
}

TEST(SvgPlot, TickLabelsStandAtTheirValues) {
  Plot plot;
  plot.x = {{"s", Scale::linear}, geometry::Interval{0.0, 4.0}};
  plot.y = {{"m", Scale::linear}, geometry::Interval{-1.0, 1.0}};
  plot.series = {{"", {0.0, 4.0}, {-1.0, 1.0}}};
  const auto elements = parse_xml(to_svg(plot));
  const PixelFrame frame = frame_of(elements);
  const auto x_ticks = inside_class(elements, "x ticks");
  ASSERT_EQ(x_ticks.size(), 9U);
  for (const XmlElement& tick : x_ticks) {
    EXPECT_NEAR(tick.number("x"), frame.left + std::stod(tick.text) / 4.0 * (frame.right - frame.left), 3 * rounding);
    EXPECT_GT(tick.number("y"), frame.bottom);
  }
  const auto y_ticks = inside_class(elements, "y ticks");
  ASSERT_EQ(y_ticks.size(), 5U);
  EXPECT_EQ(y_ticks.front().text, "\u22121");
  EXPECT_EQ(y_ticks.back().text, "1");
  EXPECT_LT(y_ticks.back().number("y"), y_ticks.front().number("y"));
}

TEST(SvgPlot, TextIsEscapedAndPresent) {
  Plot plot = convergence_plot();
  plot.title = "a < b & c";
  plot.series[0].name = "\"p\" > 2";
  const auto elements = parse_xml(to_svg(plot));
  for (const char* text : {"a < b & c", "\"p\" > 2", "points", "relative error"}) {
    EXPECT_TRUE(contains_text(elements, text)) << text;
  }
}

TEST(SvgPlot, ZeroOnALogarithmicAxisIsAHollowMarkerOnTheFloor) {
  Plot plot = convergence_plot();
  plot.series[0].y[2] = 0.0;
  const auto elements = parse_xml(to_svg(plot));
  const PixelFrame frame = frame_of(elements);
  EXPECT_EQ(circles(elements, first_colour).size(), 2U);
  const auto floor = circles(elements, hollow);
  ASSERT_EQ(floor.size(), 1U);
  EXPECT_NEAR(floor[0].number("cy"), frame.bottom, 2 * rounding);
  EXPECT_NEAR(floor[0].number("cx"), frame.right, 2 * rounding);
  EXPECT_GT(frame.bottom, circles(elements, first_colour)[1].number("cy") + 10.0) << "the floor lies below the data";
  EXPECT_TRUE(contains_text(elements, "hollow: zero or less, at the floor"));
}

TEST(SvgPlot, PointsThatAreNotFiniteAreLeftOutAndCounted) {
  Plot plot = convergence_plot();
  plot.series[0].x = {10.0, 100.0, 1000.0, 10000.0, infinity};
  plot.series[0].y = {1.0, nan, 0.1, infinity, 0.1};
  const std::string text = to_svg(plot);
  const auto elements = parse_xml(text);
  EXPECT_EQ(circles(elements, first_colour).size(), 2U);
  EXPECT_TRUE(contains_text(elements, "3 not finite, left out"));
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST(SvgPlot, TheLineIsInterruptedWhereAPointIsMissing) {
  Plot plot = convergence_plot();
  plot.series[0].x = {1.0, 2.0, 3.0, 4.0, 5.0};
  plot.series[0].y = {1.0, 0.1, nan, 0.2, 0.3};
  for (const XmlElement& element : parse_xml(to_svg(plot))) {
    if (element.attribute("stroke") != first_colour || element.name != "path") continue;
    const std::string path = element.attribute("d");
    EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
    EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 2);
    return;
  }
  FAIL() << "no line";
}

TEST(SvgPlot, TheLegendHidesNoData) {
  for (const double slope : {-1.0, 0.0, 1.0}) {
    Plot plot;
    plot.series = {{"a series", {}, {}}};
    for (int i = 0; i <= 40; ++i) {
      plot.series[0].x.push_back(i);
      plot.series[0].y.push_back(slope * i + (i % 2));
    }
    const auto elements = parse_xml(to_svg(plot));
    const XmlElement legend = inside_class(elements, "legend").at(0);
    for (const XmlElement& point : circles(elements, first_colour)) {
      const double dx = point.number("cx") - legend.number("x");
      const double dy = point.number("cy") - legend.number("y");
      EXPECT_FALSE(0 < dx && dx < legend.number("width") && 0 < dy && dy < legend.number("height")) << slope;
    }
  }
}

TEST(SvgPlot, ALegendThatFitsNowhereStandsBesideTheChart) {
  Plot plot;
  plot.series = {{"everywhere", {}, {}}};
  for (int i = 0; i < 200; ++i) {
    plot.series[0].x.push_back(i);
    plot.series[0].y.push_back(i % 2);
  }
  const auto elements = parse_xml(to_svg(plot));
  const XmlElement legend = inside_class(elements, "legend").at(0);
  EXPECT_GT(legend.number("x"), frame_of(elements).right);
  EXPECT_LE(legend.number("x") + legend.number("width"), 720.0);
}

TEST(SvgPlot, NoTwoOfManyLinesLookAlike) {
  Plot plot;
  for (int i = 0; i < 14; ++i) plot.series.push_back({"", {0.0, 1.0}, {0.0, double(i)}, Line::solid, Marker::none});
  std::set<std::pair<std::string, std::string>> looks;
  for (const XmlElement& element : parse_xml(to_svg(plot))) {
    // The frame and its grid have no round joins.
    if (element.name != "path" || element.attribute("stroke-linejoin") != "round") continue;
    looks.emplace(element.attribute("stroke"), element.attribute("stroke-dasharray"));
  }
  EXPECT_EQ(looks.size(), 14U);
}

TEST(SvgPlot, EmptyPlotsAreDrawn) {
  EXPECT_NO_THROW(parse_xml(to_svg(Plot{})));
  Plot plot = convergence_plot();
  plot.series[0] = {"nothing but zeros", {0.0, 0.0}, {0.0, -1.0}};
  EXPECT_EQ(circles(parse_xml(to_svg(plot)), hollow).size(), 2U);
}

template <class Change>
std::string message_of(const Change& change) {
  Plot plot = convergence_plot();
  change(plot);
  try {
    to_svg(plot);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SvgPlot, RefusesWhatItCannotDraw) {
  EXPECT_THAT(message_of([](Plot& p) { p.series[0].x.pop_back(); }), testing::HasSubstr("'Gauss' has 2 x and 3 y"));
  EXPECT_THAT(message_of([](Plot& p) { p.x.range = {0.0, 1.0}; }), testing::HasSubstr("x axis has the range [0, 1]"));
  EXPECT_THAT(message_of([](Plot& p) { p.y.range = {2.0, 1.0}; }), testing::HasSubstr("y axis has the range [2, 1]"));
  EXPECT_THAT(message_of([](Plot& p) { p.width = 10; }), testing::HasSubstr("size is 10 x 480"));
}

TEST(SvgPlot, TheFileHoldsTheDocument) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "isorim_plot.svg";
  write_svg(path, convergence_plot());
  std::ifstream stream(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), to_svg(convergence_plot()));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace isorim::io::svg
