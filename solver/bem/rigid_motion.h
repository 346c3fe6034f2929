#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"

namespace isorim::solver {

/// A displacement without strain, or a constant potential (in row 0 alone):
/// r(y) = translation + spin (y - centre), spin skew.
template <int Dim>
struct RigidMotion {
  geometry::Vector<Dim> translation = geometry::Vector<Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim> spin = Eigen::Matrix<double, Dim, Dim>::Zero();
  geometry::Point<Dim> centre = geometry::Point<Dim>::Zero();
  /// The body that moves (FieldSpace::body_of()); -1: all of them as one.
  std::int32_t body = -1;

  bool moves(std::int32_t other) const { return body < 0 || body == other; }
  geometry::Vector<Dim> operator()(const geometry::Point<Dim>& y) const { return translation + spin * (y - centre); }
};

/// The motions that the conditions leave free, body by body: constants for a potential, rigid motions for a
/// displacement (only translations of all bodies together if the domain is unbounded: it is connected, and turning is
/// not bounded). Orthonormal in a sense that makes all of them of the size of one over the boundary. A component that
/// is prescribed, or tied by Robin's condition, anywhere takes away what moves there. Found from the singular values of
/// the constrained components of all motions at the collocation points; those below 1e-8 of the largest are zero.
template <int Dim>
std::vector<RigidMotion<Dim>> free_motions(const Problem<Dim>& problem, const FieldSpace<Dim>& space);

/// "the constant", "translation along (1, 0, 0)", "rotation about (0, 0, 1)", or "rigid motion".
template <int Dim>
std::string describe(const RigidMotion<Dim>& motion, int components);

}  // namespace isorim::solver
