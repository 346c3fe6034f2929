#include "geometry/trimming/trimmed_surface.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"
#include "tests/geometry/trimming/faces.h"

namespace isorim::geometry {
namespace {

using testing::circle_loop;
using ::testing::HasSubstr;
using testing::plane_surface;
using testing::polygon;
using testing::refusal;
using testing::reversed;

std::string refused(std::vector<TrimLoop> loops) {
  return refusal([&] { TrimmedSurface(plane_surface(1, {0, 1}, {0, 2}), std::move(loops)); });
}

TEST(TrimmedSurface, RefusesLoopsThatBoundNothing) {
  EXPECT_THAT(refused({}), HasSubstr("a trimmed surface has no loop"));
  EXPECT_THAT(refused({TrimLoop{}}), HasSubstr("loop 1 has no curve"));
  EXPECT_THAT(refused({reversed(circle_loop(0.25, Point2(0.5, 1)))}), HasSubstr("enclose no area"));
  TrimLoop open = polygon({Point2(0, 0), Point2(1, 0), Point2(1, 1)});
  open.curves.pop_back();
  EXPECT_THAT(refused({open}), HasSubstr("loop 1 is open: curve 2 ends at (1, 1), curve 1 starts at (0, 0)"));
}

TEST(TrimmedSurface, JudgesTheCurveNotItsControlPolygon) {
  // A third of a circle has its middle control point at twice the radius.
  const auto wheel = [](double radius) {
    Points<2> points(2, 7);
    std::vector<double> weights;
    for (int i = 0; i < 7; ++i) {
      const double angle = std::numbers::pi * (i / 3.0 + 0.1);
      points.col(i) = (i % 2 == 0 ? 1.0 : 2.0) * radius * Point2(std::cos(angle), std::sin(angle)) + Point2(0.5, 1.0);
      weights.push_back(i % 2 == 0 ? 1.0 : 0.5);
    }
    const KnotVector knots(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 3});
    return TrimLoop{{NurbsCurve<2>::from_points(knots, points, weights)}};
  };
  EXPECT_EQ(refused({wheel(0.5)}), "(nothing was refused)");
  EXPECT_EQ(refused({wheel(0.5 * (1 + 1e-6))}), "(nothing was refused)");
  EXPECT_THAT(refused({wheel(0.5 * (1 + 1e-5))}), HasSubstr("curve 1 of loop 1 leaves the surface's domain at ("));
}

}  // namespace
}  // namespace isorim::geometry
