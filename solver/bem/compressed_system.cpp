#include "solver/bem/compressed_system.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "solver/bem/equation_rows.h"
#include "solver/bem/kernel_block.h"
#include "solver/linear/block_tree.h"
#include "solver/linear/bordered_system.h"
#include "solver/linear/cluster_tree.h"
#include "solver/linear/cross_approximation.h"
#include "solver/linear/gmres.h"
#include "solver/linear/hierarchical_lu.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Points of a cluster that is not divided any more. Blocks of vectors have up to three times the rank: with fewer
/// points all rows of most of them would be integrated, and elements once for every cluster of functions beside them.
constexpr int leaf_points = 64;
/// Least distance of blocks of low rank, times the diagonal of the largest support.
constexpr double separation = 0.75;
/// Of the factors that precondition, for degrees up to 2 (1e-4 costs half as much again and saves two iterations of
/// four); less for higher ones, as spline coefficients of degree p are the worse determined, by a factor like 2^p.
constexpr double factor_tolerance = 1e-2;
/// Of the residual, beside the tolerance of the compression: one more iteration, and the solution errs by the latter.
constexpr double residual_share = 0.1;

template <int Dim>
struct ElementBox {
  geometry::Point<Dim> lower;
  geometry::Point<Dim> upper;
};

template <int Dim>
ElementBox<Dim> box_of(const geometry::ElementTable<Dim>& table, std::size_t element) {
  const auto net = table.net_matrix(table.elements[element]);
  ElementBox<Dim> box{geometry::Point<Dim>::Constant(std::numeric_limits<double>::infinity()),
                      geometry::Point<Dim>::Constant(-std::numeric_limits<double>::infinity())};
  for (Index i = 0; i < net.cols(); ++i) {
    const geometry::Point<Dim> point = net.col(i).template head<Dim>() / net(Dim, i);
    box.lower = box.lower.cwiseMin(point);
    box.upper = box.upper.cwiseMax(point);
  }
  return box;
}

template <int Dim>
IndexPlaces index_places(const Assembler<Dim>& assembler) {
  const FieldSpace<Dim>& space = assembler.space();
  const Index count = space.function_count();
  IndexPlaces places;
  places.points = Eigen::Matrix3Xd::Zero(3, count);
  places.lower = Eigen::Matrix3Xd::Zero(3, count);
  places.upper = Eigen::Matrix3Xd::Zero(3, count);
  places.lower.topRows<Dim>().setConstant(std::numeric_limits<double>::infinity());
  places.upper.topRows<Dim>().setConstant(-std::numeric_limits<double>::infinity());
  places.components = assembler.components();
  for (Index i = 0; i < count; ++i)
    places.points.col(i).template head<Dim>() = space.points[static_cast<std::size_t>(i)].position;
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const ElementBox<Dim> box = box_of(space.table, e);
    for (const std::int32_t a : space.functions_of(static_cast<int>(e))) {
      places.lower.col(a).template head<Dim>() = places.lower.col(a).template head<Dim>().cwiseMin(box.lower);
      places.upper.col(a).template head<Dim>() = places.upper.col(a).template head<Dim>().cwiseMax(box.upper);
    }
  }
  return places;
}

/// Targets by which interpolated rows are judged.
constexpr std::size_t most_checks = 3;

template <int Dim>
struct ThreadRoom {
  explicit ThreadRoom(const Assembler<Dim>& assembler) : integrator(assembler) {}
  RowIntegrator<Dim> integrator;
  EquationRows rows;
  /// Of which leaf `rows` are the near ones.
  const std::int32_t* near_leaf = nullptr;
};

/// The rows of a block of low rank that are integrated, and those among them that are there to judge the others.
struct ChosenTargets {
  /// Places among the block's targets.
  std::vector<std::int32_t> places;
  std::size_t checks = 0;
};

/// The targets of the rows, and up to most_checks others spread over the rest.
ChosenTargets chosen_targets(const std::vector<Index>& rows, Index components, std::size_t target_count) {
  ChosenTargets chosen;
  std::vector<char> is_chosen(target_count, 0);
  const auto choose = [&](std::size_t place) {
    if (std::exchange(is_chosen[place], char{1}) == 0) chosen.places.push_back(static_cast<std::int32_t>(place));
  };
  for (const Index row : rows) choose(static_cast<std::size_t>(row / components));
  const std::size_t of_rows = chosen.places.size();
  for (std::size_t check = 0; check < most_checks; ++check) {
    std::size_t place = (2 * check + 1) * target_count / (2 * most_checks);
    while (place < target_count && is_chosen[place] != 0) ++place;
    if (place < target_count) choose(place);
  }
  chosen.checks = chosen.places.size() - of_rows;
  return chosen;
}

