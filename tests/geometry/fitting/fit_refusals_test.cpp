#include <limits>

#include <gtest/gtest.h>

#include "geometry/fitting/curve_fit.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/fitting/measured_sections.h"

namespace isorim::geometry {
namespace {

Points<2> section() {
  return testing::measured_sections()[1].points;
}

TEST(FitRefusals, OfPoints) {
  Points<2> points = section();
  points(1, 7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GEOMETRY_ERROR(fit_points(points, CurveFitOptions<2>{}), "coordinate y of point 7 is nan");
  EXPECT_GEOMETRY_ERROR(fit_points(Points<2>(2, 0), CurveFitOptions<2>{}), "0 point(s) given");
  const Points<2> same = Point2(1, 2).replicate(1, 9);
  EXPECT_GEOMETRY_ERROR(fit_points(same, CurveFitOptions<2>{}), "all 9 points are the same");
  EXPECT_GEOMETRY_ERROR(fit_points(Points<2>(section().leftCols(3)), CurveFitOptions<2>{}),
                        "3 distinct points; degree 3 with 0 corners needs 4 or more");
}

TEST(FitRefusals, OfWeights) {
  CurveFitOptions<2> options;
  options.weights = FitWeights::given;
  options.point_weights.assign(43, 1.0);
  options.point_weights[5] = 0.0;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "weight 0 of point 5 is not positive");
  options.point_weights.pop_back();
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "42 weights for 43 points");
  options.weights = FitWeights::uniform;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "another rule for weights");
  CurveFitOptions<2> open;
  open.closed = false;
  open.weights = FitWeights::curvature_radius;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), open), "for closed curves only");
}

TEST(FitRefusals, OfNumbersOfControlPoints) {
  CurveFitOptions<2> options;
  options.control_points = 44;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "44 control points for 43 distinct points");
  options.control_points = 3;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "expected 4 to 43");
  options.control_points = 21;
  options.tolerance = 0.1;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "a number of control points and a tolerance");
}

TEST(FitRefusals, OfKnots) {
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.knots = FitKnots::given;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "there are no breakpoints");
  options.breakpoints = {0.0, 0.2, 0.5, 0.8, 1.1};
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "must run from 0 to 1");
  options.breakpoints = {0.0, 0.5, 0.2, 0.8, 1.0};
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "knots must not fall");
  options.breakpoints = {0.0, 0.5, 0.500001, 0.500002, 0.500003, 0.500004, 1.0};
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "do not determine all 6 control points");
}

TEST(FitRefusals, OfEnds) {
  CurveFitOptions<2> options;
  options.closed = false;
  options.start = FitEnd::tangent;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "the tangent at the start is zero");
  options.start = FitEnd::natural;
  options.degree = 1;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "natural start of a curve of degree 1");
}

TEST(FitRefusals, OfOtherOptions) {
  CurveFitOptions<2> options;
  options.degree = 0;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "degree 0 is out of range");
  options = {};
  options.fairness = -1.0;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "fairness -1");
  options = {};
  options.knot_steps = -1;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "-1 steps of the knots");
  options = {};
  options.peak_steps = -2;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "-2 steps against the largest distance");
  options = {};
  options.corner_angle = 200.0;
  EXPECT_GEOMETRY_ERROR(fit_points(section(), options), "corner angle 200");
}

/// Points on a line make a line, twice along it if closed.
TEST(DegenerateFit, CollinearPoints) {
  Points<2> points(2, 12);
  for (int i = 0; i < 12; ++i) points.col(i) << 0.5 * i, 0.25 * i;
  for (const FitMethod method : {FitMethod::free, FitMethod::fixed_knots}) {
    CurveFitOptions<2> options;
    options.method = method;
    options.closed = false;
    options.control_points = 6;
    const CurveFit<2> fit = fit_points(points, options);
    EXPECT_LT(fit.quality.max_distance, 1e-13);
    EXPECT_LT(fit.quality.bending_energy, 1e-18);
    EXPECT_EQ(fit.quality.curvature_sign_changes, 0);
    options.closed = true;
    EXPECT_LT(fit_points(points, options).curve.control_points().row(0).maxCoeff(), 8.0);
  }
}

/// Two points that are near each other, and far from the others.
TEST(DegenerateFit, NearlyEqualPoints) {
  Points<2> points = section();
  points.col(11) = points.col(10) + Point2(1e-13, 0);
  for (const FitMethod method : {FitMethod::free, FitMethod::fixed_knots}) {
    CurveFitOptions<2> options;
    options.method = method;
    const CurveFit<2> fit = fit_points(points, options);
    EXPECT_LT(fit.quality.max_distance, 0.2);
    EXPECT_TRUE(fit.curve.homogeneous().allFinite());
  }
}

}  // namespace
}  // namespace isorim::geometry
