#include "io/svg/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "io/svg/bezier_path.h"
#include "tests/io/svg/xml_check.h"

namespace isorim::io::svg {
namespace {

using geometry::HomogeneousPoints;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;

NurbsCurve<2> bezier(const Points<2>& points) {
  return NurbsCurve<2>::from_points(KnotVector::bezier(static_cast<int>(points.cols()) - 1), points);
}

/// The rectangle's corner is the origin.
std::vector<Chain> rectangle(double width, double height) {
  return chains(geometry::orient(geometry::rectangle({width, height})));
}

struct PixelFrame {
  double left, top, width, height;
};

PixelFrame frame_of(const std::vector<XmlElement>& elements) {
  const XmlElement frame = with_class(elements, "frame").at(0);
  return {frame.number("x"), frame.number("y"), frame.number("width"), frame.number("height")};
}

/// All numbers in path data, two a point.
std::vector<Point2> path_points(std::string path) {
  for (char& c : path) c = std::isalpha(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
  std::istringstream stream(path);
  std::vector<Point2> points;
  for (Point2 point; stream >> point.x() >> point.y();) points.push_back(point);
  return points;
}

Point2 evaluate_segment(PathSegment points, double t) {
  for (Eigen::Index k = points.cols() - 1; k > 0; --k) {
    for (Eigen::Index i = 0; i < k; ++i) points.col(i) = ((1.0 - t) * points.col(i) + t * points.col(i + 1)).eval();
  }
  return points.col(0);
}

constexpr double rounding = 0.0051;

TEST(SvgBezierPath, LowDegreePolynomialsAreDrawnAsTheyAre) {
  for (const int points : {2, 3, 4}) {
    const Points<2> net = Points<2>::Random(2, points);
    const auto segments = path_segments(bezier(net), 1e-9);
    ASSERT_EQ(segments.size(), 1U);
    EXPECT_EQ(segments[0], net);
  }
}

TEST(SvgBezierPath, EqualWeightsArePolynomial) {
  const Points<2> net = Points<2>::Random(2, 4);
  const std::vector<double> weights(4, 2.0);
  const auto segments = path_segments(NurbsCurve<2>::from_points(KnotVector::bezier(3), net, weights), 1e-9);
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_LT((segments[0] - net).norm(), 1e-15);
}

TEST(SvgBezierPath, RationalCurvesStayWithinTheTolerance) {
  for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
    const auto segments = path_segments(geometry::circle_curve(2.0, {1.0, -1.0}), tolerance);
    double error = 0.0;
    for (const PathSegment& segment : segments) {
      for (int k = 0; k <= 100; ++k) {
        const Point2 x = evaluate_segment(segment, 0.01 * k);
        error = std::max(error, std::abs((x - Point2(1.0, -1.0)).norm() - 2.0));
      }
    }
    EXPECT_LT(error, tolerance);
    EXPECT_LE(static_cast<double>(segments.size()), 8.0 + 4.0 * std::pow(tolerance, -0.25)) << "fourth order";
  }
}

/// To a polygon of 10000 chords of the curve over [0, 1].
double distance_to_curve(const NurbsCurve<2>& curve, const Point2& x) {
  double squared_distance = std::numeric_limits<double>::infinity();
  Point2 last = evaluate(curve, 0.0);
  for (int k = 1; k <= 10000; ++k) {
    const Point2 next = evaluate(curve, 1e-4 * k);
    const double t = std::clamp((x - last).dot(next - last) / (next - last).squaredNorm(), 0.0, 1.0);
    squared_distance = std::min(squared_distance, (x - last - t * (next - last)).squaredNorm());
    last = next;
  }
  return std::sqrt(squared_distance);
}

TEST(SvgBezierPath, HighDegreesStayWithinTheToleranceAndMeet) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (const int p : {4, 5, 9}) {
    Points<2> net(2, p + 4);
    for (auto column : net.colwise()) column << coordinate(random), coordinate(random);
    const auto curve = NurbsCurve<2>::from_points(KnotVector::clamped_uniform(p, 4), net);
    const auto segments = path_segments(curve, 1e-4);
    Point2 end = evaluate(curve, 0.0);
    for (const PathSegment& segment : segments) {
      EXPECT_LT((segment.leftCols(1) - end).norm(), 1e-14);
      EXPECT_LT(distance_to_curve(curve, evaluate_segment(segment, 0.37)), 1e-4);
      end = segment.rightCols(1);
    }
    EXPECT_LT((end - evaluate(curve, 1.0)).norm(), 1e-14);
  }
}

TEST(SvgBezierPath, CommandsAreTheLetterOfTheDegree) {
  PathSegment line(2, 2);
  line << 0, 1.5, 0, 2;
  EXPECT_EQ(path_command(line), "L1.5 2");
  PathSegment cubic(2, 4);
  cubic << 0, 1, 2, 3, 0, -1, 0.25, 7;
  EXPECT_EQ(path_command(cubic), "C1 -1 2 0.25 3 7");
}

TEST(SvgDrawing, TheShapeIsTrueToScaleAndFillsThePicture) {
  Drawing drawing;
  drawing.chains = rectangle(4.0, 1.0);
  const auto elements = parse_xml(to_svg(drawing));
  const auto points = path_points(with_class(elements, "region").at(0).attribute("d"));
  ASSERT_EQ(points.size(), 5U);
  const double width = points[1].x() - points[0].x();
  EXPECT_NEAR(points[1].y(), points[0].y(), rounding);
  EXPECT_NEAR(points[1].y() - points[2].y(), 0.25 * width, rounding) << "y points upwards, at the scale of x";
  EXPECT_GT(width, 600.0);
  EXPECT_NEAR(elements[0].number("width"), 720.0, 1.0);
  EXPECT_LT(elements[0].number("height"), 300.0);
  const PixelFrame frame = frame_of(elements);
  EXPECT_NEAR(points[0].x() - frame.left, 0.05 / 1.1 * frame.width, rounding) << "a margin of 5 %";
}

TEST(SvgDrawing, TicksStandAtTheirValues) {
  Drawing drawing;
  drawing.chains = rectangle(4.0, 1.0);
  const auto elements = parse_xml(to_svg(drawing));
  const auto corner = path_points(with_class(elements, "region").at(0).attribute("d"))[0];
  const auto opposite = path_points(with_class(elements, "region").at(0).attribute("d"))[2];
  const auto ticks = inside_class(elements, "x ticks");
  ASSERT_GE(ticks.size(), 4U);
  for (const XmlElement& tick : ticks) {
    EXPECT_NEAR(tick.number("x"), corner.x() + std::stod(tick.text) / 4.0 * (opposite.x() - corner.x()), 2 * rounding);
  }
}

TEST(SvgDrawing, TheCurveBoundsThePictureNotItsControlPoints) {
  Drawing drawing;
  Points<2> net(2, 4);
  net << 0, 0, 1, 1,  //
      0, 4, 4, 0;
  drawing.chains = {{bezier(net)}};
  const auto elements = parse_xml(to_svg(drawing));
  // The curve's top is at 3, its width 1: the frame is 1 + 0.3 wide and 3 + 0.3 high.
  const PixelFrame frame = frame_of(elements);
  EXPECT_NEAR(frame.height / frame.width, 3.3 / 1.3, 1e-4);
  drawing.show_control_net = true;
  const PixelFrame with_net = frame_of(parse_xml(to_svg(drawing)));
  EXPECT_NEAR(with_net.height / with_net.width, 4.4 / 1.4, 1e-4);
}

TEST(SvgDrawing, HolesShareThePathOfTheirRegion) {
  Drawing drawing;
  const Chain outer = rectangle(4.0, 4.0)[0];
  const Chain hole{geometry::circle_curve(1.0, {2.0, 2.0})};
  drawing.chains = chains(geometry::orient(geometry::region(std::vector{outer, hole})));
  const auto region = with_class(parse_xml(to_svg(drawing)), "region");
  ASSERT_EQ(region.size(), 1U);
  EXPECT_EQ(region[0].attribute("fill-rule"), "evenodd");
  const std::string path = region[0].attribute("d");
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'Z'), 2);
}

