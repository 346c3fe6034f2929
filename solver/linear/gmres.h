#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/linear/linear_operator.h"

namespace isorim::solver {

struct GmresOptions {
  /// Of |b - A x| / |b|.
  double tolerance = 1e-10;
  int max_iterations = 500;
  /// Iterations after which the basis is dropped and built anew from the residual; bounds memory to (restart + 1)
  /// vectors.
  int restart = 150;
};

enum class GmresStatus {
  converged,
  /// The true residual no longer falls from one cycle to the next: the limit of rounding, or a singular matrix.
  stagnated,
  iteration_limit,
};

struct GmresResult {
  Eigen::VectorXd x;
  GmresStatus status = GmresStatus::converged;
  /// Products with the matrix that built a basis.
  int iterations = 0;
  /// |b - A x| / |b|, computed from x itself.
  double residual = 0.0;
  /// The relative residual before the first iteration and after each, as the recurrence tells it.
  std::vector<double> history;
};

/// Solves A x = b by restarted GMRES (Saad & Schultz 1986), preconditioned from the right: A M (M^-1 x) = b, M an
/// operator that stands for the inverse of A (none: the identity), so that residuals are those of the system itself.
/// The basis is made orthogonal by modified Gram-Schmidt, twice where a vector loses much of its length (Daniel et al.
/// 1976). Convergence is decided by the true residual; where the recurrence was too optimistic, iterations go on. Not
/// converging is a result. Throws InputError for sizes that disagree, NumericalError naming where a number that is not
/// finite first appeared. `first` is where the iterations start (none: 0).
GmresResult gmres(const LinearOperator& matrix, const Eigen::Ref<const Eigen::VectorXd>& right_side,
                  const GmresOptions& options = {}, const LinearOperator* preconditioner = nullptr,
                  const Eigen::VectorXd* first = nullptr);

}  // namespace isorim::solver
