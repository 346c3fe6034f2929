#include "geometry/hull/hull_lines.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/hull/fairness.h"
#include "geometry/hull/hull.h"
#include "geometry/shapes/transforms.h"
#include "tests/geometry/hull/bulb_hull.h"
#include "tests/geometry/hull/wigley.h"

namespace isorim::geometry {
namespace {

/// Where the exact curves of a line cross a plane, by bisection, in order along `direction`.
std::vector<Point3> crossings(const HullLine& line, const PlaneFrame& plane, const Vector3& direction) {
  constexpr int samples = 64;
  std::vector<Point3> points;
  for (const SectionCurve& curve : line.curves) {
    for (const SectionPiece& piece : curve.pieces) {
      const auto is_beyond = [&](double t) {
        return (evaluate_jet(piece, t).place.point - plane.origin).dot(plane.normal) >= 0.0;
      };
      for (int k = 0; k < samples; ++k) {
        double low = 1.0 * k / samples;
        double high = 1.0 * (k + 1) / samples;
        const bool begins_beyond = is_beyond(low);
        if (begins_beyond == is_beyond(high)) continue;
        for (int step = 0; step < 60; ++step) {
          const double middle = 0.5 * (low + high);
          (is_beyond(middle) == begins_beyond ? low : high) = middle;
        }
        points.push_back(evaluate_jet(piece, low).place.point);
      }
    }
  }
  std::sort(points.begin(), points.end(),
            [&](const Point3& a, const Point3& b) { return a.dot(direction) < b.dot(direction); });
  return points;
}

/// What two families of lines say of the points that they have in common.
struct Agreement {
  int points = 0;
  /// Pairs of lines that do not cross equally often in both views.
  int unlike_pairs = 0;
  double largest_distance = 0.0;
};

Agreement compare(const std::vector<HullLine>& first, const std::vector<HullLine>& second) {
  Agreement agreement;
  for (const HullLine& a : first) {
    for (const HullLine& b : second) {
      const Vector3 common = a.frame.normal.cross(b.frame.normal);
      const std::vector<Point3> on_a = crossings(a, b.frame, common);
      const std::vector<Point3> on_b = crossings(b, a.frame, common);
      if (on_a.size() != on_b.size()) {
        ++agreement.unlike_pairs;
        continue;
      }
      for (std::size_t k = 0; k < on_a.size(); ++k)
        agreement.largest_distance = std::max(agreement.largest_distance, (on_a[k] - on_b[k]).norm());
      agreement.points += static_cast<int>(on_a.size());
    }
  }
  return agreement;
}

LinePlanes planes() {
  return {{-4.1, -2.3, 0.7, 3.9}, {0.11, 0.29, 0.47, 0.6}, {0.09, 0.22, 0.31}, {{0.61, 0.9}, {0.4, 0.5}}};
}

/// Not Wigley's polynomial: a form that only its surface knows.
std::vector<NurbsSurface<3>> wavy_hull() {
  OffsetTable table = wigley_table(13, 7);
  for (Eigen::Index i = 0; i < 13; ++i) {
    for (Eigen::Index j = 0; j < 7; ++j)
      table.half_breadths(j, i) *= 1.0 + 0.1 * std::sin(1.3 * static_cast<double>(i)) * std::cos(0.9 * double(j));
  }
  return hull_surface(hull_sections(table));
}

struct ViewPair {
  const char* views;
  std::vector<HullLine> HullLines::*first;
  std::vector<HullLine> HullLines::*second;
  /// Points that the lines of wavy_hull() have in common.
  int points;
};

const std::vector<ViewPair> view_pairs{
    {"stations and waterlines", &HullLines::stations, &HullLines::waterlines, 16},
    {"stations and buttocks", &HullLines::stations, &HullLines::buttocks, 8},
    {"waterlines and buttocks", &HullLines::waterlines, &HullLines::buttocks, 20},
    {"diagonals and stations", &HullLines::diagonals, &HullLines::stations, 8},
    {"diagonals and waterlines", &HullLines::diagonals, &HullLines::waterlines, 8},
    {"diagonals and buttocks", &HullLines::diagonals, &HullLines::buttocks, 8},
};

TEST(HullLines, WaterlinesMeetButtocksForeAndAft) {
  // u is x, and v the height over the depth.
  const NurbsSurface<3> hull = wavy_hull().front();
  int expected = 0;
  for (const double z : planes().waterlines) {
    for (const double y : planes().buttocks) {
      bool was_outside = false;
      for (double x = -4.9995; x < 5.0; x += 0.001) {
        const bool is_outside = evaluate(hull, Point2(x, z / 0.625)).y() > y;
        if (is_outside != was_outside) ++expected;
        was_outside = is_outside;
      }
    }
  }
  EXPECT_EQ(expected, 20);
  const HullLines lines = hull_lines(std::vector{hull}, planes());
  EXPECT_EQ(compare(lines.waterlines, lines.buttocks).points, expected);
}

TEST(HullLines, ViewsAgree) {
  const HullLines lines = hull_lines(wavy_hull(), planes());
  for (const ViewPair& pair : view_pairs) {
    SCOPED_TRACE(pair.views);
    const Agreement agreement = compare(lines.*pair.first, lines.*pair.second);
    EXPECT_EQ(agreement.unlike_pairs, 0);
    EXPECT_EQ(agreement.points, pair.points);
    EXPECT_LT(agreement.largest_distance, 1e-10);
  }
}

// A view that is drawn 1e-8 aside is found out, in every pair of views.
TEST(HullLines, ViewsThatDisagreeAreFound) {
  const std::vector<NurbsSurface<3>> hull = wavy_hull();
  const HullLines lines = hull_lines(hull, planes());
  for (const Vector3& direction : {Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0), Vector3(0.0, 0.0, 1.0)}) {
    const HullLines moved =
        hull_lines(std::vector{transform(hull.front(), translation<3>(1e-8 * direction))}, planes());
    for (const ViewPair& pair : view_pairs) {
      SCOPED_TRACE(pair.views);
      EXPECT_GT(compare(lines.*pair.first, moved.*pair.second).largest_distance, 1e-10);
      EXPECT_GT(compare(moved.*pair.first, lines.*pair.second).largest_distance, 1e-10);
    }
  }
}

TEST(HullLines, ViewsOfABulbousBowAgree) {
  const LinePlanes cuts{{45.0, 93.3, 96.7, 100.2, 103.7}, {2.1, 3.3, 4.4, 4.9, 7.3}, {0.6, 1.3, 4.0}, {{6.0, 0.8}}};
  const HullLines lines = hull_lines(hull_surface(hull_sections(bulb_table(1))), cuts);
  for (const ViewPair& pair : view_pairs) {
    SCOPED_TRACE(pair.views);
    const Agreement agreement = compare(lines.*pair.first, lines.*pair.second);
    EXPECT_EQ(agreement.unlike_pairs, 0);
    EXPECT_GT(agreement.points, 2);
    EXPECT_LT(agreement.largest_distance, 1e-10);
  }
  // Below the notch a waterline goes on to the bulb's end, above it ends at the stem; each is one curve.
  const auto foremost = [](const HullLine& line) {
    double x = 0.0;
    for (const SectionSpline& spline : line.splines) x = std::max(x, spline.curve.control_points().row(0).maxCoeff());
    return x;
  };
  EXPECT_NEAR(foremost(lines.waterlines[1]), 82.0 + 24.0 * std::sqrt(1.0 - std::pow(0.3 / 2.2, 2)), 0.01);
  EXPECT_NEAR(foremost(lines.waterlines[2]), 82.0 + 24.0 * std::sqrt(1.0 - std::pow(1.4 / 2.2, 2)), 0.05);
  EXPECT_NEAR(foremost(lines.waterlines[3]), BulbHull::stem(4.9), 1e-6);
  for (const HullLine& line : lines.waterlines) EXPECT_EQ(line.curves.size(), 1u) << line.at;
  for (const HullLine& line : lines.stations) EXPECT_EQ(line.curves.size(), 1u) << line.at;
}

TEST(HullLines, OfWigleysHullFollowTheFormula) {
  const std::vector<NurbsSurface<3>> bands{wigley_surface(10.0, 1.0, 0.625)};
  const HullLines lines = hull_lines(bands, planes());
  int points = 0;
  for (const std::vector<HullLine>* family : {&lines.stations, &lines.waterlines, &lines.buttocks, &lines.diagonals}) {
    for (const HullLine& line : *family) {
      ASSERT_FALSE(line.splines.empty());
      for (const SectionSpline& spline : line.splines) {
        const Interval domain = spline.curve.knots().domain();
        for (int k = 0; k <= 20; ++k) {
          const Point3 x = line.frame.to_space(evaluate(spline.curve, domain.first + domain.length() * k / 20));
          const double z = x.z() / 0.625 - 1.0;
          EXPECT_NEAR(x.y(), 0.5 * (1.0 - 0.04 * x.x() * x.x()) * (1.0 - z * z), 3e-7);
          ++points;
        }
      }
    }
  }
  EXPECT_GE(points, 21 * 12);
}

TEST(HullFairness, CountsInflections) {
  // Wigley's hull: waterlines and stations are arcs of parabolas.
  const OffsetTable table = wigley_table(11, 6);
  const std::vector<NurbsSurface<3>> fair = hull_surface(hull_sections(table));
  const HullFairness good = measure_fairness(table, fair);
  EXPECT_EQ(good.station_sign_changes, 0);
  EXPECT_EQ(good.waterline_sign_changes, 0);
  EXPECT_LT(largest_offset_distance(hull_sections(table), fair), 1e-14);
  OffsetTable dented = table;
  dented.half_breadths(3, 5) -= 0.03;
  const HullFairness bad = measure_fairness(dented, hull_surface(hull_sections(dented)));
  EXPECT_GE(bad.station_sign_changes, 2);
  EXPECT_GE(bad.waterline_sign_changes, 2);
  EXPECT_GT(bad.bending_energy, 1.02 * good.bending_energy);
}

TEST(HullFairness, BendingEnergyOfACylinder) {
  // A quarter of a circle in each section (as well as a cubic has it): k = 1 / r, over pi / 2 r times the length.
  OffsetTable table;
  table.name = "cylinder";
  table.length = 4.0;
  table.beam = 2.0;
  table.draught = 1.0;
  table.stations = {0.0, 1.0, 2.0, 3.0, 4.0};
  table.station_names = {"0", "1", "2", "3", "4"};
  constexpr int count = 24;
  table.half_breadths.resize(count, 5);
  for (int j = 0; j < count; ++j) {
    const double angle = std::acos(-1.0) / 2.0 * j / (count - 1);
    table.waterlines.push_back(1.0 - std::cos(angle));
    table.half_breadths.row(j).setConstant(std::sin(angle));
  }
  const std::vector<HullSection> sections = hull_sections(table);
  const HullFairness fairness = measure_fairness(table, hull_surface(sections));
  EXPECT_NEAR(fairness.bending_energy, std::acos(-1.0) / 2.0 * 4.0, 2e-3);
}

}  // namespace
}  // namespace isorim::geometry