TEST(SvgDrawing, OpenChainsAreLines) {
  Drawing drawing;
  drawing.chains = {{geometry::line_segment<2>({0, 0}, {1, 1}), geometry::line_segment<2>({1, 1}, {2, 0})}};
  const auto elements = parse_xml(to_svg(drawing));
  EXPECT_TRUE(with_class(elements, "region").empty());
  const auto curves = with_class(elements, "curves");
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(curves[0].attribute("fill"), "none");
  EXPECT_EQ(curves[0].attribute("d").find('Z'), std::string::npos);
}

TEST(SvgDrawing, TheControlNetIsDrawnWhereItIs) {
  Drawing drawing;
  drawing.chains = {{geometry::circle_curve(1.0)}};
  EXPECT_TRUE(with_class(parse_xml(to_svg(drawing)), "control polygon").empty());
  drawing.show_control_net = true;
  const auto elements = parse_xml(to_svg(drawing));
  const auto points = inside_class(elements, "control points");
  ASSERT_EQ(points.size(), 9U);
  const PixelFrame frame = frame_of(elements);
  // Control point 1 is the corner (1, 1).
  EXPECT_NEAR(points[1].number("cx"), frame.left + (2.0 + 0.1) / 2.2 * frame.width, 2 * rounding);
  EXPECT_NEAR(points[1].number("cy"), frame.top + 0.1 / 2.2 * frame.height, 2 * rounding);
  EXPECT_EQ(path_points(with_class(elements, "control polygon").at(0).attribute("d")).size(), 9U);
}

