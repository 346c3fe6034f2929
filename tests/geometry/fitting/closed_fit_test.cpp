#include <array>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/section_rules.h"
#include "geometry/spline/bspline.h"
#include "tests/geometry/fitting/measured_sections.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using ::testing::ElementsAre;
using testing::measured_sections;
using testing::MeasuredSection;
using testing::Random;

/// The jump of each derivative below `degree` across the closing point, relative to its largest value on the curve.
template <int Dim>
double closing_jump(const NurbsCurve<Dim>& curve) {
  const BSpline spline{curve.knots(), curve.control_points()};
  const int orders = curve.degree() - 1;
  const Interval domain = curve.domain();
  Eigen::RowVectorXd largest = Eigen::RowVectorXd::Zero(orders + 1);
  for (int i = 0; i <= 200; ++i)
    largest = largest.cwiseMax(
        evaluate_derivatives(spline, domain.first + domain.length() * i / 200, orders).colwise().norm());
  const Eigen::MatrixXd jump =
      evaluate_derivatives(spline, domain.first, orders) - evaluate_derivatives(spline, domain.last, orders);
  return (jump.colwise().norm().array() / largest.array()).maxCoeff();
}

TEST(ClosedFit, IsSmoothAcrossTheClosingPoint) {
  const Points<2>& points = measured_sections()[1].points;
  for (const FitMethod method : {FitMethod::free, FitMethod::fixed_knots})
    for (int degree = 1; degree <= 6; ++degree) {
      CurveFitOptions<2> options;
      options.method = method;
      options.degree = degree;
      options.control_points = 21;
      const CurveFit<2> fit = fit_points(points, options);
      EXPECT_EQ(fit.control_points, 21);
      EXPECT_EQ(fit.curve.control_points().rightCols(degree), fit.curve.control_points().leftCols(degree));
      EXPECT_LT(closing_jump(fit.curve), 1e-10) << degree;
    }
  CurveFitOptions<2> options;
  options.method = FitMethod::pereira;
  EXPECT_LT(closing_jump(fit_points(points, options).curve), 1e-10);
}

/// Values of a periodic spline at uniform parameters give its control points back.
TEST(ClosedFit, ReproducesASplineOnItsKnots) {
  Random random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const int degree = random.integer(1, 7);
    const int spans = random.integer(degree + 1, degree + 12);
    std::vector<double> breakpoints{0.0};
    for (int i = 0; i < spans; ++i) breakpoints.push_back(breakpoints.back() + random.real(0.4, 1.0));
    for (double& u : breakpoints) u /= breakpoints.back();
    breakpoints.back() = 1.0;
    const KnotVector knots = KnotVector::periodic(degree, breakpoints);
    Points<3> control(3, knots.basis_count());
    for (double& x : control.reshaped()) x = random.real(-1, 1);
    control.rightCols(degree) = control.leftCols(degree);
    const NurbsCurve<3> curve = NurbsCurve<3>::from_points(knots, control);
    const int count = 6 * spans;
    Points<3> points(3, count);
    for (int i = 0; i < count; ++i) points.col(i) = evaluate(curve, static_cast<double>(i) / count);
    CurveFitOptions<3> options;
    options.method = FitMethod::fixed_knots;
    options.degree = degree;
    options.parameters = FitParameters::uniform;
    options.knots = FitKnots::given;
    options.breakpoints = breakpoints;
    const CurveFit<3> fit = fit_points(points, options);
    EXPECT_LT((fit.curve.control_points() - control).cwiseAbs().maxCoeff(), 1e-11) << degree;
    EXPECT_LT(fit.quality.max_distance, 1e-13);
  }
}

struct Measured {
  double max_distance;
  double rms_distance;
  double bending_energy;
  int sign_changes;
};

void expect_quality(const FitQuality<2>& quality, const Measured& expected) {
  EXPECT_NEAR(quality.max_distance, expected.max_distance, 1e-5 * expected.max_distance);
  EXPECT_NEAR(quality.rms_distance, expected.rms_distance, 1e-5 * expected.rms_distance);
  EXPECT_NEAR(quality.bending_energy, expected.bending_energy, 1e-5 * expected.bending_energy);
  EXPECT_EQ(quality.curvature_sign_changes, expected.sign_changes);
}

/// Least squares on uniform knots with chord-length parameters is what SciPy 1.10 computes with task = -1: its curves,
/// measured by another program.
TEST(ClosedFit, AgreesWithFitpackOnUniformKnots) {
  constexpr std::array<Measured, 4> expected{{{0.0500196, 0.0198253, 107.508, 12},
                                              {0.0325044, 0.0133786, 85.5767, 10},
                                              {0.0776735, 0.0203151, 51.0318, 14},
                                              {0.486136, 0.113348, 470.734, 16}}};
  for (std::size_t k = 0; k < 4; ++k) {
    CurveFitOptions<2> options;
    options.method = FitMethod::fixed_knots;
    options.control_points = measured_sections()[k].control_points;
    expect_quality(fit_points(measured_sections()[k].points, options).quality, expected[k]);
  }
}

