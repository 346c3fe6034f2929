#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"

namespace isorim::solver {

enum class SolveMethod {
  /// dense up to automatic_limit unknowns (twice that in elasticity), compressed above.
  automatic,
  dense,
  compressed,
};

struct SolveOptions {
  /// Scalar unknowns of potentials, twice as many of displacements. In space compressed matrices take less time than
  /// dense ones from 2500 (5000) on with a tolerance of 1e-6, and less memory long before (pictures/bem_scaling.csv);
  /// with 1e-10 from 3000 (7000) on.
  static constexpr int automatic_limit = 4000;
  SolveMethod method = SolveMethod::automatic;
  /// Relative: of the compression, of the iterations, and what the quadrature aims at.
  double tolerance = 1e-10;
  /// 0: all that OpenMP offers.
  int threads = 0;
  int max_iterations = 500;
  std::function<void(double)> progress;
};

/// What the solve found. Components are those of the condition's frame turned back to x, y, z.
template <int Dim>
struct Solution {
  /// function_count x components: coefficients of the potential or displacement, and of the flux or traction. Where a
  /// value is prescribed the coefficients interpolate it at the collocation points (for pictures); integrals use the
  /// prescribed function itself.
  Eigen::MatrixXd potential;
  Eigen::MatrixXd flux;
  /// What the field tends to far from the body, one number a component: an unknown of exterior problems in the plane.
  /// Zero where it is known to vanish (in space, or if nothing fixes it).
  Eigen::VectorXd at_infinity;

  std::size_t unknowns = 0;
  /// "dense" or "compressed".
  std::string method;
  /// 0 for a direct solve.
  int iterations = 0;
  /// |A x - b| / |b|.
  double residual = 0.0;
  /// Bytes of the largest matrix.
  std::size_t matrix_memory = 0;
  /// What the user should know: a null space that was fixed, ...
  std::vector<std::string> messages;
};

/// Collocation with the constants (rigid translations) removed, see kernels.h. Throws InputError for an ill-posed set
/// of conditions (loads out of balance where the body can move freely, with the imbalance), NumericalError for a
/// singular system or iterations that do not converge.
template <int Dim>
Solution<Dim> solve(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const SolveOptions& options);

/// Problems that differ in what is given alone (values, fluxes, references, loads): the equations are integrated and
/// factored once. Same equation, domain, kinds of conditions and frames, and the same Robin coefficients (which cannot
/// be compared: those of the first count). Errors as those of solve(), and InputError, naming the problem, if they
/// differ in more.
template <int Dim>
std::vector<Solution<Dim>> solve_all(std::span<const Problem<Dim>> problems, const FieldSpace<Dim>& space,
                                     const SolveOptions& options);

}  // namespace isorim::solver
