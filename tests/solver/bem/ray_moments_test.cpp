#include "solver/bem/ray_moments.h"

#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "solver/bem/ray_rule.h"
#include "tests/solver/bem/exact_fields.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;
using ::testing::HasSubstr;
using testing::integrand;

constexpr std::array<RayMoment, 5> all_kinds{RayMoment::plain, RayMoment::linear, RayMoment::logarithmic,
                                             RayMoment::difference, RayMoment::quotient};

TEST(RayRule, LogarithmicWeightsIntegratePolynomials) {
  for (const int n : {2, 6, 10, 16}) {
    const RayRule& rule = ray_rule(n);
    for (int power = 0; power < n; ++power) {
      double sum = 0.0;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) sum += rule.log_weights[k] * std::pow(rule.nodes[k], power);
      EXPECT_NEAR(sum, 1.0 / ((power + 2.0) * (power + 2.0)), 2e-16) << n << " points, power " << power;
    }
  }
}

TEST(RayRule, TailSeesTheTwoHighestDegreesAlone) {
  const RayRule& rule = ray_rule(6);
  const auto tail = [&](int power) {
    double sum = 0.0;
    double last = 0.0;
    for (std::size_t k = 0; k < 6; ++k) {
      sum += rule.tail[k] * std::pow(rule.nodes[k], power);
      last += rule.tail[6 + k] * std::pow(rule.nodes[k], power);
    }
    return std::max(std::abs(sum), std::abs(last));
  };
  EXPECT_LT(tail(3), 1e-15);
  EXPECT_GT(tail(4), 1e-3);
  EXPECT_GT(tail(5), 1e-3);
}

/// Nodes at given ends of rays; normals and weights play no part.
template <int Dim>
struct RayEnds {
  explicit RayEnds(const geometry::Points<Dim>& points) : weight(static_cast<std::size_t>(points.cols()), 1.0) {
    for (std::size_t i = 0; i < Dim; ++i) {
      for (Eigen::Index q = 0; q < points.cols(); ++q) position[i].push_back(points(static_cast<Eigen::Index>(i), q));
      view.position[i] = position[i];
    }
    view.weight = weight;
  }
  std::array<std::vector<double>, Dim> position;
  std::vector<double> weight;
  quadrature::NodeView<Dim> view;
};

TEST(QuadraticRays, AgreeWithSampledRays) {
  Quadratic<3> f{2.0, {1.0, -3.0, 0.5}, {}};
  f.quadratic << 1.0, 2.0, 0.0, -1.0, 3.0, 0.0, 4.0, 0.0, -2.0;
  const geometry::ElementTable<3> table = geometry::bezier_elements(geometry::sphere(1.0));
  const std::vector<quadrature::IntegrandFactory<3>> sampled{
      integrand<3>([f](const Point3& x, const Vector3&) { return f(x); })};
  geometry::Points<3> ends(3, 3);
  ends << 0.5, -1.0, 0.2, 0.25, 0.7, -1.3, 0.125, 0.1, 0.9;
  const RayEnds<3> rays(ends);
  const Point3 target(0.3, -0.2, 0.4);
  std::array<Eigen::MatrixXd, 5> exact;
  std::array<Eigen::MatrixXd, 5> found;
  quadratic_rays<3>({f})->moments(target, rays.view, all_kinds, exact);
  const RayResolution<3> resolution = resolve_along_chords<3>(sampled, table, 1e-13);
  EXPECT_EQ(resolution.order, 6);
  sampled_rays<3>(sampled, "the load", resolution, 1e-13)->moments(target, rays.view, all_kinds, found);
  for (std::size_t m = 0; m < all_kinds.size(); ++m)
    EXPECT_LT((exact[m] - found[m]).cwiseAbs().maxCoeff(), 2e-14) << "kind " << m;
}