/// And with s = 0.
TEST(ClosedFit, AgreesWithFitpackOnInterpolation) {
  constexpr std::array<Measured, 4> expected{
      {{0, 0, 187.904, 32}, {0, 0, 115.654, 12}, {0, 0, 158.226, 46}, {0, 0, 509.817, 20}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Points<2>& points = measured_sections()[k].points;
    CurveFitOptions<2> options;
    options.method = FitMethod::fixed_knots;
    options.control_points = static_cast<int>(points.cols());
    const FitQuality<2> quality = fit_points(points, options).quality;
    EXPECT_LT(quality.max_distance, 1e-12);
    EXPECT_NEAR(quality.bending_energy, expected[k].bending_energy, 1e-5 * expected[k].bending_energy);
    EXPECT_EQ(quality.curvature_sign_changes, expected[k].sign_changes);
  }
}

/// Every degree interpolates, even ones with knots between the points.
TEST(ClosedFit, InterpolatesWithAnyDegree) {
  const Points<2>& points = measured_sections()[1].points;
  for (int degree = 1; degree <= 7; ++degree) {
    CurveFitOptions<2> options;
    options.method = FitMethod::fixed_knots;
    options.degree = degree;
    options.control_points = static_cast<int>(points.cols());
    EXPECT_LT(fit_points(points, options).quality.max_distance, 1e-11) << degree;
  }
}

/// Turning, scaling and moving the points does the same to the curve; where many steps lead to it, but for what
/// rounding makes of them.
TEST(ClosedFit, FollowsSimilarities) {
  const MeasuredSection& section = measured_sections()[0];
  AffineMap<2> map;
  map.linear << 0, -1024, 1024, 0;
  map.translation << 2048, -4096;
  Points<2> mapped = section.points;
  for (Eigen::Index i = 0; i < mapped.cols(); ++i) mapped.col(i) = map(section.points.col(i));
  for (const FitMethod method : {FitMethod::fixed_knots, FitMethod::free}) {
    const double tolerance = method == FitMethod::free ? 1e-2 : 1e-9;
    CurveFitOptions<2> options;
    options.method = method;
    const FitQuality<2> quality = fit_points(section.points, options).quality;
    const FitQuality<2> of_mapped = fit_points(mapped, options).quality;
    EXPECT_NEAR(of_mapped.max_distance, 1024 * quality.max_distance, 1024 * tolerance * quality.max_distance);
    EXPECT_NEAR(of_mapped.bending_energy, quality.bending_energy, tolerance * quality.bending_energy);
    EXPECT_EQ(of_mapped.curvature_sign_changes, quality.curvature_sign_changes);
  }
}

TEST(ClosedFit, TheLastPointMayRepeatTheFirst) {
  const MeasuredSection& section = measured_sections()[2];
  Points<2> repeated(2, section.points.cols() + 2);
  repeated << section.points.leftCols(1), section.points, section.points.leftCols(1);
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.control_points = 54;
  options.weights = FitWeights::given;
  options.point_weights.assign(static_cast<std::size_t>(repeated.cols()), 1.0);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, options.point_weights.size() - 1})
    options.point_weights[i] = 1.0 / 3.0;
  const CurveFit<2> fit = fit_points(repeated, options);
  options.weights = FitWeights::uniform;
  options.point_weights.clear();
  const CurveFit<2> plain = fit_points(section.points, options);
  EXPECT_LT((fit.curve.control_points() - plain.curve.control_points()).norm(), 1e-10);
  ASSERT_EQ(fit.parameters.size(), 110);
  EXPECT_EQ(fit.parameters[0], fit.parameters[1]);
  EXPECT_EQ(fit.parameters[0], fit.parameters[109]);
}

/// A weight of 4 is four points.
TEST(ClosedFit, WeightsCountAsRepetitions) {
  const MeasuredSection& section = measured_sections()[1];
  Points<2> repeated(2, section.points.cols() + 3);
  repeated << section.points.leftCols(11), section.points.col(10), section.points.col(10), section.points.col(10),
      section.points.rightCols(section.points.cols() - 11);
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.control_points = 21;
  const CurveFit<2> fit = fit_points(repeated, options);
  options.weights = FitWeights::given;
  options.point_weights.assign(static_cast<std::size_t>(section.points.cols()), 1.0);
  options.point_weights[10] = 4.0;
  const CurveFit<2> weighted = fit_points(section.points, options);
  EXPECT_LT((fit.curve.control_points() - weighted.curve.control_points()).norm(), 1e-11);
}

