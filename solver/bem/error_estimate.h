#pragma once

#include <span>
#include <vector>

#include "solver/bem/evaluation.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"

/// How wrong a solution is, element by element.
namespace isorim::solver {

/// An indicator for every element: with r the residual of the integral equation (kernels.h), which collocation makes
/// zero at the collocation points alone,
///
///   eta_e^2 = (1 / h_e) int_e |r|^2 dS,
///
/// h_e the element's size. The residual of the exact flux or traction vanishes; r maps from its errors in H^(-1/2) to
/// H^(1/2) (from those of the potential in H^(1/2) to the same), and the weighted norm is that of H^(1/2) for functions
/// that oscillate on the scale of the elements (C. Carstensen & E. P. Stephan, Math. Comp. 64 (1995) 483-500, with
/// h |r'|^2 in place of |r|^2 / h). In units of the potential times length^((Dim - 2) / 2), so indicators of one
/// solution compare with one another. Sampled at Gauss points, one or two more in each direction than collocation has.
template <int Dim>
std::vector<double> error_indicators(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                     const Solution<Dim>& solution, const EvaluationOptions& options = {});

/// The root of the sum of the squares.
double total_indicator(std::span<const double> indicators);

/// The smallest set of elements whose squares sum up to at least `share` (0 to 1) of all, largest first (W. Doerfler,
/// SIAM J. Numer. Anal. 33 (1996) 1106-1124). Elements whose indicators are equal to a relative 1e-6 of the last one
/// are taken along, so that symmetric problems stay symmetric.
std::vector<int> mark_elements(std::span<const double> indicators, double share);

/// How large a solution is in the norm of the indicators: with L the diagonal of the boundary's box and k the
/// conductivity or shear modulus, the root of
///
///   (1 / L) int |u|^2 dS + (int |t / k| dS)^2 / L^(Dim - 2).
///
/// The flux enters with its first power since that of a singular solution need not have a square integral.
template <int Dim>
double solution_size(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
                     const EvaluationOptions& options = {});

}  // namespace isorim::solver
