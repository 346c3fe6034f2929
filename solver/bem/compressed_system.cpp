#include "solver/bem/compressed_system.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
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

/// Scalar rows of a cluster that is not divided any more.
constexpr int leaf_size = 64;
/// Times the diagonal of the largest support: one and a half radii from the middle of any element, where the rules for
/// far targets begin.
constexpr double separation = 0.75;
/// Of the factors that precondition.
constexpr double factor_tolerance = 1e-4;

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

/// A thread's numbering of some functions; -1 for the others.
class LocalNumbers {
 public:
  explicit LocalNumbers(std::size_t count) : number_(count, -1) {}
  void set(std::span<const std::int32_t> functions) {
    for (const std::int32_t a : given_) number_[static_cast<std::size_t>(a)] = -1;
    given_.assign(functions.begin(), functions.end());
    for (std::size_t k = 0; k < given_.size(); ++k)
      number_[static_cast<std::size_t>(given_[k])] = static_cast<std::int32_t>(k);
  }
  std::int32_t operator[](std::int32_t function) const { return number_[static_cast<std::size_t>(function)]; }

 private:
  std::vector<std::int32_t> number_;
  std::vector<std::int32_t> given_;
};

template <int Dim>
struct ThreadRoom {
  ThreadRoom(const Assembler<Dim>& assembler)
      : room(assembler.problem()),
        numbers(static_cast<std::size_t>(assembler.space().function_count())),
        seen(assembler.space().elements.size(), 0) {}
  AssemblyRoom<Dim> room;
  LocalNumbers numbers;
  std::vector<char> seen;
};

/// Elements on which any of the functions lives, increasing.
template <int Dim>
std::vector<int> elements_under(const std::vector<std::vector<int>>& elements_of,
                                std::span<const std::int32_t> functions, ThreadRoom<Dim>& room) {
  std::vector<int> elements;
  for (const std::int32_t a : functions) {
    for (const int e : elements_of[static_cast<std::size_t>(a)]) {
      if (std::exchange(room.seen[static_cast<std::size_t>(e)], char{1}) == 0) elements.push_back(e);
    }
  }
  for (const int e : elements) room.seen[static_cast<std::size_t>(e)] = 0;
  std::sort(elements.begin(), elements.end());
  return elements;
}

/// Makes near blocks, right sides and side columns first, row cluster by row cluster; then the blocks on demand.
template <int Dim>
class CollocationSource final : public MatrixSource {
 public:
  CollocationSource(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides, const BlockTree& tree,
                    const SolveOptions& options);

  void dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, int thread,
                   Eigen::Ref<MatrixXd> block) const override;
  LowRank low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                         const Accuracy& accuracy, int thread) const override;

  MatrixXd columns;
  VectorXd right;

 private:
  struct NearBlock {
    std::span<const std::int32_t> columns;
    MatrixXd entries;
  };
  /// Of one leaf of the rows.
  struct NearRows {
    std::span<const std::int32_t> rows;
    std::vector<NearBlock> blocks;
  };
  ThreadRoom<Dim>& room(int thread) const;
  void fill_rows(NearRows& near, ThreadRoom<Dim>& room);
  void fill_point(NearRows& near, std::size_t row, const std::vector<int>& elements, ThreadRoom<Dim>& room);
  void scatter(NearRows& near, std::size_t row, int element, ThreadRoom<Dim>& room) const;
  MatrixXd contract(const KernelBlock<Dim>& kernel, const MatrixXd& nodes, std::span<const std::int32_t> columns,
                    ThreadRoom<Dim>& room) const;

  const Assembler<Dim>* assembler_;
  const SideConditions<Dim>* sides_;
  std::vector<std::vector<int>> elements_of_;
  std::vector<NearRows> near_;
  /// Where the rows of a near block stand in near_.
  std::map<const std::int32_t*, std::size_t> place_of_rows_;
  mutable std::vector<std::unique_ptr<ThreadRoom<Dim>>> rooms_;
};

