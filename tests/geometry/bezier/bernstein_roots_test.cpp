#include "geometry/bezier/bernstein_roots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

/// The Bernstein coefficients of the product of (t - root), each as often as it is listed, times `factor`.
std::vector<double> with_roots(const std::vector<double>& roots, double factor = 1.0) {
  std::vector<long double> coefficients{factor};
  for (const double root : roots) {
    // Times the linear polynomial with the coefficients -root, 1 - root.
    const auto degree = coefficients.size() - 1;
    std::vector<long double> next(degree + 2, 0.0L);
    for (std::size_t i = 0; i <= degree; ++i) {
      const long double share = static_cast<long double>(i + 1) / static_cast<long double>(degree + 1);
      next[i] += coefficients[i] * -static_cast<long double>(root) *
                 (static_cast<long double>(degree + 1 - i) / static_cast<long double>(degree + 1));
      next[i + 1] += coefficients[i] * (1.0L - static_cast<long double>(root)) * share;
    }
    coefficients = next;
  }
  return {coefficients.begin(), coefficients.end()};
}

double value(const std::vector<double>& coefficients, double t) {
  std::vector<long double> work(coefficients.begin(), coefficients.end());
  for (std::size_t last = work.size() - 1; last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) work[i] += static_cast<long double>(t) * (work[i + 1] - work[i]);
  return static_cast<double>(work[0]);
}

double largest(const std::vector<double>& coefficients) {
  double size = 0.0;
  for (const double c : coefficients) size = std::max(size, std::abs(c));
  return size;
}

TEST(BernsteinRoots, SimpleRootsAreFoundToRounding) {
  Random random(21);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> roots;
    double t = 0.0;
    while (roots.size() < 6 && (t += random.real(0.05, 0.4)) < 1.0) roots.push_back(t);
    std::vector<double> all = roots;
    for (int i = random.integer(0, 3); i-- > 0;) all.push_back(random.real(1.1, 3.0));
    if (all.empty()) continue;
    const std::vector<double> coefficients = with_roots(all, random.real(-1, 1));
    const double tolerance = 1e-16 * largest(coefficients);
    const std::vector<Interval> found = bernstein_roots(coefficients, tolerance);
    ASSERT_EQ(found.size(), roots.size()) << trial;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      EXPECT_EQ(found[i].first, found[i].last);
      const double slope = (value(coefficients, roots[i] + 1e-6) - value(coefficients, roots[i] - 1e-6)) / 2e-6;
      EXPECT_LE(std::abs(found[i].first - roots[i]), 4e-16 + 20.0 * tolerance / std::abs(slope)) << trial;
    }
  }
}

TEST(BernsteinRoots, MultipleRootsComeOnce) {
  Random random(22);
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  for (int trial = 0; trial < 2000; ++trial) {
    const double multiple = trial % 4 == 0 ? 0.5 : random.real(0.1, 0.5);
    const int multiplicity = random.integer(2, 4);
    const double simple = random.real(0.8, 0.95);
    std::vector<double> all(static_cast<std::size_t>(multiplicity), multiple);
    all.push_back(simple);
    const std::vector<double> coefficients = with_roots(all);
    const double tolerance = 4.0 * epsilon * largest(coefficients);
    const std::vector<Interval> found = bernstein_roots(coefficients, tolerance);
    ASSERT_EQ(found.size(), 2u) << trial;
    EXPECT_NEAR(found[0].middle(), multiple, 2.0 * std::pow(100.0 * epsilon, 1.0 / multiplicity));
    EXPECT_LE(std::abs(value(coefficients, found[0].first)), 2.0 * tolerance);
    EXPECT_LE(std::abs(value(coefficients, found[0].last)), 2.0 * tolerance);
    EXPECT_NEAR(found[1].middle(), simple, 1e-11);
  }
}

TEST(BernsteinRoots, RootsAtTheEndsAreExact) {
  for (int at_first = 0; at_first <= 3; ++at_first)
    for (int at_last = 0; at_last <= 3; ++at_last)
      for (int inside = 0; inside <= 2; ++inside) {
        std::vector<double> all(static_cast<std::size_t>(at_first), 0.0);
        all.insert(all.end(), static_cast<std::size_t>(at_last), 1.0);
        if (inside > 0) all.push_back(0.25);
        if (inside > 1) all.push_back(0.75);
        const std::vector<Interval> found = bernstein_roots(with_roots(all), 1e-16);
        std::vector<double> expected;
        if (at_first > 0) expected.push_back(0.0);
        if (inside > 0) expected.push_back(0.25);
        if (inside > 1) expected.push_back(0.75);
        if (at_last > 0) expected.push_back(1.0);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i].middle(), expected[i], 1e-15);
        if (at_first > 0) {
          EXPECT_EQ(found.front().first, 0.0);
        }
        if (at_last > 0) {
          EXPECT_EQ(found.back().last, 1.0);
        }
      }
}

