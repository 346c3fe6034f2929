#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Core>

#include "solver/bem/assembly.h"
#include "solver/bem/side_conditions.h"
#include "solver/bem/solve.h"
#include "solver/linear/hierarchical_matrix.h"

namespace isorim::solver {

/// The equations with the coefficients of the functions in blocks of low rank, and those of the side conditions apart:
///   [matrix columns; rows 0] [x; extra] = [right; right_of_rows], a column of right for each of the problems.
struct CompressedSystem {
  std::shared_ptr<const HierarchicalMatrix> matrix;
  Eigen::MatrixXd columns;
  Eigen::MatrixXd rows;
  Eigen::MatrixXd right;
  /// What the preconditioner needs to serve functions of this degree.
  double factor_tolerance = 1e-2;
};

/// Blocks whose functions are far from their points are interpolated from few of their rows (interpolate_rows()),
/// within options.tolerance in the Frobenius norm of the whole; others are integrated as those of dense systems are. So
/// are the sums over the whole boundary that the removal of constants and the known data need: nothing costs the square
/// of the unknowns. The numbers do not depend on how many threads there are.
template <int Dim>
CompressedSystem assemble_compressed(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                                     const SolveOptions& options);

struct CompressedSolution {
  /// Like CompressedSystem::right; iterations and residual of each column.
  Eigen::MatrixXd values;
  Eigen::VectorXi iterations;
  Eigen::VectorXd residual;
  /// Bytes of the matrix and of its factors.
  std::size_t memory = 0;
};

/// For each right side GMRES to a tenth of options.tolerance, preconditioned by one hierarchical LU factorisation at a
/// loose tolerance (with the side conditions eliminated from it). Throws NumericalError, naming residual and
/// iterations, if it does not converge.
CompressedSolution solve_compressed(const CompressedSystem& system, const SolveOptions& options);

}  // namespace isorim::solver
