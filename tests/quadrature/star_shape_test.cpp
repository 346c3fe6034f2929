#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "quadrature/rim.h"

namespace isorim::quadrature {
namespace {

using geometry::bezier_elements;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;

geometry::ElementTable<2> polygon(std::initializer_list<Point2> corners) {
  geometry::Points<2> points(2, static_cast<Eigen::Index>(corners.size()));
  Eigen::Index i = 0;
  for (const Point2& corner : corners) points.col(i++) = corner;
  return bezier_elements(geometry::polygon(points));
}

TEST(StarShape, ConvexShapesAreStarShapedAboutInnerPointsOnly) {
  const auto disc = bezier_elements(geometry::disc(1.0));
  EXPECT_TRUE(is_star_shaped_about<2>(disc, Point2(0.0, 0.0)));
  EXPECT_TRUE(is_star_shaped_about<2>(disc, Point2(0.7, 0.6)));
  EXPECT_FALSE(is_star_shaped_about<2>(disc, Point2(1.1, 0.0)));
  const auto ball = bezier_elements(geometry::sphere(1.0));
  EXPECT_TRUE(is_star_shaped_about<3>(ball, Point3(0.1, 0.2, 0.3)));
  EXPECT_FALSE(is_star_shaped_about<3>(ball, Point3(0.0, 0.0, 1.2)));
}

TEST(StarShape, TorusIsNotStarShaped) {
  const auto torus = bezier_elements(geometry::torus(1.0, 0.4));
  EXPECT_FALSE(is_star_shaped_about<3>(torus, Point3(0, 0, 0)));
  EXPECT_FALSE(is_star_shaped_about<3>(torus, Point3(1, 0, 0)));
}

TEST(StarShape, DefaultPoleLiesInTheKernel) {
  // The middle of this L's box is not in its kernel (0, 1) x (0, 0.2).
  const auto shape = polygon({{0, 0}, {3, 0}, {3, 0.2}, {1, 0.2}, {1, 4}, {0, 4}});
  EXPECT_FALSE(is_star_shaped_about<2>(shape, geometry::bounding_box(shape).middle()));
  EXPECT_TRUE(is_star_shaped_about<2>(shape, default_pole(shape)));
}

TEST(StarShape, DefaultPoleIsTheMiddleOfTheBoxWherePossible) {
  const auto rectangle = bezier_elements(geometry::rectangle(Vector2(4, 2), Point2(1, 1)));
  EXPECT_EQ(default_pole(rectangle), Point2(3, 2));
  const auto u_shape = polygon({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}});
  EXPECT_EQ(default_pole(u_shape), Point2(1.5, 1.5));
}

}  // namespace
}  // namespace isorim::quadrature
