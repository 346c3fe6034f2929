#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "io/analysis/boundary_value_problem.h"
#include "io/results/analysis_report.h"
#include "io/results/compute.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/solve.h"

namespace isorim::io {

/// An analysis after its solution: what writers of fields need.
template <int Dim>
struct Analysis {
  BoundaryValueProblem<Dim> setting;
  solver::Solution<Dim> solution;
  AnalysisReport report;
  /// Integrals over the boundary that name the solution.
  std::vector<Quantity> integrals;
};

/// Builds, solves and evaluates. Throws InputError for what is wrong with the problem, NumericalError for a system that
/// is singular or iterations that do not converge.
template <int Dim>
Analysis<Dim> analyse(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary, const RunOptions& options);

/// The stress tensor, in the plane with the stress across it.
template <int Dim>
Eigen::Matrix3d full_stress(const solver::FieldValue<Dim>& field) {
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  stress.topLeftCorner<Dim, Dim>() = field.stress;
  if constexpr (Dim == 2) stress(2, 2) = field.stress_across;
  return stress;
}

/// Of a boundary in the plane or in space.
struct AnyAnalysis {
  std::variant<Analysis<2>, Analysis<3>> known;
};

/// What [expect] may name of an analysis: analysis_quantities().
std::vector<Quantity> expected_quantities(const AnalysisReport& report);

}  // namespace isorim::io
