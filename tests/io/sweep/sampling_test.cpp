#include "io/sweep/sampling.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isorim::io {
namespace {

/// The first numbers of SplitMix64 from the seed 1234567, as its authors' implementation gives them.
TEST(Random, IsSplitMix64) {
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317U);
  EXPECT_EQ(random.next(), 3203168211198807973U);
  EXPECT_EQ(random.next(), 9817491932198370423U);
  EXPECT_EQ(random.next(), 4593380528125082431U);
  EXPECT_EQ(random.next(), 16408922859458223821U);
}

TEST(Random, DrawsEachNumberBelowABoundAlikeOften) {
  Random random(7);
  std::vector<int> counts(6);
  for (int i = 0; i < 60000; ++i) ++counts[random.below(6)];
  // 10 standard deviations.
  for (const int count : counts) EXPECT_NEAR(count, 10000, 920);
}

TEST(LatinHypercube, HasOneSampleInEachStratumOfEachDimension) {
  for (const std::size_t samples : {1U, 2U, 7U, 100U, 1023U}) {
    for (const std::vector<double>& column : latin_hypercube(samples, 3, 5)) {
      std::set<int> strata;
      for (const double x : column) {
        EXPECT_GE(x, 0.0);
        EXPECT_LT(x, 1.0);
        strata.insert(static_cast<int>(std::floor(x * static_cast<double>(samples) * (1 + 1e-14))));
      }
      EXPECT_EQ(strata.size(), samples);
    }
  }
}

/// By an implementation of the same in Python's integers.
TEST(LatinHypercube, IsTheSameOnEveryMachine) {
  const auto points = latin_hypercube(4, 2, 1);
  EXPECT_THAT(points, ::testing::ElementsAre(
                          ::testing::ElementsAreArray(std::vector<double>{0.611089804263943, 0.11106617520658951,
                                                                          0.9407235979779403, 0.4693371716910433}),
                          ::testing::ElementsAreArray(std::vector<double>{0.8510355422625564, 0.6513550922438323,
                                                                          0.1137344768675724, 0.38251974937539723})));
}

TEST(LatinHypercube, KeepsTheFirstDimensionsWhenMoreAreAdded) {
  const auto two = latin_hypercube(10, 2, 3);
  const auto three = latin_hypercube(10, 3, 3);
  EXPECT_EQ(two[0], three[0]);
  EXPECT_EQ(two[1], three[1]);
  EXPECT_NE(three[1], three[2]);
  EXPECT_NE(two, latin_hypercube(10, 2, 4));
}

TEST(RangeValue, KeepsTheEndsAndRoundsBetweenThem) {
  EXPECT_EQ(range_value(0.1, 0.7, Spacing::linear, 0.0), 0.1);
  EXPECT_EQ(range_value(0.1, 0.7, Spacing::linear, 1.0), 0.7);
  EXPECT_EQ(range_value(0.0, 1.0, Spacing::linear, 0.3), 0.3);
  EXPECT_EQ(range_value(1e-3, 1e3, Spacing::logarithmic, 0.5), 1.0);
  EXPECT_EQ(range_value(1.0, 1e4, Spacing::logarithmic, 0.25), 10.0);
  EXPECT_EQ(range_value(100.0, 1.0, Spacing::logarithmic, 0.5), 10.0);
}

TEST(RangeValue, AgreesWithPow) {
  for (const double fraction : {0.1, 1.0 / 3.0, 0.77, 0.999999}) {
    for (const auto& [from, to] : {std::pair{0.2, 3.7}, {1e-300, 1e300}, {5.0, 1e-8}}) {
      const double expected = std::exp(std::lerp(std::log(from), std::log(to), fraction));
      EXPECT_NEAR(range_value(from, to, Spacing::logarithmic, fraction) / expected, 1.0, 1e-11);
    }
  }
}

TEST(RangeValue, LiesBetweenTheEnds) {
  const double from = 1.00000000000049;
  const double to = 1.00000000000051;
  for (const double fraction : {1e-9, 0.5, 1.0 - 1e-9}) {
    EXPECT_GE(range_value(from, to, Spacing::linear, fraction), from);
    EXPECT_LE(range_value(from, to, Spacing::linear, fraction), to);
  }
}

}  // namespace
}  // namespace isorim::io
