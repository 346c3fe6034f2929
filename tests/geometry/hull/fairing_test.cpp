#include "geometry/hull/fairing.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/hull/fairness.h"
#include "geometry/hull/hull_surface.h"
#include "tests/geometry/hull/wigley.h"

namespace isorim::geometry {
namespace {

/// What is not zero and not half the beam is off by up to `error`.
OffsetTable rounded_about(const OffsetTable& table, double error) {
  std::mt19937 random(3);
  OffsetTable result = table;
  for (double& y : result.half_breadths.reshaped()) {
    const double off = error * (2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.0);
    if (y > error && y < 0.5 * table.beam - error) y += off;
  }
  return result;
}

TEST(Fairing, LeavesAFairTableAlone) {
  const OffsetTable table = wigley_table(13, 7);
  const FairedOffsets faired = fair_offsets(table, 1e-3);
  EXPECT_LT((faired.table.half_breadths - table.half_breadths).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(faired.roughness_before, 1e-20);
}

// Errors of +-e are taken out for the better part, within +-e.
TEST(Fairing, TakesOutWhatTheAccuracyOfATableLetsIn) {
  const OffsetTable exact = wigley_table(21, 9);
  const double error = 1e-3;
  const OffsetTable rough = rounded_about(exact, error);
  const FairedOffsets faired = fair_offsets(rough, error);
  EXPECT_LE(faired.largest_move, error * (1.0 + 1e-12));
  EXPECT_LE((faired.table.half_breadths - rough.half_breadths).cwiseAbs().maxCoeff(), error * (1.0 + 1e-12));
  // The exact table lies within the bounds, so the least roughness is no larger than its own.
  EXPECT_LT(faired.roughness, 1e-6 * faired.roughness_before);
  EXPECT_LT((faired.table.half_breadths - exact.half_breadths).norm(),
            0.5 * (rough.half_breadths - exact.half_breadths).norm());
  const HullFairness before = measure_fairness(rough, hull_surface(hull_sections(rough)));
  const HullFairness after = measure_fairness(faired.table, hull_surface(hull_sections(faired.table)));
  EXPECT_GT(before.station_sign_changes + before.waterline_sign_changes, 10);
  EXPECT_EQ(after.station_sign_changes + after.waterline_sign_changes, 0);
  EXPECT_LT(after.bending_energy, before.bending_energy);
}

// Tolerances that bind everywhere: no single offset can be moved, by itself, to anything fairer.
TEST(Fairing, FindsTheMinimumUnderItsBounds) {
  const OffsetTable rough = rounded_about(wigley_table(9, 6), 5e-3);
  const double tolerance = 5e-4;
  const FairedOffsets faired = fair_offsets(rough, tolerance);
  EXPECT_LT(faired.roughness, faired.roughness_before);
  for (Eigen::Index k = 0; k < rough.half_breadths.size(); ++k) {
    for (const double move : {-0.1 * tolerance, 0.1 * tolerance}) {
      OffsetTable other = faired.table;
      double& y = other.half_breadths.reshaped()[k];
      y += move;
      const double given = rough.half_breadths.reshaped()[k];
      if (given == 0.0 || given == 0.5 * rough.beam || std::abs(y - given) > tolerance || y < 0.0) continue;
      EXPECT_GE(fair_offsets(other, 1e-15).roughness_before, faired.roughness * (1.0 - 1e-9)) << k;
    }
  }
}

TEST(Fairing, KeepsFlatPartsAndTheCentrePlane) {
  OffsetTable table = rounded_about(wigley_table(15, 7), 2e-3);
  // A parallel middle body, flat of side.
  for (Eigen::Index i = 6; i <= 8; ++i) table.half_breadths.col(i) = table.half_breadths.col(7);
  for (Eigen::Index j = 4; j <= 6; ++j) table.half_breadths.row(j).segment(6, 3).setConstant(0.5 * table.beam);
  const FairedOffsets faired = fair_offsets(table, 2e-3);
  EXPECT_GT(faired.moved, 30);
  EXPECT_EQ(faired.table.half_breadths.middleCols(6, 3), table.half_breadths.middleCols(6, 3));
  for (Eigen::Index k = 0; k < table.half_breadths.size(); ++k) {
    if (table.half_breadths.reshaped()[k] == 0.0) {
      EXPECT_EQ(faired.table.half_breadths.reshaped()[k], 0.0);
    }
    EXPECT_GE(faired.table.half_breadths.reshaped()[k], 0.0);
  }
}

TEST(Fairing, DoesNotLookAcrossKnuckles) {
  OffsetTable table = wigley_table(9, 8);
  // Two slopes in z that meet between the fourth and the fifth waterline.
  KnuckleLine chine{"chine", Points<2>(2, 9)};
  const double middle = 0.5 * (table.waterlines[3] + table.waterlines[4]);
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double along = 0.3 + 0.05 * static_cast<double>(i);
    for (Eigen::Index j = 0; j < 8; ++j) {
      const double z = table.waterlines[static_cast<std::size_t>(j)];
      table.half_breadths(j, i) = 0.3 * along * (0.5 + std::min(z, middle) + 0.1 * std::max(z - middle, 0.0));
    }
    chine.places.col(i) << 0.3 * along * (0.5 + middle), middle;
  }
  const FairedOffsets without = fair_offsets(table, 1e-3);
  table.knuckles.push_back(chine);
  const FairedOffsets with = fair_offsets(table, 1e-3);
  EXPECT_GT(without.roughness_before, 1e-3);
  EXPECT_LT(with.roughness_before, 1e-20);
}

TEST(Fairing, RefusesToleranceThatIsNone) {
  EXPECT_THROW(fair_offsets(wigley_table(9, 5), 0.0), GeometryError);
  EXPECT_THROW(fair_offsets(wigley_table(9, 5), std::nan("")), GeometryError);
}

}  // namespace
}  // namespace isorim::geometry
