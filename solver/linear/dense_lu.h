#pragma once

#include <vector>

#include <Eigen/Core>

namespace isorim::solver {

/// The LU factors of a square matrix, with partial pivoting. Blocked: almost all work is in products of packed panels,
/// on all threads and with the widest instructions at hand; the same bits for any number of threads.
class DenseLu {
 public:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// 2/3 n^3 operations; takes 8 n^2 bytes. threads: 0 is all that OpenMP offers.
  DenseLu(const Eigen::Ref<const RowMatrix>& matrix, int threads);

  Eigen::Index size() const { return size_; }
  /// False if a pivot is zero or not finite: solve() must not be called then.
  bool is_regular() const { return regular_; }
  Eigen::VectorXd solve(const Eigen::Ref<const Eigen::VectorXd>& right) const;
  Eigen::VectorXd solve_transposed(const Eigen::Ref<const Eigen::VectorXd>& right) const;
  /// An estimate of 1 / (|A|_1 |A^-1|_1), seldom more than three times too large (Higham, Accuracy and Stability of
  /// Numerical Algorithms, 2nd ed., algorithm 15.1); 0 for a singular matrix.
  double reciprocal_condition() const;

 private:
  void factorise_panel(Eigen::Index first, Eigen::Index width);
  void factorise_columns(Eigen::Index first, Eigen::Index width);
  void swap_rows(Eigen::Index a, Eigen::Index b);
  void solve_upper_rows(Eigen::Index first, Eigen::Index width, Eigen::Index begin, Eigen::Index end);
  void update(Eigen::Index first, Eigen::Index width, Eigen::Index begin, Eigen::Index end, int threads);

  Eigen::Index size_;
  /// Filled up with the identity to a multiple of four rows and columns.
  RowMatrix factors_;
  /// Row i was exchanged with row pivots_[i].
  std::vector<Eigen::Index> pivots_;
  double norm_;
  bool regular_ = true;
};

}  // namespace isorim::solver
