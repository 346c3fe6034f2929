#pragma once

#include "io/analysis/analysis.h"
#include "io/analysis/boundary_value_problem.h"

namespace isorim::io {

/// Solves with [discretisation] adapt: fills in setting, solution and the report's history.
template <int Dim>
void solve_with_refinement(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary, const RunOptions& run,
                           const solver::SolveOptions& options, Analysis<Dim>& analysis);

}  // namespace isorim::io
