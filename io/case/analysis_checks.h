#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "io/case/case_file.h"

/// The rules between the sections of an analysis.
namespace isorim::io {

/// 1 for a potential, `dim` for a displacement.
int component_count(const CaseKeys& keys, int dim);

/// The section's key "adapt", if it asks for refinement; else null.
const AdaptKeys* adapt_keys(const CaseKeys& keys);

/// What results call condition `index`: its name, else the patch that it is for or "all", else "condition_N" (N from
/// 1).
std::string condition_name(const CaseKeys& keys, std::size_t index);

/// x, y[, z], the normal nx, ny[, nz], and the solution on the boundary: u and the flux q of a potential; ux, uy[, uz]
/// and the traction tx, ty[, tz] in elasticity. What an integrand over the boundary of an analysis may name.
std::vector<std::string> result_names(EquationKind equation, int dim);

/// The integrand names the solution.
bool is_result_integral(const CaseFile& file, const IntegralKeys& integral, int dim);

/// A quantity that [expect] may name, and the rows and columns of its value; -1 rows: as many as the file has points.
struct AnalysisQuantity {
  std::string name;
  int rows = 1;
  int columns = 1;
};
std::vector<AnalysisQuantity> analysis_quantities(const CaseKeys& keys, int dim);

/// Complains of whatever the analysis's sections say that does not go together. `patches`: the names of the shape's.
void check_analysis(const CaseFile& file, int dim, const std::vector<std::string>& patches, Complaints& complaints);

/// Fills CaseFile::definitions with those of the section that are sound, and complains of the others.
void check_definitions(CaseFile& file, int dim, Complaints& complaints);

}  // namespace isorim::io
