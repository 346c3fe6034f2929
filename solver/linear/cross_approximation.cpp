#include "solver/linear/cross_approximation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "solver/linear/column_products.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A matrix that grows by columns.
class Columns {
 public:
  explicit Columns(Index rows) : storage_(rows, 8) {}
  void push_back(const Eigen::Ref<const Eigen::VectorXd>& column) {
    if (count_ == storage_.cols()) storage_.conservativeResize(Eigen::NoChange, 2 * count_);
    storage_.col(count_++) = column;
  }
  Index count() const { return count_; }
  auto columns(Index first = 0) const { return storage_.middleCols(first, count_ - first); }

 private:
  MatrixXd storage_;
  Index count_ = 0;
};

/// Rows of a target or columns of a node, less the first so many crosses.
struct Sample {
  Index index = 0;
  MatrixXd values;
  Index applied = 0;
};

/// One member of each of `count` equal parts of [0, size), at random but always the same, and one of every group that
/// they miss.
template <class Group>
std::vector<Index> spread(Index size, Index count, const Group& group) {
  std::minstd_rand random(static_cast<unsigned>(size) + 1U);
  std::vector<Index> members;
  std::unordered_set<std::int32_t> seen;
  count = std::min(count, size);
  for (Index part = 0; part < count; ++part) {
    const Index first = part * size / count;
    const Index length = (part + 1) * size / count - first;
    members.push_back(first + static_cast<Index>(random()) % length);
    seen.insert(group(members.back()));
  }
  for (Index member = 0; member < size; ++member)
    if (seen.insert(group(member)).second) members.push_back(member);
  return members;
}

class CrossApproximation {
 public:
  CrossApproximation(CrossSource& source, const Accuracy& accuracy)
      : source_(source),
        accuracy_{std::max(accuracy.relative / 3.0, 4.0 * epsilon), accuracy.absolute / 3.0},
        rows_(source.row_components()),
        columns_(source.column_components()),
        u_(source.targets() * rows_),
        v_(source.nodes() * columns_),
        used_target_(static_cast<std::size_t>(source.targets()), 0) {}

  LowRank run() {
    const Index smaller = std::min(source_.targets() * rows_, source_.nodes() * columns_);
    if (!find_crosses(smaller)) return every_entry();
    return {u_.columns(), v_.columns()};
  }

  RowInterpolation run_for_rows() {
    const Index row_count = source_.targets() * rows_;
    if (!find_crosses(row_count)) {
      RowInterpolation all{std::vector<Index>(static_cast<std::size_t>(row_count)),
                           MatrixXd::Identity(row_count, row_count)};
      std::iota(all.rows.begin(), all.rows.end(), Index{0});
      return all;
    }
    MatrixXd transposed = u_.columns().transpose();
    const MatrixXd triangle = transposed(Eigen::all, pivot_rows_);
    // Below a pivot's row the later columns vanish: exactly where the row was taken up, else but for rounding.
    triangle.template triangularView<Eigen::Upper>().solveInPlace(transposed);
    return {pivot_rows_, transposed.transpose()};
  }

 private:
  double norm() const { return std::sqrt(std::max(0.0, squared_norm_)); }

  /// False if all entries had better be taken: the rank comes to half of `most`, or the samples are not satisfied.
  bool find_crosses(Index most) {
    // Half of all rows or columns: the rest costs little more than the crosses did, and is certain.
    if (most <= 12) return false;
    int small_steps = 0;
    for (std::optional<Index> target = source_.targets() / 2; target;) {
      if (2 * u_.count() >= most) return false;
      small_steps = add_crosses(*target) > accuracy_.allowed(norm()) ? 0 : small_steps + 1;
      // One small step may be chance (a target that coincides with a used one): the next goes where samples are worst.
      target = small_steps == 0 ? next_target() : target_of_largest_residual(small_steps > 1);
    }
    return !exhausted_;
  }

  Sample row_sample(Index target) {
    Sample sample{target, MatrixXd(source_.nodes() * columns_, rows_), 0};
    source_.row(target, sample.values);
    look_at(sample, "target");
    return sample;
  }

  Sample column_sample(Index node) {
    Sample sample{node, MatrixXd(source_.targets() * rows_, columns_), 0};
    source_.column(node, sample.values);
    look_at(sample, "node");
    return sample;
  }