/// Integrates near blocks as they are; of far ones only those rows from which the others follow. Sums over the whole
/// boundary come about block by block.
template <int Dim>
class CollocationSource final : public MatrixSource {
 public:
  CollocationSource(const Assembler<Dim>& assembler, const BlockTree& tree, int threads);

  void dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, int thread,
                   Eigen::Ref<MatrixXd> block) const override;
  LowRank low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                         const Accuracy& accuracy, int thread) const override;

  /// EquationRows::sums over the whole boundary, after all blocks have been made.
  MatrixXd sums() const;

 private:
  using RowKey = std::pair<const std::int32_t*, std::size_t>;
  static RowKey key(std::span<const std::int32_t> rows) { return {rows.data(), rows.size()}; }
  ThreadRoom<Dim>& room(int thread) const;
  void integrate_near_rows(std::span<const std::int32_t> rows, ThreadRoom<Dim>& room) const;
  std::optional<LowRank> interpolated(std::span<const std::int32_t> rows, const RowInterpolation& interpolation,
                                      const Accuracy& accuracy, double sum_error, ThreadRoom<Dim>& room) const;
  void add_sums(std::span<const std::int32_t> rows, const MatrixXd& sums) const;

  const Assembler<Dim>* assembler_;
  SourcePoints<Dim> sources_;
  /// All near functions of each leaf of the rows.
  std::map<const std::int32_t*, std::vector<std::int32_t>> near_functions_;
  /// What the blocks of each cluster of rows have given.
  mutable std::map<RowKey, MatrixXd> sums_;
  mutable std::vector<std::unique_ptr<ThreadRoom<Dim>>> rooms_;
};

template <int Dim>
CollocationSource<Dim>::CollocationSource(const Assembler<Dim>& assembler, const BlockTree& tree, int threads)
    : assembler_(&assembler),
      sources_(assembler.space(), threads),
      rooms_(static_cast<std::size_t>(quadrature::thread_count(threads))) {
  for (const Block& block : tree.blocks()) {
    if (block.kind == BlockKind::subdivided) continue;
    const auto rows = tree.rows().indices(tree.row_cluster(block));
    sums_.try_emplace(key(rows));
    if (block.kind != BlockKind::dense) continue;
    const auto columns = tree.columns().indices(tree.column_cluster(block));
    std::vector<std::int32_t>& functions = near_functions_[rows.data()];
    functions.insert(functions.end(), columns.begin(), columns.end());
  }
}

template <int Dim>
ThreadRoom<Dim>& CollocationSource<Dim>::room(int thread) const {
  auto& room = rooms_[static_cast<std::size_t>(thread)];
  if (!room) room = std::make_unique<ThreadRoom<Dim>>(*assembler_);
  return *room;
}

template <int Dim>
void CollocationSource<Dim>::add_sums(std::span<const std::int32_t> rows, const MatrixXd& sums) const {
  MatrixXd& total = sums_.at(key(rows));
  if (total.size() == 0)
    total = sums;
  else
    total += sums;
}

template <int Dim>
MatrixXd CollocationSource<Dim>::sums() const {
  const Index components = assembler_->components();
  MatrixXd total = MatrixXd::Zero(assembler_->size(), sum_count(*assembler_));
  for (const auto& [rows, part] : sums_) {
    if (part.size() == 0) continue;
    for (std::size_t k = 0; k < rows.second; ++k)
      total.middleRows(rows.first[k] * components, components) +=
          part.middleRows(static_cast<Index>(k) * components, components);
  }
  return total;
}

/// The blocks of a leaf come one after the other: the first integrates all of them.
template <int Dim>
void CollocationSource<Dim>::integrate_near_rows(std::span<const std::int32_t> rows, ThreadRoom<Dim>& room) const {
  if (std::exchange(room.near_leaf, rows.data()) == rows.data()) return;
  room.integrator.set_functions(near_functions_.at(rows.data()));
  room.integrator.integrate(rows, room.rows);
  add_sums(rows, room.rows.sums);
}

template <int Dim>
void CollocationSource<Dim>::dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                                         int thread, Eigen::Ref<MatrixXd> block) const {
  ThreadRoom<Dim>& own = room(thread);
  integrate_near_rows(rows, own);
  const std::vector<std::int32_t>& functions = near_functions_.at(rows.data());
  const auto found = std::search(functions.begin(), functions.end(), columns.begin(), columns.end());
  block = own.rows.coefficients.middleCols((found - functions.begin()) * assembler_->components(), block.cols());
}

