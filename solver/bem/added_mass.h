#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/boundary.h"
#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"
#include "solver/bem/field_space.h"
#include "solver/bem/solve.h"

/// The inertia of the ideal fluid around a moving body.
namespace isorim::solver {

/// The boundary of a body under the level plane z = height together with its mirror image in it: how a hull moves in a
/// fluid whose surface stays level (surge, sway, yaw), and how its lower half does where the surface is one of constant
/// potential (heave, roll, pitch). Patches of the image are called "NAME_image". What lies in the plane is left out, so
/// both halves meet along the waterline. Throws GeometryError if nothing lies under the plane.
geometry::Boundary<3> double_body(const geometry::Boundary<3>& solid, double height);

struct AddedMassOptions {
  DiscretisationOptions<3> discretisation = {};
  SolveOptions solve = {};
  /// About which the body turns.
  geometry::Point3 centre = geometry::Point3::Zero();
};

struct AddedMass {
  /// For density 1: the fluid's kinetic energy is v^T M v / 2 with v = (velocity of the centre; angular velocity).
  /// Symmetric: the mean of what was computed and its transpose.
  Eigen::Matrix<double, 6, 6> matrix;
  /// Of the solutions: the largest |M_ij - M_ji| / 2, which only the discretisation makes differ from zero.
  double asymmetry = 0.0;
  std::size_t unknowns = 0;
  std::vector<std::string> messages;
};

/// In an unbounded fluid without circulation: potentials phi_k that vanish far away with dphi_k / dn = n_k, and
/// ((x - centre) x n)_k for turning, give M_jk = - int phi_j dphi_k / dn dS (Lamb, Hydrodynamics, articles 118 to 121).
/// By boundary elements; the boundary is closed (orient()). Errors as those of field_space() and solve().
AddedMass added_mass(const geometry::OrientedBoundary<3>& boundary, const AddedMassOptions& options);

}  // namespace isorim::solver
