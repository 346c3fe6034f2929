#include "quadrature/line_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/bezier/subdivision.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/region_moments.h"
#include "tests/quadrature/regions.h"

namespace isorim::quadrature {
namespace {

/// A random curve of about the given length; weights between 1 and largest_weight.
std::vector<double> random_curve(std::mt19937& generator, int degree, double length, double largest_weight) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double margin = 1.0 - length;
  const std::array<double, 2> corner{margin * unit(generator), margin * unit(generator)};
  std::vector<double> net;
  for (int i = 0; i <= degree; ++i) {
    const double weight = 1.0 + (largest_weight - 1.0) * unit(generator);
    net.push_back(weight * (corner[0] + length * unit(generator)));
    net.push_back(weight * (corner[1] + length * unit(generator)));
    net.push_back(weight);
  }
  return net;
}

RegionMoments moments_of(const LineRule& rule, const Orders<2>& counts) {
  RegionMoments moments{counts, std::vector<double>(static_cast<std::size_t>(counts[0] * counts[1]), 0.0), 0.0};
  add_moments(rule, moments);
  return moments;
}

/// The rule of the curve cut into 16 parts, which needs no more points for each part than it says for the whole.
LineRule finer_rule(const CurveNet& curve, const Orders<2>& counts) {
  LineRule rule;
  std::vector<std::vector<double>> parts{{curve.points.begin(), curve.points.end()}};
  for (int level = 0; level < 4; ++level) {
    std::vector<std::vector<double>> halves;
    for (const std::vector<double>& part : parts) {
      auto [first, second] = geometry::subdivide(part, 3, std::array<int, 1>{curve.degree}, 0);
      halves.push_back(std::move(first));
      halves.push_back(std::move(second));
    }
    parts = std::move(halves);
  }
  // Counts far above those in question, so that the rule is finer than it need be.
  const Orders<2> more{counts[0] + 20, counts[1] + 20};
  for (const std::vector<double>& part : parts) append_curve({part, curve.degree, curve.polynomial}, more, rule);
  return rule;
}

double worst_error(const CurveNet& curve, const Orders<2>& counts) {
  LineRule rule;
  append_curve(curve, counts, rule);
  const RegionMoments moments = moments_of(rule, counts);
  const RegionMoments finer = moments_of(finer_rule(curve, counts), counts);
  double worst = 0.0;
  for (std::size_t k = 0; k < moments.values.size(); ++k)
    worst = std::max(worst, std::abs(moments.values[k] - finer.values[k]));
  return worst;
}

TEST(LineRule, BoundedNumberOfPointsIsEnough) {
  std::mt19937 generator(11);
  for (const double length : {1e-3, 0.03, 0.2, 1.0}) {
    for (const int degree : {1, 2, 3, 5, 9}) {
      for (const double largest_weight : {1.0, 1.5, 20.0}) {
        for (const Orders<2> counts : {Orders<2>{4, 4}, Orders<2>{24, 10}, Orders<2>{48, 48}}) {
          const std::vector<double> net = random_curve(generator, degree, length, largest_weight);
          const CurveNet curve{net, degree, largest_weight == 1.0};
          // The polynomials reach 2 n in size near the corners.
          EXPECT_LT(worst_error(curve, counts), 2e-15 * std::max(counts[0], counts[1]))
              << "length " << length << " degree " << degree << " weights " << largest_weight << " counts " << counts[0]
              << " " << counts[1];
        }
      }
    }
  }
}

// As CAD fits them: a loop of sixty cubics.
TEST(LineRule, ShortCurvesNeedFewPoints) {
  geometry::TrimmedRegion region;
  testing::add_blob(region, {0.5, 0.5}, 0.35, 0.1, 3, 60, 1);
  for (const testing::Curve& curve : region.curves) {
    const std::span<const double> net(curve.data(), static_cast<std::size_t>(curve.size()));
    EXPECT_LE(points_along_curve({net, 3, true}, {8, 8}), 9);
    EXPECT_LE(points_along_curve({net, 3, true}, {24, 24}), 11);
    EXPECT_LE(points_along_curve({net, 3, false}, {24, 24}), 12);
  }
}

TEST(LineRule, PolynomialCurvesNeedNoMoreThanIsExact) {
  const std::vector<double> line{0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
  EXPECT_EQ(points_along_curve({line, 1, true}, {4, 4}), 4);
  EXPECT_LE(points_along_curve({line, 1, true}, {30, 30}), 30);
  // int F_0 q_0 dy over the diagonal is 1/2.
  LineRule rule;
  append_curve({line, 1, true}, {30, 30}, rule);
  EXPECT_NEAR(moments_of(rule, {30, 30}).area(), 0.5, 1e-15);
}

// Weights of 1 and 1e8: the bound asks for more points than there are, so the curve is cut.
TEST(LineRule, SharpCurvesAreCut) {
  const std::vector<double> net{0.1, 0.2, 1.0, 5e7, 9e7, 1e8, 0.9, 0.1, 1.0};
  const CurveNet curve{net, 2, false};
  EXPECT_EQ(points_along_curve(curve, {40, 40}), 0);
  EXPECT_LT(worst_error(curve, {40, 40}), 1e-13);
}

}  // namespace
}  // namespace isorim::quadrature
