#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "quadrature/boundary_sums.h"
#include "quadrature/cut_region.h"
#include "quadrature/element_piece.h"
#include "tests/quadrature/random_elements.h"
#include "tests/quadrature/regions.h"

namespace isorim::quadrature {
namespace {

using geometry::ElementTable;
using geometry::Point2;
using geometry::Point3;
using geometry::TrimmedRegion;
using std::numbers::pi;
using L3 = SumLayout<3>;

struct NamedRegion {
  std::string name;
  TrimmedRegion region;
};

std::vector<NamedRegion> regions() {
  std::vector<NamedRegion> all;
  all.push_back({"whole cell", testing::whole_cell()});
  all.push_back({"triangle at a corner", testing::polygon({{1, 1}, {0.2, 1}, {1, 0.4}})});
  all.push_back({"tiny triangle at a corner", testing::polygon({{0, 0}, {1e-6, 0}, {0, 1e-6}})});
  all.push_back({"sliver", testing::polygon({{0, 0}, {1, 1 - 1e-7}, {1, 1}})});
  all.push_back({"horizontal sliver", testing::polygon({{0, 0.5}, {1, 0.5}, {1, 0.5 + 1e-7}, {0, 0.5 + 1e-7}})});
  TrimmedRegion disc;
  testing::add_circle(disc, {0.45, 0.55}, 0.4, 4, 1);
  all.push_back({"disc", disc});
  TrimmedRegion plate = testing::whole_cell();
  testing::add_circle(plate, {0.3, 0.6}, 0.25, 3, -1);
  all.push_back({"plate with hole", plate});
  TrimmedRegion two_holes = testing::whole_cell();
  testing::add_circle(two_holes, {0.3, 0.6}, 0.1, 4, -1);
  testing::add_blob(two_holes, {0.7, 0.3}, 0.2, 0.3, 3, 60, -1);
  all.push_back({"plate with two holes", two_holes});
  TrimmedRegion star;
  testing::add_blob(star, {0.5, 0.5}, 0.35, 0.4, 5, 40, 1);
  all.push_back({"star", star});
  TrimmedRegion crescent;
  testing::add_circle(crescent, {0.5, 0.5}, 0.5, 4, 1);
  testing::add_circle(crescent, {0.4, 0.5}, 0.4, 4, -1);
  all.push_back({"crescent that touches itself", crescent});
  TrimmedRegion islands;
  testing::add_blob(islands, {0.25, 0.25}, 0.2, 0.2, 4, 24, 1);
  testing::add_blob(islands, {0.75, 0.7}, 0.2, 0.3, 2, 24, 1, 1.0);
  all.push_back({"two islands", islands});
  // Where bisection cuts, and where a curve counts as beyond the cell.
  for (const double shift : {0.0, 1e-12, -1e-12, 1e-16}) {
    const std::string by = " shifted by " + std::to_string(shift * 1e12);
    all.push_back({"half" + by, testing::polygon({{0, 0}, {0.5 + shift, 0}, {0.5 + shift, 1}, {0, 1}})});
    const double inset = std::abs(shift);
    all.push_back(
        {"rectangle" + by, testing::polygon({{inset, 0.2}, {1 - inset, 0.2}, {1 - inset, 0.7}, {inset, 0.7}})});
    TrimmedRegion tangent;
    testing::add_circle(tangent, {0.25 + inset, 0.5}, 0.25, 4, 1);
    all.push_back({"circle tangent to the middle" + by, tangent});
    all.push_back({"corner in the middle" + by,
                   testing::polygon({{0.5 + shift, 0.5 - shift}, {1, 0.3}, {0.6, 0.8}, {0.1, 0.9}})});
  }
  return all;
}

/// A random element cut by a region.
ElementTable<3> cut_element(const TrimmedRegion& region, std::array<int, 2> degree, double largest_weight,
                            unsigned seed) {
  ElementTable<3> table = testing::random_elements<3>(1, degree, largest_weight, seed);
  table.regions.push_back(region);
  table.elements[0].region = 0;
  return table;
}

// The moments of a cut element by line integrals against the same by sectors about two poles.
TEST(CutRegion, MomentsAgreeWithSectors) {
  constexpr int count = 10;
  for (const NamedRegion& named : regions()) {
    const CutRegion region(named.region);
    const RegionMoments& moments = region.moments({count, count});
    for (const Point2& pole : {Point2(0.0, 0.0), Point2(0.3, 0.8)}) {
      const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(count * count);
      const auto products = [&](const Point2& x) {
        Eigen::ArrayXd values(count * count);
        for (int i = 0; i < count; ++i) {
          for (int j = 0; j < count; ++j)
            values[i * count + j] = std::sqrt((2.0 * i + 1) * (2.0 * j + 1)) *
                                    std::legendre(static_cast<unsigned>(i), std::clamp(2.0 * x[0] - 1.0, -1.0, 1.0)) *
                                    std::legendre(static_cast<unsigned>(j), std::clamp(2.0 * x[1] - 1.0, -1.0, 1.0));
        }
        return values;
      };
      const Eigen::ArrayXd expected = testing::integrate_by_sectors(named.region, pole, 1, zero, products);
      for (int k = 0; k < count * count; ++k)
        EXPECT_NEAR(moments.values[static_cast<std::size_t>(k)], expected[k], 2e-14) << named.name << " moment " << k;
    }
  }
}

TEST(CutRegion, AreasToRounding) {
  const auto area = [](const TrimmedRegion& region) { return CutRegion(region).moments({1, 1}).area(); };
  TrimmedRegion disc;
  testing::add_circle(disc, {0.45, 0.55}, 0.4, 4, 1);
  EXPECT_NEAR(area(disc), 0.16 * pi, 1e-15);
  testing::add_circle(disc, {0.45, 0.55}, 0.4 - 1e-9, 7, -1);
  EXPECT_NEAR(area(disc), 1e-9 * (0.8 - 1e-9) * pi, 1e-15);
  EXPECT_NEAR(area(testing::polygon({{0, 0}, {1e-6, 0}, {0, 1e-6}})), 5e-13, 1e-27);
}

TEST(CutRegion, InnerPointsLieInside) {
  TrimmedRegion plate = testing::whole_cell();
  testing::add_circle(plate, {0.3, 0.6}, 0.25, 3, -1);
  const std::vector<Point2> points = CutRegion(plate).inner_points(9);
  EXPECT_GT(points.size(), 27U);
  for (const Point2& point : points) EXPECT_GT((point - Point2(0.3, 0.6)).norm(), 0.25) << point.transpose();
  const CutRegion half = CutRegion(plate).halves(0).first;
  for (const Point2& point : half.inner_points(9))
    EXPECT_GT((Point2(0.5 * point[0], point[1]) - Point2(0.3, 0.6)).norm(), 0.25) << point.transpose();
}

// Corners and turning points of the boundary lie on the middle one of the lines.
TEST(CutRegion, InnerPointsOfRegionsWithCornersOnTheLines) {
  const auto on_middle_line = [](const TrimmedRegion& region) {
    std::vector<double> found;
    for (const Point2& point : CutRegion(region).inner_points(5)) {
      if (point[1] == 0.5) found.push_back(point[0]);
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  TrimmedRegion disc;
  testing::add_blob(disc, {0.5, 0.5}, 0.25, 0.0, 1, 4, 1);
  const std::vector<double> in_disc = on_middle_line(disc);
  ASSERT_EQ(in_disc.size(), 3U);
  EXPECT_NEAR(in_disc[0], 0.26, 1e-12);
  EXPECT_NEAR(in_disc[2], 0.74, 1e-12);
  // A notch that reaches down to the line from above, and a roof that touches it from below.
  const std::vector<double> notched = on_middle_line(testing::polygon({{0, 0}, {1, 0}, {1, 1}, {0.5, 0.5}, {0, 1}}));
  EXPECT_EQ(notched.size() % 3, 0U);
  EXPECT_GE(notched.size(), 3U);
  EXPECT_TRUE(on_middle_line(testing::polygon({{0.2, 0.1}, {0.8, 0.1}, {0.5, 0.5}})).empty());
}

// A bisected region keeps its area, and its halves are what sectors say of the parts.
TEST(CutRegion, HalvesAddUp) {
  for (const NamedRegion& named : regions()) {
    std::vector<CutRegion> parts{CutRegion(named.region)};
    const double area = parts[0].moments({1, 1}).area();
    for (int level = 0; level < 8; ++level) {
      std::vector<CutRegion> halves;
      double sum = 0.0;
      for (const CutRegion& part : parts) {
        auto [first, second] = part.halves(level % 2);
        sum += first.moments({1, 1}).area() + second.moments({1, 1}).area();
        if (first.extent() != CutRegion::Extent::nothing) halves.push_back(std::move(first));
        if (second.extent() != CutRegion::Extent::nothing) halves.push_back(std::move(second));
      }
      parts = std::move(halves);
      EXPECT_NEAR(std::ldexp(sum, -level - 1), area, 1e-14) << named.name << " level " << level;
      for (const CutRegion& part : parts) {
        const double kept = part.moments({1, 1}).area();
        EXPECT_TRUE(kept > -1e-11 && kept < 1.0 + 1e-11) << named.name << " " << kept;
        if (part.extent() == CutRegion::Extent::everything) {
          EXPECT_NEAR(kept, 1.0, 1e-12) << named.name;
        }
      }
    }
  }
}

TEST(CutElements, WholeCellAsARegionIsTheWholeElement) {
  ElementTable<3> table = cut_element(testing::whole_cell(), {3, 2}, 2.0, 5);
  const Point3 pole(0.1, 0.2, 0.3);
  const BoundarySums<3> cut = boundary_sums(table, pole, SumScope::all, {});
  table.elements[0].region = -1;
  const BoundarySums<3> whole = boundary_sums(table, pole, SumScope::all, {});
  EXPECT_LT((cut.value - whole.value).abs().maxCoeff(), 1e-13);
}

TEST(CutElements, SumsAgreeWithSectors) {
  for (const NamedRegion& named : regions()) {
    for (const double largest_weight : {1.0, 2.0}) {
      const ElementTable<3> table = cut_element(named.region, {2, 3}, largest_weight, 3);
      const Point3 pole(0.1, 0.2, 0.3);
      const BoundarySums<3> sums = boundary_sums(table, pole, SumScope::all, {});
      const ElementSums<3> expected = testing::sums_by_sectors(table, 0, pole, {0.4, 0.5}, 1);
      const ElementSums<3> error = (sums.value - expected).abs();
      EXPECT_LT(error.maxCoeff(), 1e-12) << named.name << " " << largest_weight;
      EXPECT_TRUE((error <= 2.0 * sums.error + 1e-14).all()) << named.name << " " << largest_weight << "\n"
                                                             << error.transpose() << "\n"
                                                             << sums.error.transpose();
    }
  }
}

TEST(CutElements, SameBitsForAnyNumberOfThreads) {
  ElementTable<3> table = testing::random_elements<3>(300, {2, 2}, 3.0, 29);
  const std::vector<NamedRegion> shapes = regions();
  for (std::size_t e = 0; e < table.elements.size(); e += 2) {
    table.elements[e].region = static_cast<std::int32_t>(table.regions.size());
    table.regions.push_back(shapes[e % shapes.size()].region);
  }
  Options options;
  options.tolerance = 1e-9;
  options.threads = 1;
  const BoundarySums<3> one = boundary_sums(table, Point3(0.2, 0.3, 0.4), SumScope::all, options);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    const BoundarySums<3> many = boundary_sums(table, Point3(0.2, 0.3, 0.4), SumScope::all, options);
    EXPECT_TRUE((one.value == many.value).all()) << threads;
    EXPECT_TRUE((one.error == many.error).all()) << threads;
    EXPECT_EQ(one.evaluations, many.evaluations) << threads;
  }
}

/// A region of random shape: a wavy outline, holes, or a polygon with very different angles.
TrimmedRegion random_region(std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto between = [&](double low, double high) { return low + (high - low) * unit(generator); };
  TrimmedRegion region;
  switch (generator() % 4) {
    case 0:
      testing::add_blob(region, {0.5, 0.5}, between(0.1, 0.35), between(0.0, 0.4),
                        2 + static_cast<int>(generator() % 4), 12, 1, between(0.0, 6.0));
      break;
    case 1:
      region = testing::whole_cell();
      testing::add_circle(region, {0.3, between(0.3, 0.7)}, between(0.02, 0.29), 4, -1);
      testing::add_blob(region, {0.75, between(0.3, 0.7)}, between(0.05, 0.15), 0.3, 3, 9, -1);
      break;
    case 2:
      region = testing::polygon({{between(0, 0.2), between(0, 0.2)},
                                 {between(0.5, 1), between(0, 0.4)},
                                 {between(0.4, 0.6), between(0.41, 0.6)},
                                 {between(0.6, 1), between(0.7, 1)}});
      break;
    default:
      const double thickness = std::pow(10.0, between(-6.0, -1.0));
      region = testing::polygon({{0.0, 0.0}, {1.0, 1.0 - thickness}, {1.0, 1.0}, {0.0, thickness}});
  }
  return region;
}

struct Coverage {
  int checked = 0;
  /// Sums whose true error is more than twice the estimate.
  int missed = 0;
};

void measure_coverage(std::array<int, 2> degree, double largest_weight, Coverage& coverage) {
  const Point3 pole = Point3::Constant(0.4);
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 generator(seed);
    const ElementTable<3> table = cut_element(random_region(generator), degree, largest_weight, 100 + seed);
    const ElementSums<3> exact = testing::sums_by_sectors(table, 0, pole, {0.4, 0.5}, 3);
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      Options options;
      options.tolerance = tolerance;
      const BoundarySums<3> sums = boundary_sums(table, pole, SumScope::all, options);
      const ElementSums<3> error = (sums.value - exact).abs();
      coverage.checked += static_cast<int>(error.size());
      coverage.missed += static_cast<int>((error > 2.0 * sums.error + 1e-13).count());
      EXPECT_LE(error[0], 10.0 * tolerance * exact[0] + 1e-13)
          << "degree " << degree[0] << " weight " << largest_weight << " seed " << seed << " tolerance " << tolerance;
    }
  }
}

TEST(CutElements, EstimateCoversTheTrueErrorOfRandomElements) {
  Coverage coverage;
  for (const double largest_weight : {1.0, 2.0, 10.0}) {
    measure_coverage({2, 2}, largest_weight, coverage);
    measure_coverage({3, 1}, largest_weight, coverage);
    measure_coverage({4, 3}, largest_weight, coverage);
  }
  EXPECT_EQ(coverage.checked, 9072);
  EXPECT_EQ(coverage.missed, 0);
}

}  // namespace
}  // namespace isorim::quadrature
