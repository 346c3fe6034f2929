#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "geometry/boundary.h"
#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"
#include "solver/bem/edge_grading.h"
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
  /// Of the functions, 1 to DiscretisationOptions::max_degree.
  int degree = 3;
  /// Uniform bisections of every knot span, at least one: without the last one the errors are estimated.
  int refine = 1;
  /// Thin elements along the edges of the body. With none the error falls like h, whatever the degree.
  EdgeGrading edges = {};
  SolveOptions solve = {};
  /// About which the body turns.
  geometry::Point3 centre = geometry::Point3::Zero();
};

struct AddedMass {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  /// For density 1: the fluid's kinetic energy is v^T M v / 2 with v = (velocity of the centre; angular velocity).
  /// Symmetric: the mean of what was computed and its transpose.
  Matrix matrix = Matrix::Zero();
  /// Estimates of the absolute errors: by how much the last bisection has changed the matrix, and how far that was from
  /// symmetric. Whatever is left, at the edges or elsewhere, falls by a factor of more than two with a bisection; so
  /// these are larger than the errors, for smooth bodies by far.
  Matrix error = Matrix::Zero();
  /// Of the fluid that the body displaces, for density 1: its inertia about the centre.
  double volume = 0.0;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  std::size_t unknowns = 0;
  /// "dense" or "compressed".
  std::string method;

  /// The diagonal of the matrix over the displaced mass, and over its moments of inertia (0 where these vanish).
  Eigen::Matrix<double, 6, 1> coefficients() const;
};

/// In an unbounded fluid without circulation: potentials phi_k that vanish far away with dphi_k / dn = n_k, and
/// ((x - centre) x n)_k for turning, give M_jk = - int phi_j dphi_k / dn dS (Lamb, Hydrodynamics, articles 118 to 121).
/// By boundary elements, assembled and factored once for the six motions, and once more for the error estimate; the
/// boundary is closed (orient()). Voids in the solid are sealed: the fluid does not know them, and they displace it as
/// the solid does. Errors as those of field_space(), graded_to_edges() and solve(), and InputError for no bisection.
AddedMass added_mass(const geometry::OrientedBoundary<3>& solid, const AddedMassOptions& options);

}  // namespace isorim::solver
