#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/fill.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/refusals.h"

/// Random closed splines, simple and crossed, against brute force.
namespace isorim::geometry {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::refusal;

struct RandomShapes {
  std::mt19937 generator;

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }

  /// A closed spline of degree 2 to 4 about the origin; the more its control points wander, the more often it crosses
  /// itself.
  NurbsCurve<2> closed_spline(double wander) {
    const int count = 5 + static_cast<int>(uniform(0.0, 12.0));
    std::vector<double> breakpoints;
    for (int i = 0; i <= count; ++i) breakpoints.push_back(static_cast<double>(i) / count);
    const KnotVector knots = KnotVector::periodic(2 + static_cast<int>(uniform(0.0, 3.0)), breakpoints);
    Points<2> period(2, count);
    std::vector<double> weight_of(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + uniform(0.0, wander)) / count;
      const double radius = uniform(0.5, 2.5);
      period.col(i) << radius * std::cos(angle), radius * std::sin(angle);
      weight_of[static_cast<std::size_t>(i)] = uniform(0.3, 2.3);
    }
    Points<2> points(2, knots.basis_count());
    std::vector<double> weights;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      points.col(i) = period.col(i % count);
      weights.push_back(weight_of[static_cast<std::size_t>(i % count)]);
    }
    return clamp(NurbsCurve<2>::from_points(knots, points, weights));
  }

  Boundary<2> region(double wander, int holes, double largest_hole) {
    Boundary<2> result{{{"outer", closed_spline(wander)}}};
    for (int i = 0; i < holes; ++i) {
      const Vector2 radii(uniform(0.02, largest_hole), uniform(0.02, largest_hole));
      const Point2 centre(uniform(-0.8, 0.8), uniform(-0.8, 0.8));
      result.patches.push_back({fmt::format("hole_{}", i), ellipse_curve(radii, centre, uniform(0.0, 3.0))});
    }
    return result;
  }
};

double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool segments_cross(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  return (turn(a, b, c) > 0.0) != (turn(a, b, d) > 0.0) && (turn(c, d, a) > 0.0) != (turn(c, d, b) > 0.0);
}

/// Every chord of every curve against every other one.
bool crosses_by_brute_force(const Boundary<2>& boundary) {
  constexpr std::size_t count = 800;
  std::vector<std::vector<Point2>> chains;
  for (const Patch<2>& patch : boundary.patches) {
    const Interval domain = patch.shape.domain();
    std::vector<Point2>& chain = chains.emplace_back();
    for (std::size_t i = 0; i <= count; ++i) {
      chain.push_back(evaluate(patch.shape, domain.first + domain.length() * static_cast<double>(i) / count));
    }
  }
  for (std::size_t a = 0; a < chains.size(); ++a) {
    for (std::size_t b = a; b < chains.size(); ++b) {
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = a == b ? i + 2 : 0; j < count; ++j) {
          if (a == b && i == 0 && j + 1 == count) continue;
          if (segments_cross(chains[a][i], chains[a][i + 1], chains[b][j], chains[b][j + 1])) return true;
        }
      }
    }
  }
  return false;
}

TEST(RandomLoops, AreRefusedExactlyIfTheirChordsCross) {
  RandomShapes random{std::mt19937(29)};
  int crossing = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const Boundary<2> shape = random.region(random.uniform(0.0, 1.5), trial % 2, 0.6);
    const bool crosses = crosses_by_brute_force(shape);
    crossing += crosses ? 1 : 0;
    const std::string message = refusal([&] { orient(shape); });
    if (crosses) {
      EXPECT_THAT(message, AnyOf(HasSubstr("crosses itself"), HasSubstr("loops cross"))) << trial;
    } else {
      EXPECT_EQ(message, "(nothing was refused)") << trial;
    }
  }
  EXPECT_GT(crossing, 20);
  EXPECT_LT(crossing, 130);
}

TEST(RandomLoops, AreFilledOnceWithPositiveJacobian) {
  RandomShapes random{std::mt19937(31)};
  const testing::GaussRule rule = testing::gauss_rule(20);
  int filled = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Boundary<2> shape = random.region(0.6, trial % 4, 0.2);
    OrientedBoundary<2> oriented;
    try {
      oriented = orient(shape);
    } catch (const GeometryError&) {
      continue;
    }
    double area = 0.0;
    double least = 1.0;
    for (const NurbsSurface<2>& patch : fill(shape)) {
      const std::vector<double> breaks = patch.knots_v().breakpoints();
      for (std::size_t j = 0; j + 1 < breaks.size(); ++j) {
        const double length = breaks[j + 1] - breaks[j];
        for (std::size_t l = 0; l < rule.nodes.size(); ++l) {
          // The Jacobian is linear in u and vanishes at u = 0: one point integrates it.
          const SurfaceJet<2> jet = evaluate_jet(patch, Point2(0.5, breaks[j] + length * rule.nodes[l]));
          const double jacobian = jet.du.x() * jet.dv.y() - jet.du.y() * jet.dv.x();
          least = std::min(least, jacobian);
          area += length * rule.weights[l] * jacobian;
        }
      }
    }
    const double expected = testing::measures(oriented.boundary).content;
    EXPECT_NEAR(area, expected, 1e-11 * expected) << trial;
    EXPECT_GT(least, 0.0) << trial;
    ++filled;
  }
  EXPECT_GT(filled, 30);
}

}  // namespace
}  // namespace isorim::geometry
