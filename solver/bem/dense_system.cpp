#include "solver/bem/dense_system.h"

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "solver/linear/dense_lu.h"

namespace isorim::solver {

namespace {

/// Below this the solution has no correct digit.
constexpr double least_reciprocal_condition = 1e-15;

template <int Dim>
void scatter(const Assembler<Dim>& assembler, int element, const std::vector<double>& block, int point,
             RowMatrix& matrix) {
  const std::span<const std::int32_t> functions = assembler.space().functions_of(element);
  const int components = assembler.components();
  const double* source = block.data();
  for (int i = 0; i < components; ++i) {
    double* row = matrix.data() + (static_cast<Eigen::Index>(point) * components + i) * matrix.cols();
    for (int c = 0; c < components; ++c) {
      for (const std::int32_t function : functions) row[function * components + c] += *source++;
    }
  }
}

template <int Dim>
void assemble_point(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides, int point,
                    AssemblyRoom<Dim>& room, DenseSystem& system) {
  const quadrature::Target<Dim> target = assembler.target(point);
  const int components = assembler.components();
  const auto elements = static_cast<int>(assembler.space().elements.size());
  assembler.start_target(room);
  for (int e = 0; e < elements; ++e) {
    assembler.add_element(target, e, room);
    scatter(assembler, e, room.block, point, system.matrix);
  }
  assembler.add_target_terms(point, room);
  scatter(assembler, target.element, room.block, point, system.matrix);
  for (int i = 0; i < components; ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(point) * components + i;
    system.right[row] = room.right[i];
    for (Eigen::Index m = 0; m < room.modes.cols(); ++m)
      system.matrix(row, assembler.size() + m) = assembler.flux_scale() * room.modes(i, m);
    for (std::size_t k = 0; k < sides.constants.size(); ++k)
      system.matrix(row, assembler.size() + static_cast<Eigen::Index>(k)) = -sides.constants[k][i];
  }
}

}  // namespace

template <int Dim>
DenseSystem assemble_dense(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                           const SolveOptions& options) {
  const auto extra = static_cast<Eigen::Index>(sides.count());
  const Eigen::Index size = assembler.size() + extra;
  DenseSystem system{RowMatrix::Zero(size, size), Eigen::VectorXd::Zero(size)};
  std::vector<std::unique_ptr<AssemblyRoom<Dim>>> rooms(
      static_cast<std::size_t>(quadrature::thread_count(options.threads)));
  quadrature::parallel_for(
      static_cast<std::size_t>(assembler.space().function_count()), options.threads,
      [&](std::size_t point, int thread) {
        auto& room = rooms[static_cast<std::size_t>(thread)];
        if (!room) room = std::make_unique<AssemblyRoom<Dim>>(assembler.problem());
        assemble_point(assembler, sides, static_cast<int>(point), *room, system);
      },
      options.progress);
  const Eigen::MatrixXd loads = assembler.load_potentials(options.tolerance, options.threads);
  system.right.head(assembler.size()) += loads.reshaped();
  system.matrix.block(assembler.size(), 0, extra, assembler.size()) = sides.rows;
  system.right.tail(extra) = sides.right;
  return system;
}

DenseSolution solve_dense(const DenseSystem& system, int threads) {
  if (!system.matrix.allFinite() || !system.right.allFinite())
    throw NumericalError("the system of equations has entries that are not finite");
  const DenseLu factors(system.matrix, threads);
  const double condition = factors.reciprocal_condition();
  if (!(condition >= least_reciprocal_condition)) {
    throw NumericalError(
        fmt::format("the system of {} equations is singular to working precision (reciprocal condition "
                    "number {:.1e}): do the conditions determine a solution?",
                    system.matrix.rows(), condition));
  }
  DenseSolution solution;
  solution.values = factors.solve(system.right);
  const Eigen::VectorXd left = system.right - system.matrix * solution.values;
  solution.values += factors.solve(left);
  const double norm = system.right.norm();
  if (norm > 0.0) solution.residual = (system.right - system.matrix * solution.values).norm() / norm;
  return solution;
}

template DenseSystem assemble_dense<2>(const Assembler<2>&, const SideConditions<2>&, const SolveOptions&);
template DenseSystem assemble_dense<3>(const Assembler<3>&, const SideConditions<3>&, const SolveOptions&);

}  // namespace isorim::solver
