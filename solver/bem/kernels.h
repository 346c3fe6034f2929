#pragma once

#include <array>
#include <span>

#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"

/// Fundamental solutions. With x the target, y on the boundary, d = y - x, r = |d| and n the outward normal at y:
/// U(x, y) is the response at y to a unit source (force) at x, T its flux (traction) on the surface with normal n.
///
/// For an interior problem, x on the boundary or inside (the constants removed, so that no free term is needed):
///   int T (u(y) - u(x)) dS = int U t dS + int_Omega U b dOmega
/// with t = k du/dn (Laplace) or the traction; for an exterior one, n still out of the body,
///   u(x) - int T (u(y) - u(x)) dS = - int U t dS + int_Omega U b dOmega.
namespace isorim::solver {

/// -k lap u = f. U = 1 / (4 pi k r) in space, -ln(r / length) / (2 pi k) in the plane.
template <int Dim>
struct Laplace {
  static constexpr int dimension = Dim;
  static constexpr int components = 1;
  double conductivity = 1.0;
  /// The logarithm's unit of length; larger than the boundary, so that the single layer stays positive (no degenerate
  /// scale). Without meaning in space.
  double length = 1.0;
};

/// Kelvin's solution, U_ij. In the plane that of plane strain; plane stress by nu -> nu / (1 + nu) with the same shear
/// modulus.
template <int Dim>
struct Elasticity {
  static constexpr int dimension = Dim;
  static constexpr int components = Dim;
  double shear_modulus = 1.0;
  double poisson = 0.3;
  /// As for Laplace.
  double length = 1.0;
};

/// U(x, y) at every node: entry (i, j) (component i at the target, j at the node) of node q in
/// values[(i * C + j) * n + q], n the number of nodes, C the components. Weights are not included.
template <class Kernel>
void single_layer(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                  const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values);
/// T(x, y), stored in the same way.
template <class Kernel>
void double_layer(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                  const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values);

/// The derivatives of U_ij and T_ij by the target's coordinate k, for gradients at interior points:
/// values[((k * C + i) * C + j) * n + q].
template <class Kernel>
void single_layer_gradient(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                           const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values);
template <class Kernel>
void double_layer_gradient(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                           const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values);

}  // namespace isorim::solver
