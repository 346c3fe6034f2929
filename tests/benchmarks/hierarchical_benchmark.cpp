// What do hierarchical matrices cost against unknowns, and beside dense ones?
//
//   build/bin/benchmark_hierarchical --benchmark_counters_tabular=true
//
// Collocation of the single layer 1 / r with panels of equal area on a sphere, each panel one node. Compressed:
// assembly at 1e-5, H-LU at 1e-2, GMRES to 1e-8; counters give bytes and iterations of each. Dense: the same entries
// and Eigen's LU, one thread.

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/LU>
#include <benchmark/benchmark.h>

#include "solver/linear/cross_approximation.h"
#include "solver/linear/gmres.h"
#include "solver/linear/hierarchical_lu.h"
#include "solver/linear/hierarchical_matrix.h"

namespace {

using namespace isorim::solver;
using Eigen::Index;

Eigen::Matrix3Xd sphere_points(Index n) {
  Eigen::Matrix3Xd points(3, n);
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(n);
    const double radius = std::sqrt(1.0 - z * z);
    const double angle = golden * static_cast<double>(i);
    points.col(i) << radius * std::cos(angle), radius * std::sin(angle), z;
  }
  return points;
}

class SingleLayer final : public MatrixSource {
 public:
  explicit SingleLayer(const Eigen::Matrix3Xd& points)
      : points_(points), diagonal_(std::sqrt(static_cast<double>(points.cols()))) {}

  double entry(std::int32_t i, std::int32_t j) const {
    return i == j ? diagonal_ : 1.0 / (points_.col(i) - points_.col(j)).norm();
  }

  void dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, int /*thread*/,
                   Eigen::Ref<Eigen::MatrixXd> block) const override {
    for (Index j = 0; j < std::ssize(columns); ++j)
      for (Index i = 0; i < std::ssize(rows); ++i)
        block(i, j) = entry(rows[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
  }

  LowRank low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                         const Accuracy& accuracy, int thread) const override {
    struct Block final : CrossSource {
      const SingleLayer& source;
      std::span<const std::int32_t> rows;
      std::span<const std::int32_t> columns;
      int thread;
      Block(const SingleLayer& s, std::span<const std::int32_t> r, std::span<const std::int32_t> c, int t)
          : source(s), rows(r), columns(c), thread(t) {}
      Index targets() const override { return std::ssize(rows); }
      Index nodes() const override { return std::ssize(columns); }
      void row(Index target, Eigen::Ref<Eigen::MatrixXd> values) override {
        // Symmetric.
        source.dense_block(columns, rows.subspan(static_cast<std::size_t>(target), 1), thread, values);
      }
      void column(Index node, Eigen::Ref<Eigen::MatrixXd> values) override {
        source.dense_block(rows, columns.subspan(static_cast<std::size_t>(node), 1), thread, values);
      }
    } block(*this, rows, columns, thread);
    return cross_approximation(block, accuracy);
  }

 private:
  const Eigen::Matrix3Xd& points_;
  double diagonal_;
};

std::shared_ptr<const BlockTree> block_tree(const Eigen::Matrix3Xd& points) {
  const auto clusters = std::make_shared<const ClusterTree>(IndexPlaces{points, points, points, 1}, 64);
  return std::make_shared<const BlockTree>(clusters, clusters);
}

constexpr double megabyte = 1e6;

void Assemble(benchmark::State& state) {
  const Eigen::Matrix3Xd points = sphere_points(state.range(0));
  const SingleLayer source(points);
  for (auto _ : state) {
    const HierarchicalMatrix matrix = assemble(block_tree(points), source, {.tolerance = 1e-5});
    state.counters["MB"] = static_cast<double>(matrix.memory()) / megabyte;
    state.counters["rank"] = matrix.statistics().mean_rank;
  }
}
BENCHMARK(Assemble)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(50000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void Factorise(benchmark::State& state) {
  const Eigen::Matrix3Xd points = sphere_points(state.range(0));
  const HierarchicalMatrix matrix = assemble(block_tree(points), SingleLayer(points), {.tolerance = 1e-5});
  const Eigen::VectorXd right_side = Eigen::VectorXd::LinSpaced(points.cols(), -1.0, 2.0);
  for (auto _ : state) {
    const HierarchicalLu inverse(matrix, {.tolerance = 1e-2});
    state.PauseTiming();
    state.counters["MB"] = static_cast<double>(inverse.memory()) / megabyte;
    state.counters["iterations"] = gmres(matrix, right_side, {.tolerance = 1e-8}, &inverse).iterations;
    state.ResumeTiming();
  }
}
BENCHMARK(Factorise)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(50000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void Product(benchmark::State& state) {
  const Eigen::Matrix3Xd points = sphere_points(state.range(0));
  const HierarchicalMatrix matrix = assemble(block_tree(points), SingleLayer(points), {.tolerance = 1e-5});
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(points.cols(), -1.0, 2.0);
  for (auto _ : state) benchmark::DoNotOptimize(matrix.product(x));
}
BENCHMARK(Product)
    ->Arg(1000)
    ->Arg(5000)
    ->Arg(20000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void DenseAssembleAndFactorise(benchmark::State& state) {
  const Eigen::Matrix3Xd points = sphere_points(state.range(0));
  const SingleLayer source(points);
  std::vector<std::int32_t> all(static_cast<std::size_t>(points.cols()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
  for (auto _ : state) {
    Eigen::MatrixXd matrix(points.cols(), points.cols());
    source.dense_block(all, all, 0, matrix);
    const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> factors(matrix);
    benchmark::DoNotOptimize(factors.matrixLU().data());
    state.counters["MB"] = static_cast<double>(matrix.size() * 8) / megabyte;
  }
}
BENCHMARK(DenseAssembleAndFactorise)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