/// exp(c x) along the x axis from the origin: moments in closed form.
TEST(SampledRays, MomentsOfAnExponential) {
  constexpr double c = 3.0;
  const geometry::ElementTable<2> table = geometry::bezier_elements(geometry::disc(1.0));
  const std::vector<quadrature::IntegrandFactory<2>> f{
      integrand<2>([](const Point2& x, const geometry::Vector2&) { return std::exp(c * x[0]); })};
  geometry::Points<2> ends(2, 1);
  ends << 1.0, 0.0;
  const RayEnds<2> rays(ends);
  std::array<Eigen::MatrixXd, 5> found;
  sampled_rays<2>(f, "the load", resolve_along_chords<2>(f, table, 1e-14), 1e-14)
      ->moments(Point2::Zero(), rays.view, all_kinds, found);
  double logarithmic = 0.0;
  double quotient = 0.0;
  double term = 1.0;
  for (int k = 0; k < 40; ++k) {
    logarithmic += term / ((k + 2.0) * (k + 2.0));
    if (k > 0) quotient += term / k;
    term *= c / (k + 1.0);
  }
  EXPECT_NEAR(found[0](0, 0), (std::exp(c) - 1.0) / c, 1e-13);
  EXPECT_NEAR(found[1](0, 0), (std::exp(c) * (c - 1.0) + 1.0) / (c * c), 1e-13);
  EXPECT_NEAR(found[2](0, 0), logarithmic, 1e-13);
  EXPECT_NEAR(found[3](0, 0), (std::exp(c) - 1.0) / c - 1.0, 1e-13);
  EXPECT_NEAR(found[4](0, 0), quotient, 1e-13);
}

TEST(SampledRays, NarrowPeaksAreFound) {
  const geometry::ElementTable<3> table = geometry::bezier_elements(geometry::sphere(1.0));
  for (const double width : {0.3, 0.03, 0.005}) {
    const Point3 centre(0.31, -0.17, 0.23);
    const std::vector<quadrature::IntegrandFactory<3>> f{integrand<3>(
        [=](const Point3& x, const Vector3&) { return std::exp(-(x - centre).squaredNorm() / (width * width)); })};
    const RayResolution<3> resolution = resolve_along_chords<3>(f, table, 1e-12);
    if (width < 0.1) {
      ASSERT_EQ(resolution.peaks.size(), 1U) << width;
      EXPECT_LT((resolution.peaks[0].place - centre).norm(), 1e-3 * width) << width;
    }
    // Through the centre, to half as far on the other side.
    geometry::Points<3> ends(3, 1);
    ends.col(0) = 1.5 * centre;
    const RayEnds<3> rays(ends);
    std::array<Eigen::MatrixXd, 1> found;
    const std::array<RayMoment, 1> kind{RayMoment::plain};
    sampled_rays<3>(f, "the load", resolution, 1e-12)->moments(-0.5 * centre, rays.view, kind, found);
    const double length = 2.0 * centre.norm();
    const double exact = 0.5 * width * std::sqrt(std::acos(-1.0)) *
                         (std::erf(0.75 * length / width) + std::erf(0.25 * length / width)) / length;
    EXPECT_NEAR(found[0](0, 0), exact, 1e-12) << width;
  }
}

TEST(SampledRays, StepsAreBisectedToTheTolerance) {
  const geometry::ElementTable<2> table = geometry::bezier_elements(geometry::disc(1.0));
  const std::vector<quadrature::IntegrandFactory<2>> f{
      integrand<2>([](const Point2& x, const geometry::Vector2&) { return x[0] > 0.3 ? 1.0 : 0.0; })};
  geometry::Points<2> ends(2, 1);
  ends << 1.0, 0.0;
  const RayEnds<2> rays(ends);
  std::array<Eigen::MatrixXd, 2> found;
  const std::array<RayMoment, 2> kinds{RayMoment::plain, RayMoment::linear};
  sampled_rays<2>(f, "the load", resolve_along_chords<2>(f, table, 1e-12), 1e-12)
      ->moments(Point2::Zero(), rays.view, kinds, found);
  EXPECT_NEAR(found[0](0, 0), 0.7, 2e-12);
  EXPECT_NEAR(found[1](0, 0), 0.5 * (1.0 - 0.09), 2e-12);
}

TEST(SampledRays, ValuesThatAreNotFiniteAreNamed) {
  const geometry::ElementTable<2> table = geometry::bezier_elements(geometry::disc(1.0));
  const std::vector<quadrature::IntegrandFactory<2>> f{
      integrand<2>([](const Point2& x, const geometry::Vector2&) { return std::sqrt(x[0]); })};
  geometry::Points<2> ends(2, 1);
  ends << -1.0, 0.0;
  const RayEnds<2> rays(ends);
  std::array<Eigen::MatrixXd, 1> found;
  const std::array<RayMoment, 1> kind{RayMoment::plain};
  const auto sampled = sampled_rays<2>(f, "the load", resolve_along_chords<2>(f, table, 1e-12), 1e-12);
  try {
    sampled->moments(Point2(0.0, 0.0), rays.view, kind, found);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the load is nan at (-0."));
    EXPECT_THAT(error.what(), HasSubstr("not convex"));
  }
}

}  // namespace
}  // namespace isorim::solver
