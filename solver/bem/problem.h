#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "solver/bem/domain_load.h"
#include "solver/bem/field_space.h"
#include "solver/bem/kernels.h"

namespace isorim::solver {

/// What a plane problem of elasticity means across the plane: no strain, or no stress.
enum class PlaneState { strain, stress };

/// What is solved. Poisson's equation is Laplace's with a load.
template <int Dim>
using Equation = std::variant<Laplace<Dim>, Elasticity<Dim>>;

enum class ConditionKind {
  /// u = value (potential, displacement).
  value,
  /// t = value: k du/dn or the traction, n out of the body, in exterior problems too.
  flux,
  /// t = coefficient (reference - u): convection, elastic foundation. `value` is the reference. In exterior problems
  /// t = coefficient (u - reference): it is always the flux or force into the domain that is coefficient (reference -
  /// u).
  robin,
};

/// The condition for one component of the unknown.
template <int Dim>
struct ComponentCondition {
  ConditionKind kind = ConditionKind::flux;
  /// A function of place and outward normal; empty: zero.
  quadrature::IntegrandFactory<Dim> value;
  /// Of robin; positive.
  quadrature::IntegrandFactory<Dim> coefficient;
};

/// What holds on a part of the boundary.
template <int Dim>
struct Condition {
  /// What messages call it.
  std::string name;
  /// One for a potential, Dim for a displacement.
  std::vector<ComponentCondition<Dim>> components;
  /// Rows: the unit axes that the components refer to (a symmetry plane: its normal and two tangents); absent: x, y, z.
  std::optional<Eigen::Matrix<double, Dim, Dim>> frame;
};

/// A boundary-value problem on the elements of a FieldSpace.
template <int Dim>
struct Problem {
  Equation<Dim> equation;
  /// Dim = 2, elasticity: decides on the stress across the plane alone, see Elasticity.
  PlaneState plane_state = PlaneState::strain;
  /// The domain is what lies outside the boundary, up to infinity, where the solution vanishes (in the plane: is
  /// bounded).
  bool exterior = false;
  std::vector<Condition<Dim>> conditions;
  /// Index into conditions for every element.
  std::vector<std::int32_t> condition_of;
  /// Sources or body forces; their sum acts.
  Loads<Dim> loads;
};

/// 1 for a potential, Dim for a displacement.
template <int Dim>
int component_count(const Equation<Dim>& equation);

/// The axis of a component in x, y, z; the number 1 in the first place for a potential.
template <int Dim>
geometry::Vector<Dim> component_axis(const Condition<Dim>& condition, int component) {
  if (condition.frame) return condition.frame->row(component).transpose();
  return geometry::Vector<Dim>::Unit(component);
}

/// A unit of length for the logarithm in the plane's fundamental solutions: the diagonal of the boundary's bounding
/// box. The equation and the loads have to be given the same one. Any other length above the radius of a circle around
/// the boundary would do as well: there is no degenerate scale then (the single layer is positive on constants too).
template <int Dim>
double logarithm_length(const geometry::ElementTable<Dim>& table);

/// Throws InputError, naming condition, component or element and what was expected, for: no conditions, or not one for
/// every element; a wrong number of components; a frame that is not orthonormal; robin without a coefficient; a
/// coefficient that nothing uses; material constants out of range (conductivity, shear modulus, Poisson's ratio in
/// (-1, 1/2)); a logarithm's length below half the diagonal of the bounding box; loads in an exterior problem; a
/// function of the space that lives under two conditions.
template <int Dim>
void check_problem(const Problem<Dim>& problem, const FieldSpace<Dim>& space);

}  // namespace isorim::solver
