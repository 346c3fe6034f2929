#include "geometry/spline/knot_vector.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

TEST(KnotVector, ClampedUniformHasEqualSpansAndFullEnds) {
  const KnotVector knots = KnotVector::clamped_uniform(2, 4);
  const std::vector<double> expected{0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1};
  EXPECT_EQ(knots, KnotVector(2, expected));
  EXPECT_TRUE(knots.is_clamped());
  EXPECT_EQ(knots.basis_count(), 6);
}

TEST(KnotVector, PeriodicContinuesTheBreakpointsWithThePeriod) {
  const std::vector<double> breakpoints{0, 1, 3, 4};
  const std::vector<double> expected{-3, -1, 0, 1, 3, 4, 5, 7};
  const KnotVector knots = KnotVector::periodic(2, breakpoints);
  EXPECT_EQ(knots, KnotVector(2, expected));
  EXPECT_FALSE(knots.is_clamped());
  EXPECT_EQ(knots.basis_count(), 5);
  EXPECT_EQ(knots.domain().first, 0.0);
  EXPECT_EQ(knots.domain().last, 4.0);
}

TEST(KnotVector, PeriodicWrapsSeveralTimesWhenTheDegreeExceedsTheSpans) {
  const std::vector<double> breakpoints{0, 1};
  const std::vector<double> expected{-3, -2, -1, 0, 1, 2, 3, 4};
  EXPECT_EQ(KnotVector::periodic(3, breakpoints), KnotVector(3, expected));
}

TEST(KnotVector, SpanHoldsItsParameter) {
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const KnotVector knots = testing::random_knots(random, random.integer(1, 8));
    const double u = random.inside(knots.domain());
    const int span = knots.find_span(u);
    EXPECT_LE(knots[span], u);
    EXPECT_LT(u, knots[span + 1]);
  }
}

TEST(KnotVector, SpanAtBreakpointsIsTheRightOneAndAtTheEndTheLast) {
  const KnotVector knots(2, {-1, -0.5, 0, 1, 1, 2, 2.5, 3});
  EXPECT_EQ(knots.find_span(0.0), 2);
  EXPECT_EQ(knots.find_span(1.0), 4);
  EXPECT_EQ(knots.find_span(2.0), 4);
  EXPECT_EQ(knots.find_span(-0.7), 2);
  EXPECT_EQ(knots.find_span(99.0), 4);
  EXPECT_EQ(knots.find_span(std::numeric_limits<double>::infinity()), 4);
}

TEST(KnotVector, BreakpointsAreTheDistinctKnotsOfTheDomain) {
  const KnotVector knots(2, {-1, -0.5, 0, 1, 1, 2, 2.5, 3});
  EXPECT_EQ(knots.breakpoints(), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(knots.multiplicity(1.0), 2);
  EXPECT_EQ(knots.multiplicity(1.5), 0);
}

TEST(KnotVector, GrevilleAbscissaeReproduceTheParameter) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const KnotVector knots = testing::random_knots(random, random.integer(1, 8));
    const std::vector<double> greville = knots.greville_abscissae();
    const double u = random.inside(knots.domain());
    const std::vector<long double> basis = testing::reference_basis(knots, u, 0);
    long double sum = 0.0L;
    for (std::size_t i = 0; i < basis.size(); ++i) sum += basis[i] * greville[i];
    EXPECT_NEAR(static_cast<double>(sum), u, 1e-14 * 10);
  }
}

TEST(KnotVector, InnerMultiplicityDegreePlusOneIsLegal) {
  EXPECT_NO_THROW(KnotVector(1, {0, 0, 0.25, 0.25, 0.5, 0.5, 1, 1}));
}

TEST(KnotVector, RefusesBadInputWithItsPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_GEOMETRY_ERROR(KnotVector(0, {0, 1}), "degree 0 is out of range");
  EXPECT_GEOMETRY_ERROR(KnotVector(31, std::vector<double>(64, 0.0)), "degree 31 is out of range");
  EXPECT_GEOMETRY_ERROR(KnotVector(-1, {}), "degree -1 is out of range");
  EXPECT_GEOMETRY_ERROR(KnotVector(2, {0, 0, 0, 1, 1}), "5 knots given; degree 2 needs at least 6");
  EXPECT_GEOMETRY_ERROR(KnotVector(1, {0, 0, 0.75, 0.5, 1, 1}), "knots[3] = 0.5 is smaller than knots[2] = 0.75");
  EXPECT_GEOMETRY_ERROR(KnotVector(1, {0, 0, nan, 1, 1}), "knots[2] = nan is not finite");
  EXPECT_GEOMETRY_ERROR(KnotVector(1, {0, 0, 1, infinity}), "knots[3] = inf is not finite");
  EXPECT_GEOMETRY_ERROR(KnotVector(1, {0, 0, 0.5, 0.5, 0.5, 1, 1}), "knot 0.5 occurs 3 times, from knots[2]");
  EXPECT_GEOMETRY_ERROR(KnotVector(2, {0, 1, 2, 2, 3, 4}), "the domain from knots[2] = 2 to knots[3] = 2 is empty");
  EXPECT_GEOMETRY_ERROR(KnotVector(1, {-1e308, -1e308, 1e308, 1e308}), "overflows");
  EXPECT_GEOMETRY_ERROR(KnotVector::clamped_uniform(2, 0), "0 spans asked for");
  EXPECT_GEOMETRY_ERROR(KnotVector::clamped(2, std::vector<double>{0.0}), "1 breakpoint(s) given");
  EXPECT_GEOMETRY_ERROR(KnotVector::periodic(2, std::vector<double>{}), "0 breakpoint(s) given");
}

}  // namespace
}  // namespace isorim::geometry