template <int Dim>
LowRank CollocationSource<Dim>::low_rank_block(std::span<const std::int32_t> rows,
                                               std::span<const std::int32_t> columns, const Accuracy& accuracy,
                                               int thread) const {
  ThreadRoom<Dim>& own = room(thread);
  own.near_leaf = nullptr;
  own.integrator.set_functions(columns);
  KernelBlock<Dim> kernel(*assembler_, sources_, rows, own.integrator.elements());
  const RowInterpolation interpolation = interpolate_rows(kernel, {accuracy.relative, 0.0});
  const double sum_error = accuracy.relative * kernel.double_layer_bound();
  if (std::optional<LowRank> found = interpolated(rows, interpolation, accuracy, sum_error, own))
    return *std::move(found);
  own.integrator.integrate(rows, own.rows);
  add_sums(rows, own.rows.sums);
  const Index row_count = own.rows.coefficients.rows();
  return {MatrixXd::Identity(row_count, row_count), own.rows.coefficients.transpose()};
}

/// None if all rows are wanted, or if those at the checks do not follow from the others within the accuracy.
template <int Dim>
std::optional<LowRank> CollocationSource<Dim>::interpolated(std::span<const std::int32_t> rows,
                                                            const RowInterpolation& interpolation,
                                                            const Accuracy& accuracy, double sum_error,
                                                            ThreadRoom<Dim>& room) const {
  const Index components = assembler_->components();
  const ChosenTargets chosen = chosen_targets(interpolation.rows, components, rows.size());
  if (chosen.places.size() == rows.size()) return std::nullopt;
  std::vector<std::int32_t> points;
  std::vector<Index> place_of(rows.size(), -1);
  for (const std::int32_t place : chosen.places) {
    place_of[static_cast<std::size_t>(place)] = static_cast<Index>(points.size());
    points.push_back(rows[static_cast<std::size_t>(place)]);
  }
  room.integrator.integrate(points, room.rows);
  std::vector<Index> pivots;
  for (const Index row : interpolation.rows)
    pivots.push_back(place_of[static_cast<std::size_t>(row / components)] * components + row % components);
  const MatrixXd pivot_rows = room.rows.coefficients(pivots, Eigen::all);
  const MatrixXd pivot_sums = room.rows.sums(pivots, Eigen::all);

  double squared_norm = 0.0;
  double squared_error = 0.0;
  double squared_sum_error = 0.0;
  for (std::size_t k = points.size() - chosen.checks; k < points.size(); ++k) {
    const auto here = interpolation.weights.middleRows(chosen.places[k] * components, components);
    const auto exact = room.rows.coefficients.middleRows(static_cast<Index>(k) * components, components);
    const auto exact_sums = room.rows.sums.middleRows(static_cast<Index>(k) * components, components);
    squared_norm += exact.squaredNorm();
    squared_error += (exact - here * pivot_rows).squaredNorm();
    squared_sum_error += (exact_sums - here * pivot_sums).leftCols(components).squaredNorm();
  }
  const double rows_per_check = static_cast<double>(rows.size()) / static_cast<double>(chosen.checks);
  const double allowed = accuracy.allowed(std::sqrt(squared_norm * rows_per_check));
  if (!(std::sqrt(squared_error * rows_per_check) <= allowed)) return std::nullopt;
  if (!(std::sqrt(squared_sum_error / static_cast<double>(chosen.checks)) <= sum_error)) return std::nullopt;
  add_sums(rows, interpolation.weights * pivot_sums);
  return LowRank{interpolation.weights, pivot_rows.transpose()};
}

template <int Dim>
double factor_tolerance_for(const FieldSpace<Dim>& space) {
  int highest = 2;
  for (const FieldElement<Dim>& element : space.elements) {
    for (const std::int8_t degree : element.degree) highest = std::max<int>(highest, degree);
  }
  return std::ldexp(factor_tolerance, 2 - highest);
}

/// |D| of the terms in u(x), about: half the functions' values where they are unknown.
template <int Dim>
double norm_of_target_terms(const Assembler<Dim>& assembler) {
  const FieldSpace<Dim>& space = assembler.space();
  std::vector<double> basis;
  double squared = 0.0;
  for (const CollocationPoint<Dim>& point : space.points) {
    basis.resize(space.functions_of(point.element).size());
    basis_values(space, point.element, point.place, std::span<double>(basis));
    for (int c = 0; c < assembler.components(); ++c) {
      if (assembler.is_flux_unknown(point.element, c)) continue;
      for (const double value : basis) squared += 0.25 * value * value;
    }
  }
  return std::sqrt(squared);
}

