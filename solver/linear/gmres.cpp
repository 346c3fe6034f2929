#include "solver/linear/gmres.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check(const LinearOperator& matrix, const Eigen::Ref<const VectorXd>& right_side,
           const LinearOperator* preconditioner, const VectorXd* first) {
  const Index n = matrix.rows();
  if (matrix.cols() != n || right_side.size() != n || (first != nullptr && first->size() != n))
    throw InputError(fmt::format("a system of {} x {} cannot be solved for {} right-hand entries from {} first ones", n,
                                 matrix.cols(), right_side.size(), first != nullptr ? first->size() : n));
  if (preconditioner != nullptr && (preconditioner->rows() != n || preconditioner->cols() != n))
    throw InputError(fmt::format("the preconditioner is {} x {}, the matrix {} x {}", preconditioner->rows(),
                                 preconditioner->cols(), n, n));
  for (Index i = 0; i < n; ++i)
    if (!std::isfinite(right_side[i]))
      throw NumericalError(fmt::format("entry {} of the right-hand side is {}", i, right_side[i]));
}

/// One cycle: the basis, and the least-squares problem kept triangular by Givens rotations.
class Cycle {
 public:
  Cycle(const LinearOperator& matrix, const LinearOperator* preconditioner, Index size, Index length)
      : matrix_(matrix),
        preconditioner_(preconditioner),
        basis_(size, length + 1),
        triangle_(MatrixXd::Zero(length + 1, length)),
        right_side_(length + 1),
        cosines_(length),
        sines_(length) {}

  void start(const VectorXd& residual, double norm) {
    count_ = 0;
    estimates_.clear();
    basis_.col(0) = residual / norm;
    right_side_.setZero();
    right_side_[0] = norm;
  }

  /// Adds a vector; the norm of the residual after it.
  double step(int iteration) {
    const Index k = count_++;
    VectorXd next = matrix_.product(preconditioned(basis_.col(k)));
    const double length = next.norm();
    if (!std::isfinite(length))
      throw NumericalError(fmt::format("the product with the matrix is not finite in iteration {}", iteration));
    exhausted_ = !orthogonalise(next, k);
    const double rest = next.norm();
    triangle_(k + 1, k) = exhausted_ ? 0.0 : rest;
    if (!exhausted_) basis_.col(k + 1) = next / rest;
    rotate(k);
    estimates_.push_back(std::abs(right_side_[k + 1]));
    return estimates_.back();
  }

  /// The space can grow no further.
  bool exhausted() const { return exhausted_; }
  Index count() const { return count_; }

  /// What the cycle adds to x: the solution of as many steps as give the least residual, rounding of the product with x
  /// included. The last steps in a (nearly) singular system only make x large.
  VectorXd correction() const {
    const double rounding = std::numeric_limits<double>::epsilon() * triangle_.leftCols(count_).norm();
    VectorXd best;
    double least = std::numeric_limits<double>::infinity();
    for (Index used = count_; used > 0; --used) {
      const VectorXd weights =
          triangle_.topLeftCorner(used, used).template triangularView<Eigen::Upper>().solve(right_side_.head(used));
      const double residual = std::hypot(estimates_[static_cast<std::size_t>(used) - 1], rounding * weights.norm());
      if (!(residual < least)) continue;
      least = residual;
      best = weights;
    }
    return preconditioned(basis_.leftCols(best.size()) * best);
  }

 private:
  VectorXd preconditioned(const Eigen::Ref<const VectorXd>& vector) const {
    return preconditioner_ != nullptr ? preconditioner_->product(vector) : VectorXd(vector);
  }

  /// Whether anything is left: a vector that loses most of its length twice was rounding after the first time.
  bool orthogonalise(VectorXd& vector, Index k) {
    triangle_.col(k).setZero();
    for (int pass = 0; pass < 2; ++pass) {
      const double before = vector.norm();
      for (Index j = 0; j <= k; ++j) {
        const double part = basis_.col(j).dot(vector);
        triangle_(j, k) += part;
        vector -= part * basis_.col(j);
      }
      if (vector.norm() > 0.7 * before) return true;
    }
    return false;
  }

  void rotate(Index k) {
    for (Index j = 0; j < k; ++j) {
      const double upper = triangle_(j, k);
      const double lower = triangle_(j + 1, k);
      triangle_(j, k) = cosines_[j] * upper + sines_[j] * lower;
      triangle_(j + 1, k) = cosines_[j] * lower - sines_[j] * upper;
    }
    const double radius = std::hypot(triangle_(k, k), triangle_(k + 1, k));
    cosines_[k] = radius > 0.0 ? triangle_(k, k) / radius : 1.0;
    sines_[k] = radius > 0.0 ? triangle_(k + 1, k) / radius : 0.0;
    triangle_(k, k) = radius;
    triangle_(k + 1, k) = 0.0;
    right_side_[k + 1] = -sines_[k] * right_side_[k];
    right_side_[k] *= cosines_[k];
  }

  const LinearOperator& matrix_;
  const LinearOperator* preconditioner_;
  MatrixXd basis_;
  MatrixXd triangle_;
  VectorXd right_side_;
  VectorXd cosines_;
  VectorXd sines_;
  /// Norm of the residual after each step.
  std::vector<double> estimates_;
  Index count_ = 0;
  bool exhausted_ = false;
};

}  // namespace

GmresResult gmres(const LinearOperator& matrix, const Eigen::Ref<const VectorXd>& right_side,
                  const GmresOptions& options, const LinearOperator* preconditioner, const VectorXd* first) {
  check(matrix, right_side, preconditioner, first);
  const Index size = right_side.size();
  GmresResult result;
  result.x = first != nullptr ? *first : VectorXd::Zero(size);
  const double scale = right_side.norm();
  if (scale == 0.0) {
    result.x.setZero();
    result.history.push_back(0.0);
    return result;
  }
  const Index length = std::clamp<Index>(std::min<Index>(options.restart, options.max_iterations), 1, size);
  Cycle cycle(matrix, preconditioner, size, length);
  VectorXd residual = first != nullptr ? VectorXd(right_side - matrix.product(result.x)) : VectorXd(right_side);
  double norm = residual.norm();
  result.history.push_back(norm / scale);
  while (true) {
    if (!std::isfinite(norm))
      throw NumericalError(fmt::format("the residual is not finite after iteration {}", result.iterations));
    result.residual = norm / scale;
    if (result.residual <= options.tolerance) return result;
    if (result.iterations >= options.max_iterations) {
      result.status = GmresStatus::iteration_limit;
      return result;
    }
    cycle.start(residual, norm);
    double estimate = norm;
    do {
      estimate = cycle.step(++result.iterations);
      result.history.push_back(estimate / scale);
    } while (estimate > options.tolerance * scale && !cycle.exhausted() && cycle.count() < length &&
             result.iterations < options.max_iterations);
    const VectorXd improved = result.x + cycle.correction();
    residual = right_side - matrix.product(improved);
    const double improved_norm = residual.norm();
    if (improved_norm >= 0.99 * norm) {
      result.status = GmresStatus::stagnated;
      return result;
    }
    result.x = improved;
    norm = improved_norm;
  }
}

}  // namespace isorim::solver
