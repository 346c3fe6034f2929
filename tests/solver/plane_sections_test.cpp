#include "solver/plane_sections.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "quadrature/gauss_legendre.h"
#include "solver/properties.h"

namespace isorim::solver {
namespace {

using geometry::PlaneCutter;
using geometry::PlaneFrame;
using geometry::Point3;
using geometry::Vector3;

constexpr double pi = std::numbers::pi;

std::vector<PlaneFrame> heights(double from, double to, int count) {
  std::vector<PlaneFrame> planes;
  for (int k = 0; k < count; ++k)
    planes.push_back(geometry::plane_frame(Point3(0, 0, from + (to - from) * k / (count - 1)), Vector3(0, 0, 1)));
  return planes;
}

TEST(PlaneSections, HaveTheirProperties) {
  const PlaneCutter cutter(geometry::torus(2.0, 0.5, {1, 2, 0}));
  const std::vector<PlaneFrame> planes = heights(-0.6, 0.6, 13);
  const std::vector<MeasuredSection> sections = measure_sections(cutter, planes);
  ASSERT_EQ(sections.size(), 13U);
  for (std::size_t k = 0; k < 13; ++k) {
    const double z = planes[k].origin.z();
    const MeasuredSection& found = sections[k];
    ASSERT_TRUE(found.section) << found.failure;
    if (std::abs(z) > 0.499) {
      EXPECT_EQ(found.area.value, 0.0);
      EXPECT_FALSE(found.centroid);
      EXPECT_EQ(found.touching.size(), std::abs(z) < 0.501 ? 1U : 0U);
      continue;
    }
    const double half = std::sqrt(0.25 - z * z);
    EXPECT_NEAR(found.area.value, 8.0 * pi * half, 1e-12);
    EXPECT_NEAR(found.perimeter.value, 8.0 * pi, 1e-12);
    EXPECT_LE((*found.centroid - Point3(1, 2, z)).norm(), 1e-12);
    const double outer = std::pow(2.0 + half, 4);
    const double inner = std::pow(2.0 - half, 4);
    EXPECT_NEAR(found.second_moments(0, 0), 0.25 * pi * (outer - inner), 1e-10);
    ASSERT_EQ(found.loops.size(), 2U);
    EXPECT_NEAR(found.loops[0]->length + found.loops[1]->length, 8.0 * pi, 1e-10);
  }
}

TEST(PlaneSections, AreTheSameBitsForAnyNumberOfThreads) {
  const PlaneCutter cutter(geometry::clip(
      geometry::cube(1.0), geometry::CylinderTool{{0.5, 0.5, 0}, {0.1, 0.2, 1}, 0.2, geometry::KeptSide::outside}));
  const std::vector<PlaneFrame> planes = heights(0.05, 0.95, 9);
  const std::vector<MeasuredSection> one = measure_sections(cutter, planes, {.threads = 1});
  const std::vector<MeasuredSection> four = measure_sections(cutter, planes, {.threads = 4});
  for (std::size_t k = 0; k < planes.size(); ++k) {
    EXPECT_EQ(one[k].area.value, four[k].area.value);
    EXPECT_EQ(one[k].perimeter.value, four[k].perimeter.value);
    ASSERT_EQ(one[k].loops.size(), four[k].loops.size());
    for (std::size_t i = 0; i < one[k].loops.size(); ++i)
      EXPECT_EQ(one[k].loops[i]->curve.homogeneous(), four[k].loops[i]->curve.homogeneous());
  }
}

/// Cavalieri, against the radial integration method in space.
TEST(PlaneSections, AddUpToTheVolume) {
  const geometry::Boundary<3> solid = geometry::clip(
      geometry::sphere(1.0), geometry::CylinderTool{{0.3, 0.1, 0}, {0, 0, 1}, 0.35, geometry::KeptSide::outside});
  // In between these heights the areas are smooth; at them circles touch, so the areas go like powers 3/2 or 1/2.
  const double centre = std::hypot(0.3, 0.1);
  const double low = std::sqrt(1.0 - std::pow(0.35 + centre, 2));
  const double high = std::sqrt(1.0 - std::pow(0.35 - centre, 2));
  const std::vector<double> cuts{-high, -low, low, high};
  std::vector<PlaneFrame> planes;
  std::vector<double> weights;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const quadrature::Rule& rule = quadrature::gauss_legendre(40);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      // z = middle + half sin(theta) makes them analytic.
      const double theta = pi * (rule.nodes[k] - 0.5);
      const double half = 0.5 * (cuts[i + 1] - cuts[i]);
      const double z = 0.5 * (cuts[i + 1] + cuts[i]) + half * std::sin(theta);
      planes.push_back(geometry::plane_frame(Point3(0, 0, z), Vector3(0, 0, 1)));
      weights.push_back(rule.weights[k] * pi * half * std::cos(theta));
    }
  }
  const std::vector<MeasuredSection> sections = measure_sections(PlaneCutter(solid), planes, {.fit_tolerance = 0.0});
  double volume = 0.0;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    ASSERT_TRUE(sections[k].section) << sections[k].failure;
    EXPECT_TRUE(sections[k].section->chains.empty());
    volume += weights[k] * sections[k].area.value;
  }
  const double expected =
      geometric_properties<3>(geometry::bezier_elements(geometry::orient(solid).boundary)).domain->measure.value;
  // Above and below the hole nothing is left: the axis runs through it.
  EXPECT_NEAR(volume, expected, 1e-11 * expected);
}

}  // namespace
}  // namespace isorim::solver