  void look_at(const Sample& sample, const char* what) {
    if (!sample.values.allFinite())
      throw NumericalError(fmt::format("the kernel is not finite at {} {} of a block of {} targets and {} nodes", what,
                                       sample.index, source_.targets(), source_.nodes()));
    largest_entry_ = std::max(largest_entry_, sample.values.cwiseAbs().maxCoeff());
  }

  void update_row(Sample& row) {
    add_product_with_transposed(-1.0, v_.columns(row.applied),
                                u_.columns(row.applied).middleRows(row.index * rows_, rows_), row.values);
    row.applied = u_.count();
  }

  void update_column(Sample& column) {
    add_product_with_transposed(-1.0, u_.columns(column.applied),
                                v_.columns(column.applied).middleRows(column.index * columns_, columns_),
                                column.values);
    column.applied = u_.count();
  }

  /// Crosses through the rows of a target until nothing is left of them; the Frobenius norm of what was added, at most.
  /// Where another target has a much larger entry in the pivot's column, the crosses go through that one instead:
  /// dividing by pivots that are small beside their columns would spoil the columns used before.
  double add_crosses(Index target) {
    std::vector<Sample> fetched;
    double squared_step = 0.0;
    Sample row = row_sample(target);
    for (Index cross = 0; cross < rows_;) {
      update_row(row);
      const auto [component, column] = pivot(row.values);
      const double entry = row.values(column, component);
      if (std::abs(entry) <= 4.0 * epsilon * largest_entry_) break;
      Sample& nodes = residual_of(column / columns_, fetched);
      Index largest = 0;
      const double size = nodes.values.col(column % columns_).cwiseAbs().maxCoeff(&largest);
      if (size > 4.0 * std::abs(entry) && largest / rows_ != row.index) {
        row = row_sample(largest / rows_);
        cross = 0;
        continue;
      }
      squared_step += append(nodes.values.col(column % columns_), row.values.col(component) / entry);
      pivot_rows_.push_back(row.index * rows_ + component);
      ++cross;
    }
    used_target_[static_cast<std::size_t>(row.index)] = 1;
    return std::sqrt(squared_step);
  }

  Sample& residual_of(Index node, std::vector<Sample>& fetched) {
    auto found = std::find_if(fetched.begin(), fetched.end(), [&](const Sample& s) { return s.index == node; });
    if (found == fetched.end()) found = fetched.insert(fetched.end(), column_sample(node));
    update_column(*found);
    return *found;
  }

  struct Pivot {
    Index component = 0;
    Index column = 0;
  };

  static Pivot pivot(const MatrixXd& residual) {
    Pivot best;
    residual.cwiseAbs().maxCoeff(&best.column, &best.component);
    return best;
  }

  /// The matrix itself, as rows times the identity or the identity times columns.
  LowRank every_entry() {
    const Index row_count = source_.targets() * rows_;
    const Index column_count = source_.nodes() * columns_;
    if (row_count <= column_count) {
      MatrixXd v(column_count, row_count);
      for (Index i = 0; i < source_.targets(); ++i) v.middleCols(i * rows_, rows_) = row_sample(i).values;
      return {MatrixXd::Identity(row_count, row_count), std::move(v)};
    }
    MatrixXd u(row_count, column_count);
    for (Index j = 0; j < source_.nodes(); ++j) u.middleCols(j * columns_, columns_) = column_sample(j).values;
    return {std::move(u), MatrixXd::Identity(column_count, column_count)};
  }

  /// The squared norm of the cross, which joins the sum.
  double append(const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
    const double square = u.squaredNorm() * v.squaredNorm();
    if (u_.count() > 0) {
      MatrixXd left = MatrixXd::Zero(u_.count(), 1);
      MatrixXd right = left;
      add_transposed_product(1.0, u_.columns(), u, left);
      add_transposed_product(1.0, v_.columns(), v, right);
      squared_norm_ += 2.0 * left.col(0).dot(right.col(0));
    }
    squared_norm_ += square;
    u_.push_back(u);
    v_.push_back(v);
    return square;
  }