template <int Dim>
CollocationSource<Dim>::CollocationSource(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                                          const BlockTree& tree, const SolveOptions& options)
    : columns(MatrixXd::Zero(assembler.size(), static_cast<Index>(sides.count()))),
      right(VectorXd::Zero(assembler.size())),
      assembler_(&assembler),
      sides_(&sides),
      elements_of_(static_cast<std::size_t>(assembler.space().function_count())),
      rooms_(static_cast<std::size_t>(quadrature::thread_count(options.threads))) {
  for (int e = 0; e < static_cast<int>(assembler.space().elements.size()); ++e) {
    for (const std::int32_t a : assembler.space().functions_of(e))
      elements_of_[static_cast<std::size_t>(a)].push_back(e);
  }
  for (const Block& block : tree.blocks()) {
    if (block.kind != BlockKind::dense) continue;
    const auto rows = tree.rows().indices(tree.row_cluster(block));
    const auto [place, is_new] = place_of_rows_.try_emplace(rows.data(), near_.size());
    if (is_new) near_.push_back({rows, {}});
    near_[place->second].blocks.push_back({tree.columns().indices(tree.column_cluster(block)), {}});
  }
  quadrature::parallel_for(
      near_.size(), options.threads, [&](std::size_t task, int thread) { fill_rows(near_[task], room(thread)); },
      options.progress);
  right += assembler.load_potentials(options.tolerance, options.threads).reshaped();
}

template <int Dim>
ThreadRoom<Dim>& CollocationSource<Dim>::room(int thread) const {
  auto& room = rooms_[static_cast<std::size_t>(thread)];
  if (!room) room = std::make_unique<ThreadRoom<Dim>>(*assembler_);
  return *room;
}

template <int Dim>
void CollocationSource<Dim>::fill_rows(NearRows& near, ThreadRoom<Dim>& room) {
  const Index components = assembler_->components();
  std::vector<std::int32_t> functions;
  for (NearBlock& block : near.blocks) {
    functions.insert(functions.end(), block.columns.begin(), block.columns.end());
    block.entries.setZero(static_cast<Index>(near.rows.size()) * components,
                          static_cast<Index>(block.columns.size()) * components);
  }
  room.numbers.set(functions);
  const std::vector<int> elements = elements_under<Dim>(elements_of_, functions, room);
  for (std::size_t row = 0; row < near.rows.size(); ++row) fill_point(near, row, elements, room);
}

template <int Dim>
void CollocationSource<Dim>::fill_point(NearRows& near, std::size_t row, const std::vector<int>& elements,
                                        ThreadRoom<Dim>& room) {
  const std::int32_t point = near.rows[row];
  const quadrature::Target<Dim> target = assembler_->target(point);
  const auto count = static_cast<int>(assembler_->space().elements.size());
  assembler_->start_target(room.room);
  auto next = elements.begin();
  for (int e = 0; e < count; ++e) {
    if (next != elements.end() && *next == e) {
      ++next;
      assembler_->add_element(target, e, room.room);
      scatter(near, row, e, room);
    } else {
      assembler_->add_element_sums(target, e, room.room);
    }
  }
  assembler_->add_target_terms(point, room.room);
  scatter(near, row, target.element, room);
  const Index components = assembler_->components();
  for (Index i = 0; i < components; ++i) {
    right[point * components + i] = room.room.right[i];
    for (Index m = 0; m < room.room.modes.cols(); ++m)
      columns(point * components + i, m) = assembler_->flux_scale() * room.room.modes(i, m);
    for (std::size_t k = 0; k < sides_->constants.size(); ++k)
      columns(point * components + i, static_cast<Index>(k)) = -sides_->constants[k][i];
  }
}

/// room.room.block to the near blocks of the row; functions that are far are left to their own blocks.
template <int Dim>
void CollocationSource<Dim>::scatter(NearRows& near, std::size_t row, int element, ThreadRoom<Dim>& room) const {
  const std::span<const std::int32_t> functions = assembler_->space().functions_of(element);
  const Index components = assembler_->components();
  const auto count = static_cast<Index>(functions.size());
  for (Index a = 0; a < count; ++a) {
    auto number = static_cast<std::int64_t>(room.numbers[functions[static_cast<std::size_t>(a)]]);
    if (number < 0) continue;
    auto block = near.blocks.begin();
    while (number >= static_cast<std::int64_t>(block->columns.size())) {
      number -= static_cast<std::int64_t>(block->columns.size());
      ++block;
    }
    for (Index i = 0; i < components; ++i) {
      for (Index c = 0; c < components; ++c) {
        block->entries(static_cast<Index>(row) * components + i, number * components + c) +=
            room.room.block[static_cast<std::size_t>((i * components + c) * count + a)];
      }
    }
  }
}

template <int Dim>
void CollocationSource<Dim>::dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns_,
                                         int /*thread*/, Eigen::Ref<MatrixXd> block) const {
  const NearRows& near = near_[place_of_rows_.at(rows.data())];
  const auto found = std::find_if(near.blocks.begin(), near.blocks.end(), [&](const NearBlock& candidate) {
    return candidate.columns.data() == columns_.data();
  });
  block = found->entries;
}

