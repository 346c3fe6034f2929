#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/analysis/boundary_value_problem.h"
#include "io/results/analysis_report.h"
#include "solver/bem/solve.h"

namespace isorim::io {

/// Before a solution is sought: throws InputError, naming key and place, where the exact fields are not finite.
template <int Dim>
void check_exact(const CaseFile& file, const solver::FieldSpace<Dim>& space);

/// Errors against [exact], each divided by the largest magnitude of the exact field (for L2 errors its norm) where
/// that is not zero:
///
///   boundary_l2, boundary_max                    potential or displacement on the boundary
///   flux_l2, flux_max                            flux or traction on the boundary
///   probe_max, probe_gradient_max, probe_stress_max     at the points of all probes inside the domain
///   grid_max                                     potential or displacement at those of all grids
///
/// Maxima are over many points of each element. What the conditions leave free (the constant, rigid motions) is fitted
/// to the exact solution on the boundary and taken off first. Throws InputError as check_exact() does.
template <int Dim>
std::vector<std::pair<std::string, double>> solution_errors(const CaseFile& file,
                                                            const BoundaryValueProblem<Dim>& setting,
                                                            const solver::Solution<Dim>& solution,
                                                            const AnalysisReport& report);

}  // namespace isorim::io
