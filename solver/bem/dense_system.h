#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "solver/bem/assembly.h"
#include "solver/bem/equation_rows.h"
#include "solver/bem/side_conditions.h"
#include "solver/bem/solve.h"

namespace isorim::solver {

/// All equations with every coefficient stored, those of the side conditions last.
struct DenseSystem {
  RowMatrix matrix;
  /// A column for each of the problems.
  Eigen::MatrixXd right;
};

/// Targets that lie together at a time, in parallel; the numbers do not depend on how many threads there are. Cost:
/// size times the elements' nodes; memory 8 size^2 bytes.
template <int Dim>
DenseSystem assemble_dense(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                           const SolveOptions& options);

struct DenseSolution {
  /// Like DenseSystem::right.
  Eigen::MatrixXd values;
  /// |A x - b| / |b| of each column.
  Eigen::VectorXd residual;
};

/// One LU with partial pivoting and one step of refinement for each right side. Throws NumericalError if an entry is
/// not finite or the reciprocal condition number (1-norm, estimated) is below 1e-15.
DenseSolution solve_dense(const DenseSystem& system, int threads);

}  // namespace isorim::solver
