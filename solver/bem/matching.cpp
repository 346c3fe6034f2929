#include "solver/bem/matching.h"

#include <cstddef>
#include <limits>

namespace isorim::solver {

namespace {

/// Rows and columns are counted from 1; 0 is the column that the row to be matched starts from.
class Matching {
 public:
  explicit Matching(const Eigen::Ref<const Eigen::MatrixXd>& costs)
      : costs_(costs),
        n_(static_cast<std::size_t>(costs.rows())),
        row_potential_(n_ + 1, 0.0),
        column_potential_(n_ + 1, 0.0),
        row_of_(n_ + 1, 0),
        before_(n_ + 1, 0) {}

  std::vector<int> solve() {
    for (std::size_t row = 1; row <= n_; ++row) add(row);
    std::vector<int> column_of(n_);
    for (std::size_t column = 1; column <= n_; ++column) column_of[row_of_[column] - 1] = static_cast<int>(column - 1);
    return column_of;
  }

 private:
  /// Matches one row more along the shortest augmenting path.
  void add(std::size_t row) {
    std::vector<double> distance(n_ + 1, std::numeric_limits<double>::infinity());
    std::vector<char> done(n_ + 1, 0);
    row_of_[0] = row;
    std::size_t column = 0;
    do {
      done[column] = 1;
      column = step(column, distance, done);
    } while (row_of_[column] != 0);
    for (; column != 0; column = before_[column]) row_of_[column] = row_of_[before_[column]];
  }

  /// Extends the tree of shortest paths by one column, which it returns.
  std::size_t step(std::size_t from, std::vector<double>& distance, const std::vector<char>& done) {
    const std::size_t row = row_of_[from];
    std::size_t nearest = 0;
    double delta = std::numeric_limits<double>::infinity();
    for (std::size_t j = 1; j <= n_; ++j) {
      if (done[j]) continue;
      const double reduced = costs_(static_cast<Eigen::Index>(row - 1), static_cast<Eigen::Index>(j - 1)) -
                             row_potential_[row] - column_potential_[j];
      if (reduced < distance[j]) {
        distance[j] = reduced;
        before_[j] = from;
      }
      if (distance[j] < delta) {
        delta = distance[j];
        nearest = j;
      }
    }
    for (std::size_t j = 0; j <= n_; ++j) {
      if (done[j]) {
        row_potential_[row_of_[j]] += delta;
        column_potential_[j] -= delta;
      } else {
        distance[j] -= delta;
      }
    }
    return nearest;
  }

  const Eigen::Ref<const Eigen::MatrixXd> costs_;
  std::size_t n_;
  std::vector<double> row_potential_;
  std::vector<double> column_potential_;
  /// Of each column, 0: free.
  std::vector<std::size_t> row_of_;
  /// The column before on the path.
  std::vector<std::size_t> before_;
};

}  // namespace

std::vector<int> cheapest_matching(const Eigen::Ref<const Eigen::MatrixXd>& costs) {
  return Matching(costs).solve();
}

}  // namespace isorim::solver
