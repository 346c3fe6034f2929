#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "solver/bem/assembly.h"
#include "solver/linear/cross_approximation.h"

namespace isorim::solver {

/// Points on every element that stand for all sources on it: a grid in its parameters, about twice as many points
/// altogether as the space has functions, four an element at least (two in the plane).
template <int Dim>
class SourcePoints {
 public:
  SourcePoints(const FieldSpace<Dim>& space, int threads);

  using Coordinates = std::array<std::vector<double>, Dim>;
  std::size_t per_element() const { return per_element_; }
  /// Those of element e stand from e * per_element() on. Normals are unit and outward, weights those of quadrature.
  const Coordinates& positions() const { return positions_; }
  const Coordinates& normals() const { return normals_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  std::size_t per_element_;
  Coordinates positions_;
  Coordinates normals_;
  std::vector<double> weights_;
};

/// The kernels between some collocation points and the source points of elements, which tell how the equations at the
/// points depend on one another as far as those elements are concerned. Entry (i of a target, j of a source): the
/// double layer T_ij for j < C, then the single layer U_ij if any of the elements needs it; times the source's weight,
/// and scaled so that both are of like size: T by the distance, U by the stiffness.
template <int Dim>
class KernelBlock final : public CrossSource {
 public:
  KernelBlock(const Assembler<Dim>& assembler, const SourcePoints<Dim>& sources, std::span<const std::int32_t> targets,
              std::span<const int> elements);

  Eigen::Index targets() const override { return static_cast<Eigen::Index>(targets_.size()); }
  Eigen::Index nodes() const override { return static_cast<Eigen::Index>(weights_.size()); }
  int row_components() const override { return assembler_->components(); }
  int column_components() const override { return assembler_->components() * (needs_single_ ? 2 : 1); }
  void row(Eigen::Index target, Eigen::Ref<Eigen::MatrixXd> values) override;
  void column(Eigen::Index node, Eigen::Ref<Eigen::MatrixXd> values) override;
  std::int32_t target_group(Eigen::Index target) const override;
  std::int32_t node_group(Eigen::Index node) const override;
  /// What int |T| dS over the elements is at most, about.
  double double_layer_bound() const;

 private:
  using Coordinates = typename SourcePoints<Dim>::Coordinates;

  void evaluate(const geometry::Point<Dim>& target, const Coordinates& positions, const Coordinates& normals);
  double least_distance() const;

  const Assembler<Dim>* assembler_;
  std::vector<std::int32_t> targets_;
  std::vector<int> elements_;
  std::size_t per_element_;
  Coordinates positions_;
  Coordinates normals_;
  std::vector<double> weights_;
  Coordinates target_positions_;
  Coordinates repeated_normal_;
  bool needs_single_ = false;
  double double_scale_ = 1.0;
  double single_scale_ = 1.0;
  std::vector<double> double_values_;
  std::vector<double> single_values_;
};

}  // namespace isorim::solver
