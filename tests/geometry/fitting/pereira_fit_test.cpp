#include "geometry/fitting/pereira_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/section_rules.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/fitting/measured_sections.h"

namespace isorim::geometry {
namespace {

using testing::measured_sections;
using testing::MeasuredSection;
using testing::worked_section;

/// Table 5.1: every printed digit.
TEST(PereiraFit, StartsOfTheWorkedExample) {
  struct Printed {
    Point2 point;
    double first;
    double second;
    double sum;
    int control_points;
  };
  const std::vector<Printed> table{
      {{30, 10}, 2.8865, 1.3245, 4.2110, 30},   {{31.5, 13}, 5.0157, 2.6420, 7.6577, 30},
      {{33, 16}, 17.6699, 8.9258, 26.5957, 30}, {{40, 23}, 14.9533, 6.0299, 20.9832, 30},
      {{40, 46}, 10.8445, 2.9515, 13.7961, 30}, {{22.5, 58}, 40.3196, 3.8563, 44.1758, 31},
      {{19, 48}, 1.6492, 3.2765, 4.9257, 30},   {{15, 40}, 12.7493, 5.4691, 18.2184, 31},
      {{12, 26}, 4.6527, 1.8931, 6.5458, 30},   {{13.5, 23}, 1.2870, 0.8595, 2.1465, 30},
      {{19, 13}, 12.7321, 3.3305, 16.0627, 30}, {{21, 11}, 6.2034, 8.6913, 14.8947, 30},
      {{29, 8}, 1.3480, 0.7959, 2.1439, 30},
  };
  const Points<2> points = worked_section();
  const std::vector<PereiraStart> starts =
      pereira_starts(points, curvature_weights(circle_radii(points)), 0, PereiraTangent::of_start);
  ASSERT_EQ(starts.size(), table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(points.col(starts[i].point), table[i].point) << i;
    EXPECT_NEAR(starts[i].first_distance, table[i].first, 6e-5) << i;
    EXPECT_NEAR(starts[i].second_distance, table[i].second, 6e-5) << i;
    EXPECT_NEAR(starts[i].sum(), table[i].sum, 6e-5) << i;
    EXPECT_EQ(starts[i].control_points, table[i].control_points) << i;
  }
}

/// Data and weights are published with four decimals, so control points can be had to about two units of the last one.
TEST(PereiraFit, PublishedControlPoints) {
  constexpr std::array<double, 4> tolerances{2.05e-4, 1.0e-4, 1.5e-4, 1.4e-4};
  for (std::size_t k = 0; k < 4; ++k) {
    const MeasuredSection& section = measured_sections()[k];
    const PereiraFit fit = pereira_fit(section.points, section.weights, section.control_points);
    const Points<2> expected = section.published_control.leftCols(section.control_points + 3);
    EXPECT_LT((fit.curve.control_points() - expected).cwiseAbs().maxCoeff(), tolerances[k]) << k;
  }
}

/// Moves inside the box |y_i| <= half that lead to |J y - difference| <= half, by projections onto both in turn.
Eigen::VectorXd rounding_that_explains(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& difference,
                                       double half) {
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(jacobian.cols());
  for (int sweep = 0; sweep < 4000; ++sweep) {
    double largest = 0.0;
    for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
      const double left = difference[i] - jacobian.row(i).dot(moves);
      const double excess = left - std::clamp(left, -half, half);
      largest = std::max(largest, std::abs(excess));
      moves += excess / jacobian.row(i).squaredNorm() * jacobian.row(i).transpose();
    }
    moves = moves.cwiseMax(-half).cwiseMin(half);
    if (largest < 1e-9) break;
  }
  return moves;
}

/// What is left between our control points and the published ones is the rounding of the published data: there are
/// points that round to the published ones and give the published control points to their last printed digit.
TEST(PereiraFit, DifferencesAreTheRoundingOfTheData) {
  // Half a unit of the last digit; the exact number shows that it is not exceeded by the arithmetic here.
  constexpr double half = 5e-5;
  constexpr double step = 1e-5;
  for (std::size_t k = 0; k < 4; ++k) {
    const MeasuredSection& section = measured_sections()[k];
    const auto control = [&](const Points<2>& points) -> Eigen::VectorXd {
      return pereira_fit(points, section.weights, section.control_points)
          .curve.control_points()
          .leftCols(section.control_points)
          .reshaped();
    };
    const Eigen::VectorXd published = section.published_control.leftCols(section.control_points).reshaped();
    Points<2> points = section.points;
    Eigen::MatrixXd jacobian(published.size(), points.size());
    for (Eigen::Index j = 0; j < points.size(); ++j) {
      double& x = points.reshaped()[j];
      const double before = x;
      x = before + step;
      const Eigen::VectorXd after = control(points);
      x = before - step;
      jacobian.col(j) = (after - control(points)) / (2 * step);
      x = before;
    }
    points.reshaped() += rounding_that_explains(jacobian, published - control(points), 0.98 * half);
    EXPECT_LE((points - section.points).cwiseAbs().maxCoeff(), half) << k;
    EXPECT_LE((control(points) - published).cwiseAbs().maxCoeff(), half) << k;
  }
}

/// The distances of the published curves, and their smoothness, as measured by another program from the published
/// control points.
TEST(PereiraFit, QualityOfThePublishedCurves) {
  struct Measured {
    double max_distance;
    double rms_distance;
    double bending_energy;
    int sign_changes;
  };
  constexpr std::array<Measured, 4> expected{{{0.0676968, 0.0235327, 112.236, 12},
                                              {0.0887305, 0.0279369, 104.346, 6},
                                              {0.0932396, 0.0258281, 57.001, 16},
                                              {0.885827, 0.213679, 488.536, 16}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const MeasuredSection& section = measured_sections()[k];
    CurveFitOptions<2> options;
    options.method = FitMethod::pereira;
    options.control_points = section.control_points;
    options.weights = FitWeights::given;
    options.point_weights = section.weights;
    const CurveFit<2> fit = fit_points(section.points, options);
    EXPECT_NEAR(fit.quality.max_distance, expected[k].max_distance, 1e-4) << k;
    EXPECT_NEAR(fit.quality.rms_distance, expected[k].rms_distance, 2e-5) << k;
    EXPECT_NEAR(fit.quality.bending_energy, expected[k].bending_energy, 0.03) << k;
    EXPECT_EQ(fit.quality.curvature_sign_changes, expected[k].sign_changes) << k;
  }
}

/// The examples are published with their start points first.
TEST(PereiraFit, FindsThePublishedStartPoints) {
  for (const MeasuredSection& section : measured_sections()) {
    const std::vector<PereiraStart> starts = pereira_starts(section.points, section.weights);
    const auto best =
        std::min_element(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.sum() < b.sum(); });
    EXPECT_EQ(best->point, 0);
  }
}

TEST(PereiraFit, RefusesWhatTheMethodCannot) {
  const MeasuredSection& section = measured_sections()[0];
  EXPECT_GEOMETRY_ERROR(pereira_fit(section.points, section.weights, 56), "56 control points for 56 points");
  EXPECT_GEOMETRY_ERROR(pereira_fit(section.points, {1.0, 2.0}, 28), "2 weights for 56 points");
  CurveFitOptions<2> options;
  options.method = FitMethod::pereira;
  options.degree = 4;
  EXPECT_GEOMETRY_ERROR(fit_points(section.points, options), "closed curves of degree 3, not closed ones of degree 4");
}

}  // namespace
}  // namespace isorim::geometry
