#pragma once

#include <vector>

#include "io/analysis/boundary_value_problem.h"
#include "io/results/analysis_report.h"
#include "solver/bem/solve.h"

/// The solution at the points that a case asks for.
namespace isorim::io {

/// One for each [[probe]]. Throws InputError for a file of points that cannot be read.
template <int Dim>
std::vector<FieldSamples> sample_probes(const CaseFile& file, const BoundaryValueProblem<Dim>& setting,
                                        const solver::Solution<Dim>& solution, int threads);

/// One for each [[grid]].
template <int Dim>
std::vector<FieldSamples> sample_grids(const CaseFile& file, const BoundaryValueProblem<Dim>& setting,
                                       const solver::Solution<Dim>& solution, int threads);

}  // namespace isorim::io
