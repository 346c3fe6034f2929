#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
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
/// by flux_scale() where u is. Known data enter through their values at the quadrature nodes.
namespace isorim::solver {

/// What one thread needs, and what it has summed for one target.
template <int Dim>
struct AssemblyRoom {
  explicit AssemblyRoom(const Problem<Dim>& problem) : data(problem) {}

  /// int T_ij dS, entry (i, j), over the elements since start_target().
  Eigen::Matrix<double, Dim, Dim> double_layer;
  /// What known data give to the right side.
  Eigen::Matrix<double, Dim, 1> right;
  /// Column m: -s int U r_m dS, r_m the flux modes.
  Eigen::Matrix<double, Dim, Eigen::Dynamic> modes;
  /// Of the last element: the coefficient of its function a and component c in equation i stands at
  /// [(i C + c) count + a].
  std::vector<double> block;

  quadrature::NodeBuffer<Dim> buffer;
  BoundaryData<Dim> data;
  NodeBasis<Dim> basis;
  ConditionValues<Dim> values;
  MomentScratch scratch;
  std::vector<double> single_values;
  std::vector<double> double_values;
  std::vector<double> integrands;
  std::vector<double> along;
  std::vector<double> product;
  /// Pointers into the Assembler's store, element by element and rule by rule.
  std::vector<std::vector<const void*>> kept;
};

/// Integrates the equations of one target, element by element. Safe to use from several threads with different rooms;
/// the numbers do not depend on what a room was used for before.
template <int Dim>
class Assembler {
 public:
  /// The arguments must outlive the object. `flux_modes`: see AssemblyRoom::modes.
  Assembler(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const quadrature::TargetRules<Dim>& rules,
            std::vector<RigidMotion<Dim>> flux_modes);

  int components() const { return components_; }
  int size() const { return components_ * space_->function_count(); }
  /// Unknown fluxes are stored divided by this (conductivity or shear modulus by the diagonal of the bounding box), so
  /// that the matrix does not depend on units.
  double flux_scale() const { return flux_scale_; }
  double sign() const { return problem_->exterior ? -1.0 : 1.0; }
  const Problem<Dim>& problem() const { return *problem_; }
  const FieldSpace<Dim>& space() const { return *space_; }
  const quadrature::TargetRules<Dim>& rules() const { return *rules_; }
  const std::vector<RigidMotion<Dim>>& flux_modes() const { return flux_modes_; }

  const Condition<Dim>& condition_on(int element) const {
    return problem_->conditions[static_cast<std::size_t>(problem_->condition_of[static_cast<std::size_t>(element)])];
  }
  bool is_flux_unknown(int element, int component) const {
    return condition_on(element).components[static_cast<std::size_t>(component)].kind == ConditionKind::value;
  }

  /// Sets the sums of a room to zero.
  void start_target(AssemblyRoom<Dim>& room) const;
  /// Adds an element to the sums; sets room.block.
  void add_element(const quadrature::Target<Dim>& target, int element, AssemblyRoom<Dim>& room) const;
  /// Adds an element to the sums alone.
  void add_element_sums(const quadrature::Target<Dim>& target, int element, AssemblyRoom<Dim>& room) const;
  /// With all elements added: the terms in u(x). Adds to the right side, and sets room.block to the coefficients of the
  /// functions on the point's own element.
  void add_target_terms(int point, AssemblyRoom<Dim>& room) const;

  quadrature::Target<Dim> target(int point) const;

  /// What goes with an element's nodes: kept for kept rules, else in the room until the next call.
  struct NodeData {
    const NodeBasis<Dim>* basis;
    const ConditionValues<Dim>* values;
  };
  NodeData node_data(int element, const quadrature::NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const;

  /// What the loads give to the right side: components x collocation points.
  Eigen::MatrixXd load_potentials(double tolerance, int threads) const;

 private:
  /// Kept with an element's rule.
  struct KeptNodes {
    NodeBasis<Dim> basis;
    ConditionValues<Dim> values;
  };
  const KeptNodes* kept_nodes(int element, const quadrature::NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const;
  /// Kernels times weights; the single layer is left out where nothing needs it.
  void weigh_kernels(const quadrature::Target<Dim>& target, int element, const quadrature::NodeView<Dim>& nodes,
                     AssemblyRoom<Dim>& room) const;
  void add_sums(int element, const quadrature::NodeView<Dim>& nodes, const ConditionValues<Dim>& values,
                AssemblyRoom<Dim>& room) const;
  void fill_integrands(int element, std::size_t count, const ConditionValues<Dim>& values,
                       AssemblyRoom<Dim>& room) const;

  const Problem<Dim>* problem_;
  const FieldSpace<Dim>* space_;
  const quadrature::TargetRules<Dim>* rules_;
  std::vector<RigidMotion<Dim>> flux_modes_;
  int components_;
  double flux_scale_;
  mutable std::mutex store_mutex_;
  mutable std::vector<std::unordered_map<int, std::unique_ptr<KeptNodes>>> store_;
};

}  // namespace isorim::solver