/// What needs the sums over the whole boundary: terms in u(x), right sides and the columns of the side conditions.
template <int Dim>
void add_target_terms(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides, const MatrixXd& sums,
                      HierarchicalMatrix& matrix, CompressedSystem& system) {
  const Index components = assembler.components();
  const auto mode_count = static_cast<Index>(assembler.flux_modes().size());
  AssemblyRoom<Dim> room(assembler.problems());
  for (std::int32_t point = 0; point < assembler.space().function_count(); ++point) {
    const auto of_point = sums.middleRows(point * components, components);
    Eigen::Matrix<double, Dim, Dim> double_layer = Eigen::Matrix<double, Dim, Dim>::Zero();
    double_layer.topLeftCorner(components, components) = of_point.leftCols(components);
    const auto terms = assembler.target_terms(point, double_layer, room);
    const auto functions = assembler.space().functions_of(assembler.target(point).element);
    for (std::size_t a = 0; a < functions.size(); ++a)
      matrix.add_entries(point, functions[a],
                         terms.coefficients.middleCols(static_cast<Index>(a) * components, components));
    system.right.middleRows(point * components, components) +=
        of_point.middleCols(components, assembler.right_sides()) + terms.right.topRows(components);
    system.columns.middleRows(point * components, components).leftCols(mode_count) =
        assembler.flux_scale() * of_point.rightCols(mode_count);
    for (std::size_t k = 0; k < sides.constants.size(); ++k)
      system.columns.col(static_cast<Index>(k)).segment(point * components, components) =
          -sides.constants[k].head(components);
  }
}

}  // namespace

template <int Dim>
CompressedSystem assemble_compressed(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                                     const SolveOptions& options) {
  const auto clusters =
      std::make_shared<const ClusterTree>(index_places(assembler), leaf_points * assembler.components());
  BlockTreeOptions tree_options;
  tree_options.separation = separation;
  const auto tree = std::make_shared<const BlockTree>(clusters, clusters, tree_options);
  const CollocationSource<Dim> source(assembler, *tree, options.threads);
  AssemblyOptions assembly_options;
  assembly_options.tolerance = options.tolerance;
  assembly_options.threads = options.threads;
  assembly_options.norm_to_come = norm_of_target_terms(assembler);
  assembly_options.progress = options.progress;
  const auto matrix = std::make_shared<HierarchicalMatrix>(assemble(tree, source, assembly_options));

  CompressedSystem system;
  const auto side_count = static_cast<Index>(sides.count());
  system.columns = MatrixXd::Zero(assembler.size(), side_count);
  system.rows = sides.rows;
  system.factor_tolerance = factor_tolerance_for(assembler.space());
  system.right.resize(assembler.size() + side_count, assembler.right_sides());
  system.right << assembler.load_potentials(options.tolerance, options.threads), sides.right;
  add_target_terms(assembler, sides, source.sums(), *matrix, system);
  system.matrix = matrix;
  return system;
}

CompressedSolution solve_compressed(const CompressedSystem& system, const SolveOptions& options) {
  const HierarchicalLu factors(*system.matrix, {system.factor_tolerance, options.threads});
  const Border border{system.columns, system.rows, MatrixXd::Zero(system.rows.rows(), system.rows.rows())};
  const BorderedMatrix matrix(*system.matrix, border);
  const BorderedInverse inverse(factors, border);
  GmresOptions gmres_options;
  gmres_options.tolerance = residual_share * options.tolerance;
  gmres_options.max_iterations = options.max_iterations;
  const Index count = system.right.cols();
  CompressedSolution solution{MatrixXd(system.right.rows(), count), Eigen::VectorXi(count), VectorXd(count),
                              system.matrix->memory() + factors.memory()};
  for (Index k = 0; k < count; ++k) {
    const GmresResult found = gmres(matrix, system.right.col(k), gmres_options, &inverse);
    if (found.status == GmresStatus::iteration_limit ||
        (found.status == GmresStatus::stagnated && found.residual > 100.0 * options.tolerance)) {
      throw NumericalError(
          fmt::format("GMRES stopped after {} iterations at the relative residual {:.2e}; expected {:.1e}",
                      found.iterations, found.residual, options.tolerance));
    }
    solution.values.col(k) = found.x;
    solution.iterations[k] = found.iterations;
    solution.residual[k] = found.residual;
  }
  return solution;
}

template CompressedSystem assemble_compressed<2>(const Assembler<2>&, const SideConditions<2>&, const SolveOptions&);
template CompressedSystem assemble_compressed<3>(const Assembler<3>&, const SideConditions<3>&, const SolveOptions&);

}  // namespace isorim::solver