/// A periodic curve repeats its first control points: its net is a polygon, each edge once.
TEST(SvgDrawing, TheControlNetOfAPeriodicCurveIsAPolygon) {
  const std::vector<double> breakpoints{0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
  geometry::Points<2> points(2, 8);
  points << 0, 2, 3, 1, -1, 0, 2, 3, 0, 0, 2, 3, 1, 0, 0, 2;
  Drawing drawing;
  drawing.chains = {{geometry::NurbsCurve<2>::from_points(geometry::KnotVector::periodic(3, breakpoints), points)}};
  drawing.show_control_net = true;
  const auto elements = parse_xml(to_svg(drawing));
  EXPECT_EQ(inside_class(elements, "control points").size(), 5U);
  const std::string path = with_class(elements, "control polygon").at(0).attribute("d");
  EXPECT_EQ(path_points(path).size(), 5U);
  EXPECT_EQ(path.back(), 'Z');
}

TEST(SvgDrawing, LoopsOfABoundaryAreRunThroughWithTheRegionOnTheLeft) {
  geometry::OrientedBoundary<2> oriented;
  oriented.boundary.patches = {{"right", geometry::line_segment<2>({1, 0}, {1, 1}), 1},
                               {"bottom", geometry::line_segment<2>({1, 0}, {0, 0}), -1},
                               {"back", geometry::line_segment<2>({1, 1}, {0, 0}), 1}};
  oriented.topology.shells = {{{1, 0, 2}, true, false}};
  const auto found = chains(oriented);
  ASSERT_EQ(found.size(), 1U);
  ASSERT_EQ(found[0].size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(evaluate(found[0][i], 1.0), evaluate(found[0][(i + 1) % 3], 0.0));
  }
}

template <class Change>
std::string message_of(const Change& change) {
  Drawing drawing;
  drawing.chains = rectangle(1.0, 1.0);
  change(drawing);
  try {
    to_svg(drawing);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SvgDrawing, RefusesWhatItCannotDraw) {
  EXPECT_EQ(message_of([](Drawing&) {}), "no error");
  EXPECT_THAT(message_of([](Drawing& d) { d.chains.clear(); }), testing::HasSubstr("the drawing is empty"));
  EXPECT_THAT(message_of([](Drawing& d) { d.largest_width = 100; }), testing::HasSubstr("100 x 720"));
}

}  // namespace
}  // namespace isorim::io::svg
