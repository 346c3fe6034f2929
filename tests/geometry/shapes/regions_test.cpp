#include "geometry/shapes/regions.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::measures;
using testing::refusal;
constexpr double pi = std::numbers::pi;

void expect_area(const Boundary<2>& region, double area) {
  EXPECT_NEAR(measures(region).content, area, 1e-13 * (1.0 + std::abs(area)));
  const OrientedBoundary<2> oriented = orient(region);
  EXPECT_TRUE(oriented.topology.closed);
  for (std::size_t i = 0; i < region.patches.size(); ++i) {
    EXPECT_EQ(oriented.boundary.patches[i].orientation, region.patches[i].orientation) << region.patches[i].name;
  }
}

Points<2> columns(const std::vector<Point2>& points) {
  Points<2> result(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

TEST(Regions, HaveTheirAreasAndOutwardNormals) {
  expect_area(disc(0.5, Point2(1, 1)), 0.25 * pi);
  expect_area(elliptic_disc(Vector2(2.0, 0.3), Point2(5, 1), 0.7), 0.6 * pi);
  expect_area(rectangle(Vector2(4, 3), Point2(-1, 2)), 12.0);
  expect_area(polygon(columns({{0, 0}, {4, 0}, {0, 3}})), 6.0);
  expect_area(polygon(columns({{0, 0}, {0, 3}, {4, 0}, {0, 0}})), 6.0);
  expect_area(regular_polygon(6, 2.0, Point2(1, 0), 0.2), 6.0 * std::sqrt(3.0));
  expect_area(ellipse_segment({Vector2(2, 2), Point2(1, 1), 0.0, 0.2, 1.9}), 2.0 * (1.7 - std::sin(1.7)));
  expect_area(ellipse_segment({Vector2(2, 2), Point2(1, 1), 0.0, 5.0, 0.5}), 2.0 * (4.5 - std::sin(4.5)));
  expect_area(ellipse_sector({Vector2(3, 1), Point2(1, 1), 0.4, -0.3, 2.2}), 0.5 * 3.0 * 2.5);
}

TEST(Regions, OfLoopsGetHolesAndIslandsByNesting) {
  const NurbsCurve<2> plate = polyline<2>(columns({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}));
  const NurbsCurve<2> hole = circle_curve(3.0, Point2(5, 5));
  const NurbsCurve<2> island = circle_curve(1.0, Point2(5, 5));
  const std::vector<std::vector<NurbsCurve<2>>> loops{{reverse(island)}, {hole}, {reverse(plate)}};
  const Boundary<2> shape = region(loops);
  expect_area(shape, 100.0 - 8.0 * pi);
  EXPECT_EQ(shape.patches[1].name, "loop_2");
  EXPECT_EQ(shape.patches[0].orientation, -1);
  EXPECT_EQ(shape.patches[1].orientation, -1);
  EXPECT_EQ(shape.patches[2].orientation, -1);
}

TEST(Regions, OfLoopsTakeCurvesInAnyOrder) {
  const std::vector<std::vector<NurbsCurve<2>>> loops{
      {line_segment<2>(Point2(0, 0), Point2(2, 0)), circular_arc(1.0, Point2(1, 1), 0.0, pi),
       line_segment<2>(Point2(0, 0), Point2(0, 1)), line_segment<2>(Point2(2, 1), Point2(2, 0))}};
  const Boundary<2> shape = region(loops);
  expect_area(shape, 2.0 + 0.5 * pi);
  EXPECT_EQ(shape.patches[2].name, "loop_1_curve_3");
}

TEST(Regions, RefuseWhatBoundsNothing) {
  EXPECT_THAT(refusal([] { rectangle(Vector2(1, -3)); }), HasSubstr("rectangle: size[1] is -3"));
  EXPECT_THAT(refusal([] { disc(-2.0); }), HasSubstr("radius is -2"));
  EXPECT_THAT(refusal([] { polygon(columns({{0, 0}, {1, 0}, {0, 0}})); }), HasSubstr("2 distinct points"));
  EXPECT_THAT(refusal([] {
                polygon(columns({{0, 0}, {1, 0}, {1, 0}, {0, 1}}));
              }),
              HasSubstr("points 1 and 2 are both (1, 0)"));
  EXPECT_THAT(refusal([] { regular_polygon(2, 1.0); }), HasSubstr("sides is 2"));
  EXPECT_THAT(refusal([] {
                ellipse_segment({Vector2(1, 1), Point2(0, 0), 0.0, 0.0, 2.0 * pi});
              }),
              HasSubstr("is a full turn"));
  EXPECT_THAT(refusal([] { ellipse_sector({Vector2(1, 1), Point2(0, 0), 0.0, 1.0, 1.0}); }), HasSubstr("are the same"));
  EXPECT_THAT(refusal([] { region(std::vector<std::vector<NurbsCurve<2>>>{}); }), HasSubstr("there are no loops"));
  EXPECT_THAT(refusal([] { region(std::vector<std::vector<NurbsCurve<2>>>{{}}); }), HasSubstr("loop_1 has no curves"));
  const std::vector<std::vector<NurbsCurve<2>>> open{{circle_curve(1.0)},
                                                     {circular_arc(0.5, Point2(0, 0), 0.0, 0.5 * pi)}};
  const std::string message = refusal([&] { region(open); });
  EXPECT_THAT(message, HasSubstr("region: loop_2: the boundary is not closed: 'loop_2' starts at (0.5, 0)"));
  EXPECT_THAT(message, HasSubstr("a gap of 0.707"));
}

}  // namespace
}  // namespace isorim::geometry
