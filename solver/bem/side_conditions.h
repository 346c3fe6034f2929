#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "quadrature/target_rules.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/rigid_motion.h"

/// What makes collocation's equations uniquely solvable where the conditions on the boundary alone do not.
///
/// Interior problems: motions r_k that the conditions leave free (a constant, rigid motions) need loads in balance, and
/// are fixed by int u . r_k dS = 0. The unknown that goes with it is the factor of an additional flux r_k over the
/// whole boundary, which takes up what quadrature leaves of an imbalance; without one it is zero.
///
/// Exterior problems in the plane: a field that stays bounded tends to a constant c,
///   u(x) - int T (u(y) - u(x)) dS + int U t dS - c = 0,
/// and has no net flux, int t dS = 0: one more unknown and equation for each direction in which the conditions hold the
/// body. In the others nothing fixes the constant; it is zero, and the given fluxes must be in balance.
namespace isorim::solver {

/// Square systems grow by rows.size() unknowns.
template <int Dim>
struct SideConditions {
  /// Free motions of interior problems: columns are int U r_k dS (see AssemblyRoom::modes).
  std::vector<RigidMotion<Dim>> flux_modes;
  /// Directions of the constants of exterior problems in the plane: columns -direction at every collocation point.
  std::vector<geometry::Vector<Dim>> constants;
  /// count x size of the system without them, and the right sides, a column for each problem.
  Eigen::MatrixXd rows;
  Eigen::MatrixXd right;
  std::vector<std::string> messages;

  std::size_t count() const { return flux_modes.size() + constants.size(); }
};

/// Finds them. Throws InputError, with the sum and what to do, if given fluxes and loads are out of balance by more
/// than 1e-6 of their absolute sum where they must be in balance.
template <int Dim>
SideConditions<Dim> side_conditions(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const quadrature::TargetRules<Dim>& rules, double flux_scale, int threads);

}  // namespace isorim::solver
