#include "solver/bem/dense_system.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "solver/linear/cluster_tree.h"
#include "solver/linear/dense_lu.h"

namespace isorim::solver {

namespace {

/// Below this the solution has no correct digit.
constexpr double least_reciprocal_condition = 1e-15;

/// Targets whose rows are integrated together.
constexpr int targets_at_a_time = 32;

template <int Dim>
std::shared_ptr<const ClusterTree> target_clusters(const FieldSpace<Dim>& space) {
  IndexPlaces places;
  places.points = Eigen::Matrix3Xd::Zero(3, space.function_count());
  for (Eigen::Index i = 0; i < space.function_count(); ++i)
    places.points.col(i).template head<Dim>() = space.points[static_cast<std::size_t>(i)].position;
  places.lower = places.upper = places.points;
  return std::make_shared<const ClusterTree>(places, targets_at_a_time);
}

template <int Dim>
struct ThreadRoom {
  ThreadRoom(const Assembler<Dim>& assembler, std::span<const std::int32_t> functions) : integrator(assembler) {
    integrator.set_functions(functions);
  }
  RowIntegrator<Dim> integrator;
  EquationRows rows;
};

/// The rows of some points, whose integrals stand in `rows`.
template <int Dim>
void set_rows(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides, std::span<const std::int32_t> points,
              ThreadRoom<Dim>& room, DenseSystem& system) {
  const Eigen::Index components = assembler.components();
  const auto mode_count = static_cast<Eigen::Index>(assembler.flux_modes().size());
  for (std::size_t t = 0; t < points.size(); ++t) {
    const std::int32_t point = points[t];
    const auto sums = room.rows.sums.middleRows(static_cast<Eigen::Index>(t) * components, components);
    auto rows = system.matrix.middleRows(point * components, components);
    rows.leftCols(assembler.size()) =
        room.rows.coefficients.middleRows(static_cast<Eigen::Index>(t) * components, components);
    Eigen::Matrix<double, Dim, Dim> double_layer = Eigen::Matrix<double, Dim, Dim>::Zero();
    double_layer.topLeftCorner(components, components) = sums.leftCols(components);
    const auto terms = assembler.target_terms(point, double_layer, room.integrator.room());
    const auto functions = assembler.space().functions_of(assembler.target(point).element);
    for (std::size_t a = 0; a < functions.size(); ++a)
      rows.middleCols(functions[a] * components, components) +=
          terms.coefficients.middleCols(static_cast<Eigen::Index>(a) * components, components);
    system.right.middleRows(point * components, components) =
        sums.middleCols(components, assembler.right_sides()) + terms.right.topRows(components);
    rows.middleCols(assembler.size(), mode_count) = assembler.flux_scale() * sums.rightCols(mode_count);
    for (std::size_t k = 0; k < sides.constants.size(); ++k)
      rows.col(assembler.size() + static_cast<Eigen::Index>(k)) = -sides.constants[k].head(components);
  }
}

}  // namespace

template <int Dim>
DenseSystem assemble_dense(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                           const SolveOptions& options) {
  const auto extra = static_cast<Eigen::Index>(sides.count());
  const Eigen::Index size = assembler.size() + extra;
  DenseSystem system{RowMatrix::Zero(size, size), Eigen::MatrixXd::Zero(size, assembler.right_sides())};
  std::vector<std::int32_t> all(static_cast<std::size_t>(assembler.space().function_count()));
  std::iota(all.begin(), all.end(), 0);
  const auto clusters = target_clusters(assembler.space());
  std::vector<std::span<const std::int32_t>> groups;
  for (const Cluster& cluster : clusters->clusters())
    if (cluster.is_leaf()) groups.push_back(clusters->indices(cluster));
  std::vector<std::unique_ptr<ThreadRoom<Dim>>> rooms(
      static_cast<std::size_t>(quadrature::thread_count(options.threads)));
  quadrature::parallel_for(
      groups.size(), options.threads,
      [&](std::size_t task, int thread) {
        auto& room = rooms[static_cast<std::size_t>(thread)];
        if (!room) room = std::make_unique<ThreadRoom<Dim>>(assembler, all);
        room->integrator.integrate(groups[task], room->rows);
        set_rows(assembler, sides, groups[task], *room, system);
      },
      options.progress);
  system.right.topRows(assembler.size()) += assembler.load_potentials(options.tolerance, options.threads);
  system.matrix.block(assembler.size(), 0, extra, assembler.size()) = sides.rows;
  system.right.bottomRows(extra) = sides.right;
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
  DenseSolution solution{Eigen::MatrixXd(system.right.rows(), system.right.cols()),
                         Eigen::VectorXd::Zero(system.right.cols())};
  for (Eigen::Index k = 0; k < system.right.cols(); ++k) {
    const auto right = system.right.col(k);
    Eigen::VectorXd values = factors.solve(right);
    const Eigen::VectorXd left = right - system.matrix * values;
    values += factors.solve(left);
    const double norm = right.norm();
    if (norm > 0.0) solution.residual[k] = (right - system.matrix * values).norm() / norm;
    solution.values.col(k) = values;
  }
  return solution;
}

template DenseSystem assemble_dense<2>(const Assembler<2>&, const SideConditions<2>&, const SolveOptions&);
template DenseSystem assemble_dense<3>(const Assembler<3>&, const SideConditions<3>&, const SolveOptions&);

}  // namespace isorim::solver
