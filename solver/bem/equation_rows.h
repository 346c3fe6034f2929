#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "solver/bem/assembly.h"

namespace isorim::solver {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What some functions give to the equations of some targets; C components, R right sides, M flux modes. The functions
/// of the whole space sum up to one, so the integrals over the boundary are the sums of these over any division of the
/// functions.
struct EquationRows {
  /// (targets C) x (functions C). Entry (t C + i, k C + c): what the unknown component c of the k-th function is
  /// multiplied by in equation i of target t, without the terms in u(x).
  RowMatrix coefficients;
  /// (targets C) x (C + R + M), phi the sum of the functions. Row t C + i: int T_ij phi dS in column j < C, what known
  /// data under phi give to the right sides in R columns, then -s int U r_m phi dS for each flux mode r_m.
  Eigen::MatrixXd sums;
};

/// Columns of EquationRows::sums.
template <int Dim>
Eigen::Index sum_count(const Assembler<Dim>& assembler) {
  return assembler.components() + assembler.right_sides() + static_cast<Eigen::Index>(assembler.flux_modes().size());
}

/// Integrates rows of the equations, element by element for all targets that an element serves by one rule, all of its
/// functions at once: one evaluation of the kernels a target and node. Serves one thread; the numbers do not depend on
/// what it was used for before.
template <int Dim>
class RowIntegrator {
 public:
  explicit RowIntegrator(const Assembler<Dim>& assembler);

  /// Chooses the functions of the rows; none twice.
  void set_functions(std::span<const std::int32_t> functions);
  /// The elements on which any of them lives, increasing.
  std::span<const int> elements() const { return elements_; }
  /// Of some collocation points.
  void integrate(std::span<const std::int32_t> points, EquationRows& rows);

  AssemblyRoom<Dim>& room() { return room_; }

 private:
  using View = quadrature::NodeView<Dim>;
  /// Targets (their places in the list) that are served by one rule of an element.
  struct Group {
    View nodes;
    std::vector<int> targets;
  };
  /// Factors of the kernels at an element's nodes, weights included; rows of as many numbers as there are nodes.
  struct Factors {
    /// Of the double and the single layer in the unknown component c.
    std::vector<double> of_double;
    std::vector<double> of_single;
    /// double_rows of the double layer's column j, for the sums: phi, and each problem's known values.
    std::vector<double> double_sums;
    int double_rows = 0;
    /// single_rows of the single layer's column j: each problem's known fluxes, flux modes.
    std::vector<double> single_sums;
    int single_rows = 0;
  };

  void add_element(int element, EquationRows& rows);
  void add_group(int element, const View& nodes, std::span<const int> targets, EquationRows& rows);
  void set_factors(int element, const View& nodes, const typename Assembler<Dim>::NodeData& data);
  void set_sum_factors(int element, const View& nodes, const typename Assembler<Dim>::NodeData& data);
  void add_known_data(int element, std::size_t nodes, const ConditionValues<Dim>& values, std::size_t j,
                      double* of_double, double* of_single) const;
  void set_share(int element, const View& nodes, const NodeBasis<Dim>& basis);
  void evaluate_kernels(int element, const View& nodes, std::span<const int> targets);
  void add_sums(std::size_t nodes, std::span<const int> targets, EquationRows& rows);
  void fill_integrands(int element, std::size_t nodes, std::size_t targets);
  void scatter(int element, std::span<const int> targets, EquationRows& rows) const;

  const Assembler<Dim>* assembler_;
  AssemblyRoom<Dim> room_;
  std::vector<quadrature::Target<Dim>> targets_;
  /// Each function's place in the list, -1 for the others.
  std::vector<std::int32_t> number_;
  std::vector<std::int32_t> numbered_;
  std::vector<int> elements_;
  std::vector<char> is_listed_;

  std::vector<Group> groups_;
  Factors factors_;
  /// The sum of the functions at the nodes times their weights.
  std::vector<double> share_;
  std::vector<double> double_values_;
  std::vector<double> single_values_;
  std::vector<double> integrands_;
  std::vector<double> moments_;
  std::vector<double> partial_sums_;
};

}  // namespace isorim::solver
