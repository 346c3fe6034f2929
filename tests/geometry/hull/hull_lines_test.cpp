#include "geometry/hull/hull_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/hull/fairness.h"
#include "geometry/hull/hull.h"
#include "tests/geometry/hull/wigley.h"

namespace isorim::geometry {
namespace {

/// The point of a line where one coordinate of space has a value: a root on the exact curve, by bisection.
std::optional<Point3> point_at(const HullLine& line, Eigen::Index coordinate, double value) {
  constexpr int samples = 64;
  for (const SectionCurve& curve : line.curves) {
    for (const SectionPiece& piece : curve.pieces) {
      const auto excess = [&](double t) { return evaluate_jet(piece, t).place.point(coordinate) - value; };
      for (int k = 0; k < samples; ++k) {
        double low = 1.0 * k / samples;
        double high = 1.0 * (k + 1) / samples;
        if (excess(low) * excess(high) > 0.0) continue;
        for (int step = 0; step < 60; ++step) {
          const double middle = 0.5 * (low + high);
          (excess(low) * excess(middle) <= 0.0 ? high : low) = middle;
        }
        return evaluate_jet(piece, low).place.point;
      }
    }
  }
  return std::nullopt;
}

LinePlanes planes() {
  return {{-4.1, -2.3, 0.7, 3.9}, {0.11, 0.29, 0.47, 0.6}, {0.09, 0.22, 0.31}, {{0.6, 0.9}, {0.4, 0.5}}};
}

TEST(HullLines, ViewsAgree) {
  OffsetTable table = wigley_table(13, 7);
  // Not the polynomial: a form that only the surface knows.
  for (Eigen::Index i = 0; i < 13; ++i) {
    for (Eigen::Index j = 0; j < 7; ++j)
      table.half_breadths(j, i) *= 1.0 + 0.1 * std::sin(1.3 * static_cast<double>(i)) * std::cos(0.9 * double(j));
  }
  const HullLines lines = hull_lines(hull_surface(hull_sections(table)), planes());
  int compared = 0;
  const auto compare = [&](const std::vector<HullLine>& first, Eigen::Index axis_of_first,
                           const std::vector<HullLine>& second, Eigen::Index axis_of_second) {
    for (const HullLine& a : first) {
      for (const HullLine& b : second) {
        const std::optional<Point3> on_a = point_at(a, axis_of_second, b.at);
        const std::optional<Point3> on_b = point_at(b, axis_of_first, a.at);
        ASSERT_EQ(on_a.has_value(), on_b.has_value());
        if (!on_a) continue;
        EXPECT_LT((*on_a - *on_b).norm(), 1e-10);
        ++compared;
      }
    }
  };
  compare(lines.stations, 0, lines.waterlines, 2);
  compare(lines.stations, 0, lines.buttocks, 1);
  EXPECT_EQ(compared, 24);
  // A diagonal and a station: the point of the diagonal at the station lies on the station's curve, and on the plane.
  for (const HullLine& diagonal : lines.diagonals) {
    for (const HullLine& station : lines.stations) {
      const std::optional<Point3> point = point_at(diagonal, 0, station.at);
      ASSERT_TRUE(point.has_value());
      EXPECT_NEAR((*point - diagonal.frame.origin).dot(diagonal.frame.normal), 0.0, 1e-13);
      const std::optional<Point3> on_station = point_at(station, 2, point->z());
      ASSERT_TRUE(on_station.has_value());
      EXPECT_LT((*point - *on_station).norm(), 1e-10);
    }
  }
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
