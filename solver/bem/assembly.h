#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"
#include "solver/bem/basis_moments.h"
#include "solver/bem/boundary_data.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/rigid_motion.h"

/// The equations of collocation. With s = 1 for an interior and -1 for an exterior problem, at a target x
///
///   [exterior: u(x)] + s int T (u(y) - u(x)) dS - s int U t dS = int_Omega U b dOmega.
///
/// The unknown (a, c) of function a and component c (of the frame of the condition under which a lives) stands in
/// column a C + c, C the number of components: a coefficient of u where t or Robin's condition is given, of t divided
/// by flux_scale() where u is. Known data enter through their values at the quadrature nodes. Problems that differ in
/// known data alone have right sides of their own and all else in common.
namespace isorim::solver {

/// One thread's room for what goes with nodes.
template <int Dim>
struct AssemblyRoom {
  explicit AssemblyRoom(std::span<const Problem<Dim>> problems)
      : data(problems.begin(), problems.end()), values(problems.size()) {}

  quadrature::NodeBuffer<Dim> buffer;
  /// Of each problem.
  std::vector<BoundaryData<Dim>> data;
  NodeBasis<Dim> basis;
  std::vector<ConditionValues<Dim>> values;
  MomentScratch scratch;
};

/// What the equations consist of; RowIntegrator (equation_rows.h) sums them. Safe to use from several threads with
/// different rooms; the numbers do not depend on what a room was used for before.
template <int Dim>
class Assembler {
 public:
  /// The arguments must outlive the object. `flux_modes`: see EquationRows::sums.
  Assembler(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const quadrature::TargetRules<Dim>& rules,
            std::vector<RigidMotion<Dim>> flux_modes)
      : Assembler(std::span(&problem, 1), space, rules, std::move(flux_modes)) {}
  /// Of problems that differ in known data alone (see solve_all()), at least one.
  Assembler(std::span<const Problem<Dim>> problems, const FieldSpace<Dim>& space,
            const quadrature::TargetRules<Dim>& rules, std::vector<RigidMotion<Dim>> flux_modes);

  int components() const { return components_; }
  int size() const { return components_ * space_->function_count(); }
  /// Unknown fluxes are stored divided by this (conductivity or shear modulus by the diagonal of the bounding box), so
  /// that the matrix does not depend on units.
  double flux_scale() const { return flux_scale_; }
  /// Conductivity or shear modulus.
  double stiffness() const { return stiffness_; }
  double sign() const { return problem().exterior ? -1.0 : 1.0; }
  /// The first; what it says of known data holds for it alone.
  const Problem<Dim>& problem() const { return problems_.front(); }
  std::span<const Problem<Dim>> problems() const { return problems_; }
  /// How many problems there are.
  int right_sides() const { return static_cast<int>(problems_.size()); }
  const FieldSpace<Dim>& space() const { return *space_; }
  const quadrature::TargetRules<Dim>& rules() const { return *rules_; }
  const std::vector<RigidMotion<Dim>>& flux_modes() const { return flux_modes_; }

  const Condition<Dim>& condition_on(int element) const {
    return problem().conditions[static_cast<std::size_t>(problem().condition_of[static_cast<std::size_t>(element)])];
  }
  bool is_flux_unknown(int element, int component) const {
    return condition_on(element).components[static_cast<std::size_t>(component)].kind == ConditionKind::value;
  }

  /// Whether the equations contain int U ... dS over the element: for unknown or given fluxes, or flux modes.
  bool needs_single_layer(int element) const;
  /// The elements on which a function lives, increasing.
  std::span<const std::int32_t> elements_of(std::int32_t function) const {
    const auto a = static_cast<std::size_t>(function);
    return {elements_.data() + first_element_[a], first_element_[a + 1] - first_element_[a]};
  }

  /// The terms in u(x) of a point's equations, given int T dS over the whole boundary.
  struct TargetTerms {
    /// To be added to the right sides, a column for each.
    Eigen::Matrix<double, Dim, Eigen::Dynamic> right;
    /// Entry (i, a * components() + c): to be added to the coefficient of component c of the a-th function on the
    /// point's element in equation i.
    Eigen::MatrixXd coefficients;
  };
  TargetTerms target_terms(int point, const Eigen::Matrix<double, Dim, Dim>& double_layer,
                           AssemblyRoom<Dim>& room) const;

  quadrature::Target<Dim> target(int point) const;

  /// What goes with an element's nodes: kept for kept rules, else in the room until the next call.
  struct NodeData {
    const NodeBasis<Dim>* basis;
    /// Of each problem.
    std::span<const ConditionValues<Dim>> values;
  };
  NodeData node_data(int element, const quadrature::NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const;

  /// What the loads give to the right sides: in each column the components of each collocation point.
  Eigen::MatrixXd load_potentials(double tolerance, int threads) const;

 private:
  /// Kept with an element's rule.
  struct KeptNodes {
    NodeBasis<Dim> basis;
    std::vector<ConditionValues<Dim>> values;
  };
  const KeptNodes& kept_nodes(int element, const quadrature::NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const;
  void list_elements();
  /// What the conditions on an element prescribe at its nodes, in every problem.
  void evaluate_data(int element, const quadrature::NodeView<Dim>& nodes, AssemblyRoom<Dim>& room,
                     std::vector<ConditionValues<Dim>>& values) const;

  std::span<const Problem<Dim>> problems_;
  const FieldSpace<Dim>* space_;
  const quadrature::TargetRules<Dim>* rules_;
  std::vector<RigidMotion<Dim>> flux_modes_;
  int components_;
  double stiffness_;
  double flux_scale_;
  /// Those of function a: elements_[first_element_[a]], ...
  std::vector<std::int32_t> elements_;
  std::vector<std::size_t> first_element_;
  /// Of each element, by NodeView::kept; guarded by one of the mutexes.
  struct KeptRule {
    int number;
    std::unique_ptr<const KeptNodes> nodes;
  };
  mutable std::array<std::mutex, 64> store_mutexes_;
  mutable std::vector<std::vector<KeptRule>> store_;
};

}  // namespace isorim::solver
