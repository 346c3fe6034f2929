#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "quadrature/target_rules.h"
#include "solver/bem/field_space.h"

namespace isorim::solver {

/// What is needed of the functions of an element at a set of nodes: Bernstein polynomials direction by direction, along
/// the lines of the grid if the nodes form one. Memory: of a grid of n x n nodes, n^2 + O(n) numbers.
template <int Dim>
struct NodeBasis {
  int nodes = 0;
  /// Nodes along the lines of a grid, the first parameter fastest; {nodes, 1} of scattered ones. In the plane {nodes}.
  std::array<int, Dim - 1> counts{};
  bool scattered = false;
  /// B_i at line (or node) q of direction d, node by node in rows padded to product_lanes: values[d][q * step[d] + i].
  std::array<std::vector<double>, Dim - 1> values;
  std::array<int, Dim - 1> step{};
  /// 1 / w at every node for rational functions, else empty.
  std::vector<double> reciprocal_weight;
};

/// Room for the sums below; one for each thread.
struct MomentScratch {
  std::vector<double> lines;
  std::vector<double> left;
  std::vector<double> padded_moments;
  std::vector<double> moments;
  std::vector<double> bernstein;
  std::vector<double> places;
};

/// 1 / w at every node, w the weight function of the element's net.
void fill_reciprocal_weights(const geometry::ElementTable<2>& table, const geometry::BezierElement<2>& element,
                             const quadrature::NodeView<2>& nodes, std::vector<double>& result,
                             std::vector<double>& room);
void fill_reciprocal_weights(const geometry::ElementTable<3>& table, const geometry::BezierElement<3>& element,
                             const quadrature::NodeView<3>& nodes, std::vector<double>& result,
                             std::vector<double>& room);

/// Fills `basis`, keeping its memory.
template <int Dim>
void fill_node_basis(const FieldSpace<Dim>& space, int element, const quadrature::NodeView<Dim>& nodes,
                     NodeBasis<Dim>& basis, MomentScratch& scratch);

/// result[f * count + a] += sum over the nodes of integrands[f * n + q] phi_a(node q), n the number of nodes, for all
/// `integrand_count` integrands f and the `count` functions a of the element. The integrands are overwritten. On grids
/// the sums are factorised: about (p + 1) multiply-adds a node and integrand in place of (p + 1)^2.
template <int Dim>
void add_moments(const FieldSpace<Dim>& space, int element, const NodeBasis<Dim>& basis, std::span<double> integrands,
                 int integrand_count, MomentScratch& scratch, std::span<double> result);

/// values[q] *= sum_j coefficients[j] B_j(node q) (over w there, for rational functions): by the function with these
/// Bernstein coefficients.
template <int Dim>
void multiply_by_function(const NodeBasis<Dim>& basis, const std::array<std::int8_t, Dim - 1>& degree,
                          std::span<const double> coefficients, std::span<double> values);

}  // namespace isorim::solver
