#include "geometry/bezier/element_table.h"

#include <gtest/gtest.h>

#include "geometry/spline/bspline.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;
using testing::random_knots;

TEST(ElementTable, ElementsEqualTheCurve) {
  Random random(70);
  for (int trial = 0; trial < 100; ++trial) {
    const int p = random.integer(1, 8);
    const NurbsCurve<2> curve = testing::random_curve<2>(random, random_knots(random, p));
    const ElementTable<2> table = bezier_elements<2>({{{"a", curve, -1}}});
    ASSERT_EQ(table.elements.size(), curve.knots().breakpoints().size() - 1);
    for (const BezierElement<2>& element : table.elements) {
      EXPECT_EQ(element.orientation, -1);
      const NurbsCurve<2> segment(KnotVector::bezier(p), table.net_matrix(element));
      const double s = random.real(0, 1);
      const double u = element.domain[0].first + s * element.domain[0].length();
      EXPECT_LE((evaluate(segment, s) - evaluate(curve, u)).norm(), 1e-13);
    }
  }
}

TEST(ElementTable, ElementsEqualTheSurfaceWithUFastest) {
  Random random(71);
  for (int trial = 0; trial < 100; ++trial) {
    const int p = random.integer(1, 5);
    const int q = random.integer(1, 5);
    const KnotVector u = random_knots(random, p);
    const KnotVector v = random_knots(random, q);
    const NurbsSurface<3> surface = testing::random_surface<3>(random, u, v);
    const ElementTable<3> table = bezier_elements<3>({{{"a", surface, 1}, {"b", surface, -1}}});
    const std::vector<double> in_u = u.breakpoints();
    const std::vector<double> in_v = v.breakpoints();
    const std::size_t count = (in_u.size() - 1) * (in_v.size() - 1);
    ASSERT_EQ(table.elements.size(), 2 * count);
    for (std::size_t e = 0; e < table.elements.size(); ++e) {
      const BezierElement<3>& element = table.elements[e];
      EXPECT_EQ(element.patch, e < count ? 0 : 1);
      EXPECT_EQ(element.domain[0].first, in_u[e % count % (in_u.size() - 1)]);
      EXPECT_EQ(element.domain[1].first, in_v[e % count / (in_u.size() - 1)]);
      const NurbsSurface<3> cell(KnotVector::bezier(p), KnotVector::bezier(q), table.net_matrix(element));
      const Point2 s(random.real(0, 1), random.real(0, 1));
      const Point2 uv(element.domain[0].first + s[0] * element.domain[0].length(),
                      element.domain[1].first + s[1] * element.domain[1].length());
      EXPECT_LE((evaluate(cell, s) - evaluate(surface, uv)).norm(), 1e-13);
      EXPECT_FALSE(element.polynomial);
    }
  }
}

TEST(ElementTable, EqualWeightsAreDividedOutElementByElement) {
  // Weights 0.3 but for the last column of the net: only the last elements in u are rational.
  Random random(72);
  const KnotVector knots(2, {-2, -1, 0, 1, 2, 3, 4, 5});
  HomogeneousPoints<3> net = HomogeneousPoints<3>::Random(4, 25);
  net.row(3).setConstant(0.3);
  for (int j = 0; j < 5; ++j) net(3, 4 + 5 * j) = 0.7;
  const NurbsSurface<3> surface(knots, knots, net);
  const ElementTable<3> table = bezier_elements<3>({{{"a", surface, 1}}});
  ASSERT_EQ(table.elements.size(), 9u);
  for (std::size_t e = 0; e < 9; ++e) {
    const BezierElement<3>& element = table.elements[e];
    EXPECT_EQ(element.polynomial, e % 3 != 2);
    EXPECT_EQ(element.polynomial, (table.net_matrix(element).row(3).array() == 1.0).all());
    const NurbsSurface<3> cell(KnotVector::bezier(2), KnotVector::bezier(2), table.net_matrix(element));
    const Point2 corner(element.domain[0].first, element.domain[1].first);
    EXPECT_LE((evaluate(cell, {0.25, 0.5}) - evaluate(surface, corner + Point2(0.25, 0.5))).norm(), 1e-14);
  }
}

TEST(ElementTable, CurvesWithEqualWeightsArePolynomial) {
  HomogeneousPoints<2> net = HomogeneousPoints<2>::Random(3, 7);
  net.row(2).setConstant(0.1);
  const NurbsCurve<2> curve(KnotVector::periodic(3, std::vector<double>{0, 0.3, 1, 1.7, 2}), net);
  const ElementTable<2> table = bezier_elements<2>({{{"a", curve, 1}}});
  for (const BezierElement<2>& element : table.elements) {
    EXPECT_TRUE(element.polynomial);
    EXPECT_TRUE((table.net_matrix(element).row(2).array() == 1.0).all());
  }
}

TEST(ElementTable, SegmentsOfTheCircleKeepTheirControlPointsBitForBit) {
  const NurbsCurve<2> curve = testing::circle(2.0, {1, 1});
  const ElementTable<2> table = bezier_elements<2>({{{"circle", curve, 1}}});
  ASSERT_EQ(table.elements.size(), 4u);
  for (int e = 0; e < 4; ++e)
    EXPECT_EQ(table.net_matrix(table.elements[static_cast<std::size_t>(e)]), curve.homogeneous().middleCols(2 * e, 3));
}

TEST(ElementTable, BoundingBoxIsThatOfTheControlPoints) {
  const ElementTable<2> table = bezier_elements<2>({{{"circle", testing::circle(2.0, {1, 5}), 1}}});
  const BoundingBox<2> box = bounding_box(table);
  EXPECT_LE((box.lower - Point2(-1, 3)).norm(), 1e-15);
  EXPECT_LE((box.upper - Point2(3, 7)).norm(), 4e-15);
  EXPECT_NEAR(box.diagonal(), std::sqrt(32.0), 1e-14);
}

TEST(ElementTable, AMillionElementsInOnePass) {
  const KnotVector knots = KnotVector::clamped_uniform(2, 1000);
  Points<3> points(3, 1002 * 1002);
  for (int i = 0; i < points.cols(); ++i) points.col(i) = Point3(i % 1002, i / 1002, i % 7919);
  const NurbsSurface<3> surface = NurbsSurface<3>::from_points(knots, knots, points);
  const ElementTable<3> table = bezier_elements<3>({{{"a", surface, 1}}});
  ASSERT_EQ(table.elements.size(), 1000000u);
  EXPECT_EQ(table.nets.size(), 36000000u);
  const BezierElement<3>& element = table.elements[123456];
  const NurbsSurface<3> cell(KnotVector::bezier(2), KnotVector::bezier(2), table.net_matrix(element));
  const Point2 uv(element.domain[0].middle(), element.domain[1].middle());
  EXPECT_LE((evaluate(cell, {0.5, 0.5}) - evaluate(surface, uv)).norm(), 1e-9);
}

TEST(ElementTable, RefusesBadInput) {
  EXPECT_GEOMETRY_ERROR(bezier_elements<2>({{{"rim", testing::circle(1, {0, 0}), 0}}}),
                        "patch \"rim\": orientation is 0; expected 1 or -1");
  EXPECT_GEOMETRY_ERROR(bounding_box(ElementTable<2>{}), "the boundary has no elements");
}

}  // namespace
}  // namespace isorim::geometry