  /// The unused target at which a column is largest; none if all were used.
  std::optional<Index> largest_target(const Eigen::Ref<const MatrixXd>& columns) const {
    std::optional<Index> best;
    double largest = -1.0;
    for (Index target = 0; target < source_.targets(); ++target) {
      if (used_target_[static_cast<std::size_t>(target)] != 0) continue;
      const double size = columns.middleRows(target * rows_, rows_).squaredNorm();
      if (size <= largest) continue;
      largest = size;
      best = target;
    }
    return best;
  }

  std::optional<Index> next_target() {
    const std::optional<Index> target = largest_target(u_.columns().rightCols(1));
    return target ? target : target_of_largest_residual(true);
  }

  void take_samples() {
    const auto target_group = [&](Index i) { return source_.target_group(i); };
    const auto node_group = [&](Index i) { return source_.node_group(i); };
    for (const Index target : spread(source_.targets(), 4, target_group)) row_samples_.push_back(row_sample(target));
    for (const Index node : spread(source_.nodes(), 12, node_group)) column_samples_.push_back(column_sample(node));
  }

  /// A sample that became a pivot says nothing any more; its next unused neighbour takes its place.
  void replace_used_rows() {
    for (Sample& sample : row_samples_) {
      if (used_target_[static_cast<std::size_t>(sample.index)] == 0) continue;
      const auto next = std::find(used_target_.begin() + sample.index, used_target_.end(), 0);
      if (next != used_target_.end()) sample = row_sample(next - used_target_.begin());
    }
  }

  /// Where the crosses should go on, judged by the samples; none if nothing is left to be used, or their residuals are
  /// within the accuracy and that `may_end`.
  std::optional<Index> target_of_largest_residual(bool may_end) {
    if (row_samples_.empty()) take_samples();
    replace_used_rows();
    Sample* worst_row = nullptr;
    Sample* worst_column = nullptr;
    const double by_rows =
        squared_residual(row_samples_, source_.targets(), worst_row, &CrossApproximation::update_row);
    const double by_columns =
        squared_residual(column_samples_, source_.nodes(), worst_column, &CrossApproximation::update_column);
    const double allowed = std::max(accuracy_.allowed(norm()), 4.0 * epsilon * largest_entry_);
    const bool within = std::max(by_rows, by_columns) <= allowed * allowed;
    if (within && may_end) return std::nullopt;
    if (by_rows >= by_columns && used_target_[static_cast<std::size_t>(worst_row->index)] == 0) return worst_row->index;
    const std::optional<Index> target = largest_target(worst_column->values);
    exhausted_ = !target && !within;
    return target;
  }

  /// The square of the residual's norm as the samples suggest it.
  double squared_residual(std::vector<Sample>& samples, Index population, Sample*& worst,
                          void (CrossApproximation::*update)(Sample&)) {
    double sum = 0.0;
    double largest = -1.0;
    for (Sample& sample : samples) {
      (this->*update)(sample);
      const double square = sample.values.squaredNorm();
      sum += square;
      if (square <= largest) continue;
      largest = square;
      worst = &sample;
    }
    return sum * static_cast<double>(population) / static_cast<double>(samples.size());
  }

  CrossSource& source_;
  Accuracy accuracy_;
  Index rows_;
  Index columns_;
  Columns u_;
  Columns v_;
  /// The scalar row of each cross.
  std::vector<Index> pivot_rows_;
  std::vector<char> used_target_;
  std::vector<Sample> row_samples_;
  std::vector<Sample> column_samples_;
  double squared_norm_ = 0.0;
  double largest_entry_ = 0.0;
  /// Every target was used, and yet the samples are not satisfied.
  bool exhausted_ = false;
};

}  // namespace

LowRank cross_approximation(CrossSource& source, const Accuracy& accuracy) {
  if (source.targets() == 0 || source.nodes() == 0)
    return {MatrixXd(source.targets() * source.row_components(), 0),
            MatrixXd(source.nodes() * source.column_components(), 0)};
  return CrossApproximation(source, accuracy).run();
}

RowInterpolation interpolate_rows(CrossSource& source, const Accuracy& accuracy) {
  if (source.targets() == 0 || source.nodes() == 0)
    return {{}, MatrixXd(source.targets() * source.row_components(), 0)};
  return CrossApproximation(source, accuracy).run_for_rows();
}

}  // namespace isorim::solver