TEST(ClosedFit, CurvatureWeightsAreThoseOfTheRule) {
  const MeasuredSection& section = measured_sections()[3];
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.control_points = 37;
  options.weights = FitWeights::curvature_radius;
  const CurveFit<2> fit = fit_points(section.points, options);
  options.weights = FitWeights::given;
  options.point_weights = curvature_weights(circle_radii(section.points));
  EXPECT_EQ(fit_points(section.points, options).curve.control_points(), fit.curve.control_points());
}

/// The number of control points is one key, or follows from the tolerance, or from the inversion rule.
TEST(ClosedFit, ChoosesTheNumberOfControlPoints) {
  for (const MeasuredSection& section : measured_sections()) {
    EXPECT_EQ(fit_points(section.points, CurveFitOptions<2>{}).control_points, section.control_points);
    for (const double relative : {1e-2, 1e-3, 1e-4}) {
      CurveFitOptions<2> options;
      options.tolerance = relative * (section.points.rowwise().maxCoeff() - section.points.rowwise().minCoeff()).norm();
      const CurveFit<2> fit = fit_points(section.points, options);
      EXPECT_TRUE(fit.tolerance_met);
      EXPECT_LE(fit.quality.max_distance, options.tolerance);
      EXPECT_LE(fit.control_points, section.points.cols());
    }
  }
}

/// Noise makes two corners of one: the sharper one stays, so that there are data from each corner to the next.
TEST(ClosedFit, OfNeighbouringCornersTheSharpestStays) {
  Points<2> points(2, 42);
  for (int i = 0; i < 40; ++i) {
    const double t = pi * i / 40;
    points.col(i) << std::cos(t), std::sin(t);
  }
  points.col(40) << -1.0, -0.05;
  points.col(41) << 0.9, -0.1;
  for (const int degree : {2, 3}) {
    CurveFitOptions<2> options;
    options.degree = degree;
    options.corner_angle = 60;
    options.control_points = 20;
    const CurveFit<2> fit = fit_points(points, options);
    for (std::size_t i = 0; i < fit.corners.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const int steps = fit.corners[i] - fit.corners[j];
        EXPECT_GE(std::min(steps, 42 - steps), degree);
      }
    EXPECT_GE(fit.corners.size(), 1U);
    EXPECT_LT(fit.quality.rms_distance, 0.05);
  }
}

/// A square with points along its sides: straight lines between four corners, exactly.
TEST(ClosedFit, KeepsCorners) {
  const int side = 8;
  Points<2> points(2, 4 * side);
  for (int i = 0; i < side; ++i) {
    const double t = static_cast<double>(i) / side;
    // Not starting at a corner.
    points.col((i + 29) % 32) << t, 0;
    points.col((i + 37) % 32) << 1, t;
    points.col((i + 45) % 32) << 1 - t, 1;
    points.col((i + 53) % 32) << 0, 1 - t;
  }
  for (const FitMethod method : {FitMethod::free, FitMethod::fixed_knots}) {
    CurveFitOptions<2> options;
    options.method = method;
    options.corner_angle = 30;
    options.control_points = 20;
    const CurveFit<2> fit = fit_points(points, options);
    EXPECT_THAT(fit.corners, ElementsAre(5, 13, 21, 29));
    EXPECT_LT(fit.quality.max_distance, 1e-14);
    EXPECT_LT(fit.quality.bending_energy, 1e-20);
    EXPECT_EQ(fit.control_points, 20);
    EXPECT_EQ(evaluate(fit.curve, 0.0), evaluate(fit.curve, 1.0));
    for (const double corner : {0.25, 0.5, 0.75}) {
      EXPECT_EQ(fit.curve.knots().multiplicity(corner), 3);
      const Point2 point = evaluate(fit.curve, corner);
      EXPECT_LT(std::min(std::abs(point[0]), std::abs(point[0] - 1)), 1e-14);
      EXPECT_LT(std::min(std::abs(point[1]), std::abs(point[1] - 1)), 1e-14);
    }
  }
}

/// Fairness trades distance for smoothness.
TEST(ClosedFit, FairnessLowersTheBendingEnergy) {
  const MeasuredSection& section = measured_sections()[0];
  for (const int derivative : {2, 3}) {
    double last = 1e9;
    double last_rms = 0.0;
    for (const double mu : {0.0, 1e-9, 1e-8, 1e-7}) {
      CurveFitOptions<2> options;
      options.method = FitMethod::fixed_knots;
      options.control_points = 50;
      options.fairness_derivative = derivative;
      options.fairness = derivative == 2 ? mu : 1e-4 * mu;
      const FitQuality<2> quality = fit_points(section.points, options).quality;
      EXPECT_LT(quality.bending_energy, last) << mu;
      EXPECT_GT(quality.rms_distance, last_rms) << mu;
      last = quality.bending_energy;
      last_rms = quality.rms_distance;
    }
  }
}

}  // namespace
}  // namespace isorim::geometry
