#include "geometry/spline/smoothest_spline.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/interpolation.h"

namespace isorim::geometry {
namespace {

const std::vector<double> places{0.0, 0.3, 0.7, 1.2, 1.5, 2.0};

double at(const KnotVector& knots, const Eigen::MatrixXd& coefficients, double u, int order = 0) {
  return evaluate_derivatives({knots, coefficients}, u, order)(0, order);
}

TEST(SmoothestSpline, InterpolatesWhereNothingIsLeftFree) {
  const KnotVector knots = averaged_knots(3, places);
  Eigen::MatrixXd values(2, 6);
  values << 0.0, 1.0, -1.0, 2.0, 2.0, 0.5, 3.0, 1.0, 4.0, 1.0, 5.0, 9.0;
  const Eigen::MatrixXd found = SmoothestSpline(knots, {places}).coefficients(values);
  EXPECT_LT((found - interpolate(knots, places, values).coefficients).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(SmoothestSpline, ReproducesQuadratics) {
  const KnotVector knots = doubled_knots(3, places);
  Eigen::MatrixXd values(1, 6);
  for (int k = 0; k < 6; ++k) values(0, k) = 2.0 - places[std::size_t(k)] + 3.0 * std::pow(places[std::size_t(k)], 2);
  const Eigen::MatrixXd found = SmoothestSpline(knots, {places}).coefficients(values);
  for (double u = 0.0; u <= 2.0; u += 0.01) EXPECT_NEAR(at(knots, found, u), 2.0 - u + 3.0 * u * u, 1e-12);
}

TEST(SmoothestSpline, HasTheLeastEnergy) {
  const KnotVector knots = doubled_knots(3, places);
  Eigen::MatrixXd values(1, 6);
  values << 0.0, 1.0, -1.0, 2.0, 2.0, 0.5;
  const Eigen::MatrixXd found = SmoothestSpline(knots, {places}).coefficients(values);
  const auto energy = [&](const Eigen::MatrixXd& c) {
    double sum = 0.0;
    for (const BezierSegment& s : bezier_segments({knots, c}))
      sum += s.domain.length() * std::pow(at(knots, c, s.domain.middle(), 3), 2);
    return sum;
  };
  // Changes that leave the data alone: a spline through zeros there with one more condition.
  const double least = energy(found);
  std::vector<double> more = places;
  more.insert(more.begin() + 2, 0.5);
  Eigen::MatrixXd bump = Eigen::MatrixXd::Zero(1, 7);
  bump(0, 2) = 1e-3;
  const Eigen::MatrixXd change = SmoothestSpline(knots, {more}).coefficients(bump);
  EXPECT_GT(energy(found + change), least * (1.0 + 1e-9));
  EXPECT_GT(energy(found - change), least * (1.0 + 1e-9));
}

TEST(SmoothestSpline, StaysConstantAlongRuns) {
  const KnotVector knots = doubled_knots(3, places);
  Eigen::MatrixXd values(1, 6);
  values << 0.0, 1.0, 1.0, 1.0, 0.2, 0.0;
  const Eigen::MatrixXd found = SmoothestSpline(knots, {places, {{1, 3}}, false}).coefficients(values);
  for (double u = 0.3; u <= 1.2; u += 0.01) EXPECT_DOUBLE_EQ(at(knots, found, u), 1.0);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(at(knots, found, places[std::size_t(k)]), values(0, k), 1e-14);
  EXPECT_LT(at(knots, found, 0.15), 1.0);
}

TEST(SmoothestSpline, IsLevelAtItsStartIfAsked) {
  const KnotVector knots = doubled_knots(3, places);
  Eigen::MatrixXd values(1, 6);
  values << 0.5, 1.0, 2.0, 3.0, 4.0, 5.0;
  const Eigen::MatrixXd found = SmoothestSpline(knots, {places, {}, true}).coefficients(values);
  EXPECT_NEAR(at(knots, found, 0.0, 1), 0.0, 1e-12);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(at(knots, found, places[std::size_t(k)]), values(0, k), 1e-14);
}

TEST(SmoothestSpline, PutsCoefficientsToZero) {
  const KnotVector knots = doubled_knots(3, places);
  Eigen::MatrixXd values(1, 6);
  values << 0.0, 0.1, 2.0, 3.0, 4.0, 5.0;
  EXPECT_LT(SmoothestSpline(knots, {places}).coefficients(values)(0, 1), 0.0);
  const Eigen::MatrixXd found = SmoothestSpline(knots, {places, {}, false, {1, 2}}).coefficients(values);
  EXPECT_EQ(found(0, 1), 0.0);
  EXPECT_EQ(found(0, 2), 0.0);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(at(knots, found, places[std::size_t(k)]), values(0, k), 1e-14);
  EXPECT_THROW(SmoothestSpline(knots, {places, {}, false, {0}}), GeometryError);
}

TEST(SmoothestSpline, RefusesWhatItCannotMeet) {
  const KnotVector few = KnotVector::bezier(3);
  EXPECT_THROW(SmoothestSpline(few, {{0.0, 0.1, 0.2, 0.5, 1.0}}), GeometryError);
  EXPECT_THROW(SmoothestSpline(few, {{0.0, 0.5}}), GeometryError);
  EXPECT_THROW(SmoothestSpline(few, {{0.0, 0.6, 0.4, 1.0}}), GeometryError);
  EXPECT_THROW(SmoothestSpline(few, {{0.0, 1.0}}).coefficients(Eigen::MatrixXd::Zero(1, 3)), GeometryError);
}

}  // namespace
}  // namespace isorim::geometry