TEST(BernsteinRoots, NearlyDoubleRootsAreTwoOrNoneOrOneWithinTheTolerance) {
  for (const double gap : {1e-2, 1e-4, 1e-6}) {
    EXPECT_EQ(bernstein_roots(with_roots({0.3 - gap, 0.3 + gap}), 1e-16).size(), 2u) << gap;
    std::vector<double> lifted = with_roots({0.3, 0.3});
    for (double& c : lifted) c += gap * gap;
    EXPECT_EQ(bernstein_roots(lifted, 1e-16).size(), 0u) << gap;
    EXPECT_EQ(bernstein_roots(lifted, 1.1 * gap * gap).size(), 1u) << gap;
  }
}

TEST(BernsteinRoots, ZeroPolynomialsAndConstants) {
  const std::vector<Interval> zero = bernstein_roots(std::vector<double>{1e-17, -1e-17, 0.0}, 1e-16);
  ASSERT_EQ(zero.size(), 1u);
  EXPECT_EQ(zero[0].first, 0.0);
  EXPECT_EQ(zero[0].last, 1.0);
  EXPECT_TRUE(bernstein_roots(std::vector<double>{0.5}, 0.0).empty());
  EXPECT_EQ(bernstein_roots(std::vector<double>{0.0}, 0.0).size(), 1u);
  EXPECT_EQ(bernstein_roots(std::vector<double>{0.0, 0.0, 1.0}, 0.0).size(), 1u);
}

TEST(BernsteinRoots, TolerancesMayVaryAlongTheInterval) {
  // A weight of 1e-6 at one end: there 1e-12 is a distance of 1e-6 from the line, not rounding.
  const std::vector<double> coefficients{1.0, 1e-12, -1e-12};
  const std::vector<double> tolerances{1e-11, 1e-17, 1e-17};
  EXPECT_EQ(bernstein_roots(coefficients, tolerances).size(), 1u);
  EXPECT_LT(bernstein_roots(coefficients, tolerances)[0].last, 1.0);
  EXPECT_EQ(bernstein_roots(coefficients, 1e-11)[0].last, 1.0);
}

TEST(BernsteinRoots, ManyRootsOfHighDegree) {
  Random random(23);
  for (int degree = 5; degree <= 30; degree += 5) {
    std::vector<double> roots;
    for (int i = 0; i < degree; ++i) roots.push_back((i + random.real(0.3, 0.7)) / degree);
    const std::vector<double> coefficients = with_roots(roots);
    // Beyond degree 20 roots in the middle are worse conditioned than this tells apart; none may be invented.
    const std::vector<Interval> found = bernstein_roots(coefficients, 1e-300);
    ASSERT_LE(found.size(), roots.size());
    if (degree <= 20) {
      ASSERT_EQ(found.size(), roots.size()) << degree;
    }
    for (const Interval& root : found) {
      const double nearest = std::ranges::min(roots, {}, [&](double r) { return std::abs(r - root.middle()); });
      EXPECT_NEAR(root.middle(), nearest, degree <= 10 ? 1e-11 : 1e-3) << degree;
    }
  }
}

TEST(BernsteinRoots, RandomPolynomialsChangeSignExactlyAtTheirRoots) {
  Random random(24);
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<double> coefficients(static_cast<std::size_t>(random.integer(1, 12)));
    for (double& c : coefficients) c = random.real(-1, 1);
    const std::vector<Interval> found = bernstein_roots(coefficients, 1e-16);
    double before = 0.0;
    for (std::size_t i = 0; i <= found.size(); ++i) {
      const double from = i == 0 ? 0.0 : found[i - 1].last;
      const double to = i == found.size() ? 1.0 : found[i].first;
      const double sign = value(coefficients, 0.5 * (from + to)) > 0.0 ? 1.0 : -1.0;
      EXPECT_NE(sign, before) << trial;
      before = sign;
      for (int k = 1; k < 20; ++k)
        EXPECT_GT(sign * value(coefficients, from + (to - from) * k / 20.0), -1e-15) << trial;
    }
  }
}

TEST(BernsteinRoots, RefusesBadInput) {
  EXPECT_GEOMETRY_ERROR(bernstein_roots(std::vector<double>{}, 0.0), "no coefficient");
  EXPECT_GEOMETRY_ERROR(bernstein_roots(std::vector<double>{1.0, std::nan("")}, 0.0), "coefficient 1 is nan");
  EXPECT_GEOMETRY_ERROR(bernstein_roots(std::vector<double>{1.0, 2.0}, std::vector<double>{0.0}),
                        "2 coefficients but 1 tolerances");
}

}  // namespace
}  // namespace isorim::geometry
