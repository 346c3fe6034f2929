#include "geometry/spline/interpolation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

const std::vector<double> parameters{0.0, 0.1, 0.35, 0.4, 0.7, 0.85, 1.0};

TEST(AveragedKnots, AreMeansOfThreeParameters) {
  const KnotVector knots = averaged_knots(3, parameters);
  EXPECT_EQ(knots.basis_count(), 7);
  EXPECT_NEAR(knots[4], (0.1 + 0.35 + 0.4) / 3.0, 1e-16);
  EXPECT_NEAR(knots[6], (0.4 + 0.7 + 0.85) / 3.0, 1e-16);
  EXPECT_TRUE(knots.is_clamped());
}

TEST(Interpolate, PassesThroughItsValues) {
  Eigen::MatrixXd values(2, 7);
  values << 1, -2, 3, 0, 5, 1, 1, 0, 0, 4, 4, -1, 2, 8;
  const BSpline spline = interpolate(averaged_knots(3, parameters), parameters, values);
  for (std::size_t k = 0; k < parameters.size(); ++k)
    EXPECT_LE((evaluate(spline, parameters[k]) - values.col(static_cast<Eigen::Index>(k))).norm(), 1e-14);
}

TEST(Interpolate, ReproducesCubicsAndConvergesWithOrderFour) {
  const auto error_with = [](int count, auto function) {
    std::vector<double> at;
    Eigen::MatrixXd values(1, count);
    for (int k = 0; k < count; ++k) {
      at.push_back(static_cast<double>(k) / (count - 1));
      values(0, k) = function(at.back());
    }
    const BSpline spline = interpolate(averaged_knots(3, at), at, values);
    double worst = 0.0;
    for (double t = 0.0; t <= 1.0; t += 0.003) worst = std::max(worst, std::abs(evaluate(spline, t)[0] - function(t)));
    return worst;
  };
  EXPECT_LE(error_with(9, [](double t) { return 2.0 - t + t * t * (3.0 - 5.0 * t); }), 1e-14);
  const auto wave = [](double t) { return std::sin(5.0 * t); };
  EXPECT_GT(std::log2(error_with(17, wave) / error_with(33, wave)), 3.7);
}

TEST(Interpolate, RefusesParametersThatLeaveAFunctionOut) {
  const KnotVector knots = KnotVector::clamped_uniform(3, 4);
  const std::vector<double> crowded{0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 1.0};
  EXPECT_THAT(refusal([&] { interpolate(knots, crowded, Eigen::MatrixXd::Zero(1, 7)); }),
              HasSubstr("outside (0.25, 1) where function 4 lives"));
  EXPECT_THAT(refusal([&] { interpolate(knots, parameters, Eigen::MatrixXd::Zero(1, 6)); }),
              HasSubstr("7 parameters and 6 values for 7 functions"));
}

}  // namespace
}  // namespace isorim::geometry