template <int Dim>
LowRank CollocationSource<Dim>::low_rank_block(std::span<const std::int32_t> rows,
                                               std::span<const std::int32_t> columns_, const Accuracy& accuracy,
                                               int thread) const {
  ThreadRoom<Dim>& own = room(thread);
  const std::vector<int> elements = elements_under<Dim>(elements_of_, columns_, own);
  KernelBlock<Dim> kernel(*assembler_, rows, elements, own.room);
  LowRank result = cross_approximation(kernel, accuracy);
  result.v = contract(kernel, result.v, columns_, own);
  return result;
}

/// From nodes to functions: row (function, component) is the sum over its nodes of the function's value times the rows
/// (node, component).
template <int Dim>
MatrixXd CollocationSource<Dim>::contract(const KernelBlock<Dim>& kernel, const MatrixXd& nodes,
                                          std::span<const std::int32_t> columns_, ThreadRoom<Dim>& room) const {
  const Index components = assembler_->components();
  const Index rank = nodes.cols();
  MatrixXd result = MatrixXd::Zero(static_cast<Index>(columns_.size()) * components, rank);
  room.numbers.set(columns_);
  std::vector<double> integrands;
  std::vector<double> moments;
  for (const auto& part : kernel.parts()) {
    const std::span<const std::int32_t> functions = assembler_->space().functions_of(part.element);
    const auto first = static_cast<Index>(part.first);
    const auto count = static_cast<Index>(part.count);
    integrands.resize(static_cast<std::size_t>(rank * components * count));
    for (Index k = 0; k < rank; ++k) {
      for (Index c = 0; c < components; ++c) {
        double* target = integrands.data() + (k * components + c) * count;
        for (Index q = 0; q < count; ++q) target[q] = nodes((first + q) * components + c, k);
      }
    }
    moments.assign(static_cast<std::size_t>(rank * components) * functions.size(), 0.0);
    add_moments<Dim>(assembler_->space(), part.element, *part.basis, integrands, static_cast<int>(rank * components),
                     room.room.scratch, moments);
    for (std::size_t a = 0; a < functions.size(); ++a) {
      const std::int32_t number = room.numbers[functions[a]];
      if (number < 0) continue;
      for (Index k = 0; k < rank; ++k) {
        for (Index c = 0; c < components; ++c)
          result(number * components + c, k) +=
              moments[static_cast<std::size_t>(k * components + c) * functions.size() + a];
      }
    }
  }
  return result;
}

}  // namespace

template <int Dim>
CompressedSystem assemble_compressed(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                                     const SolveOptions& options) {
  const auto clusters = std::make_shared<const ClusterTree>(index_places(assembler), leaf_size);
  BlockTreeOptions tree_options;
  tree_options.separation = separation;
  const auto tree = std::make_shared<const BlockTree>(clusters, clusters, tree_options);
  CollocationSource<Dim> source(assembler, sides, *tree, options);
  CompressedSystem system;
  system.matrix = std::make_shared<const HierarchicalMatrix>(
      assemble(tree, source, {options.tolerance, options.threads, options.progress}));
  system.columns = std::move(source.columns);
  system.rows = sides.rows;
  system.right.resize(assembler.size() + static_cast<Index>(sides.count()));
  system.right << source.right, sides.right;
  return system;
}

CompressedSolution solve_compressed(const CompressedSystem& system, const SolveOptions& options) {
  const HierarchicalLu factors(*system.matrix, {factor_tolerance, options.threads});
  const Border border{system.columns, system.rows, MatrixXd::Zero(system.rows.rows(), system.rows.rows())};
  const BorderedMatrix matrix(*system.matrix, border);
  const BorderedInverse inverse(factors, border);
  GmresOptions gmres_options;
  gmres_options.tolerance = options.tolerance;
  gmres_options.max_iterations = options.max_iterations;
  GmresResult found = gmres(matrix, system.right, gmres_options, &inverse);
  if (found.status == GmresStatus::iteration_limit ||
      (found.status == GmresStatus::stagnated && found.residual > 100.0 * options.tolerance)) {
    throw NumericalError(
        fmt::format("GMRES stopped after {} iterations at the relative residual {:.2e}; expected {:.1e}",
                    found.iterations, found.residual, options.tolerance));
  }
  return {std::move(found.x), found.iterations, found.residual, system.matrix->memory() + factors.memory()};
}

template CompressedSystem assemble_compressed<2>(const Assembler<2>&, const SideConditions<2>&, const SolveOptions&);
template CompressedSystem assemble_compressed<3>(const Assembler<3>&, const SideConditions<3>&, const SolveOptions&);

}  // namespace isorim::solver
