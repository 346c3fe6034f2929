#include "geometry/fitting/two_heaps.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace isorim::geometry {
namespace {

std::vector<double> normal_heap(double middle, int count, std::mt19937& random) {
  std::normal_distribution<double> normal(middle, 1.0);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(normal(random));
  return values;
}

TEST(TwoHeaps, AreToldFromOne) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> values = normal_heap(0.0, 60, random);
    EXPECT_FALSE(split_of_heaps(values, 0.82));
    for (const double value : normal_heap(7.0, 30, random)) values.push_back(value);
    const auto split = split_of_heaps(values, 0.82);
    ASSERT_TRUE(split);
    EXPECT_NEAR(*split, 3.5, 1.5);
  }
}

/// The shares of the variance that even, symmetric values have: 3/4, and 1 where there are but two of them.
TEST(TwoHeaps, SharesOfVariance) {
  std::vector<double> even;
  for (int i = 0; i < 1000; ++i) even.push_back(i / 1000.0);
  EXPECT_TRUE(split_of_heaps(even, 0.749));
  EXPECT_FALSE(split_of_heaps(even, 0.751));
  std::vector<double> pair(30, 1.0);
  pair.insert(pair.end(), 30, 2.0);
  EXPECT_EQ(split_of_heaps(pair, 0.999), 1.5);
}

TEST(TwoHeaps, NeedSomeOfEach) {
  EXPECT_FALSE(split_of_heaps({}, 0.8));
  EXPECT_FALSE(split_of_heaps(std::vector<double>(100, 3.0), 0.8));
  std::vector<double> few(20, 0.0);
  few.insert(few.end(), 3, 1.0);
  EXPECT_FALSE(split_of_heaps(few, 0.8));
  std::vector<double> outlier(60, 0.0);
  outlier.push_back(50.0);
  EXPECT_FALSE(split_of_heaps(outlier, 0.8));
}

}  // namespace
}  // namespace isorim::geometry
