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
  /// t = coefficient (reference - u): convection, elastic foundation. `value` is the reference.
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

}  // namespace isorim::solver
