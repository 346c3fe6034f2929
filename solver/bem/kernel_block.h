#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "solver/bem/assembly.h"
#include "solver/linear/cross_approximation.h"

namespace isorim::solver {

/// The equations' kernels between some collocation points and the quadrature nodes of elements far from them, as the
/// unknowns meet them: entry (i of a target, c of a node) is what the unknown component c (of the frame of the node's
/// condition) contributes to equation i if its function is 1 at the node alone. Weights are included.
template <int Dim>
class KernelBlock final : public CrossSource {
 public:
  /// `elements` must be away from the targets by the rules' standards for far ones.
  KernelBlock(const Assembler<Dim>& assembler, std::span<const std::int32_t> targets, std::span<const int> elements,
              AssemblyRoom<Dim>& room);

  Eigen::Index targets() const override { return static_cast<Eigen::Index>(targets_.size()); }
  Eigen::Index nodes() const override { return static_cast<Eigen::Index>(node_count_); }
  int row_components() const override { return assembler_->components(); }
  int column_components() const override { return assembler_->components(); }
  void row(Eigen::Index target, Eigen::Ref<Eigen::MatrixXd> values) override;
  void column(Eigen::Index node, Eigen::Ref<Eigen::MatrixXd> values) override;
  std::int32_t target_group(Eigen::Index target) const override;
  std::int32_t node_group(Eigen::Index node) const override;

  /// Nodes of one element: [first, first + count).
  struct Part {
    int element = 0;
    std::size_t first = 0;
    std::size_t count = 0;
    const NodeBasis<Dim>* basis = nullptr;
  };
  const std::vector<Part>& parts() const { return parts_; }

 private:
  using Coordinates = std::array<std::vector<double>, Dim>;

  void append(int element, double distance, AssemblyRoom<Dim>& room);
  /// Evaluates the kernels that the entries need at `nodes` for one target; sign: of the double layer.
  void evaluate(const geometry::Point<Dim>& target, const Coordinates& positions, const Coordinates& normals);
  double entry(std::size_t at, std::size_t count, std::size_t node, int i, int c, double double_sign) const;

  const Assembler<Dim>* assembler_;
  std::vector<std::int32_t> targets_;
  std::vector<Part> parts_;
  std::vector<int> part_of_node_;
  std::size_t node_count_ = 0;
  Coordinates positions_;
  Coordinates normals_;
  Coordinates target_positions_;
  Coordinates repeated_normal_;
  /// Factors of the two kernels, node * components + component.
  std::vector<double> double_factor_;
  std::vector<double> single_factor_;
  bool needs_double_ = false;
  bool needs_single_ = false;
  std::vector<double> double_values_;
  std::vector<double> single_values_;
};

}  // namespace isorim::solver
