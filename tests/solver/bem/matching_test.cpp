#include "solver/bem/matching.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace isorim::solver {
namespace {

double cost(const Eigen::MatrixXd& costs, const std::vector<int>& columns) {
  double sum = 0.0;
  for (std::size_t i = 0; i < columns.size(); ++i) sum += costs(static_cast<Eigen::Index>(i), columns[i]);
  return sum;
}

TEST(CheapestMatching, IsTheBestOfAllPermutations) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int n = 1; n <= 6; ++n)
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::MatrixXd costs = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return uniform(generator); });
      std::vector<int> columns(static_cast<std::size_t>(n));
      std::iota(columns.begin(), columns.end(), 0);
      double best = cost(costs, columns);
      while (std::ranges::next_permutation(columns).found) best = std::min(best, cost(costs, columns));
      std::vector<int> found = cheapest_matching(costs);
      EXPECT_NEAR(cost(costs, found), best, 1e-14);
      std::ranges::sort(found);
      for (int i = 0; i < n; ++i) EXPECT_EQ(found[static_cast<std::size_t>(i)], i);
    }
}

}  // namespace
}  // namespace isorim::solver
