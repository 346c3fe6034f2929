#pragma once

#include <filesystem>

#include "geometry/boundary.h"
#include "io/analysis/analysis.h"
#include "io/results/compute.h"

/// What ParaView shows of an analysis. Vectors have three components in the plane as well, so that glyphs and warping
/// take them; stress is xx, yy, zz, xy, yz, xz, as VTK orders symmetric tensors.
namespace isorim::io {

/// solution.vtu: potential and flux, or displacement and traction, on exact rational Bézier cells; see
/// solution_cells.h. Point data are control values, not values at the control points. Cell data: `condition`.
void write_solution_vtu(const std::filesystem::path& path, const AnyModel& model, const AnyAnalysis& analysis);

/// fields.vtu: flat facets with everything that the solution says at their vertices: also gradient, and in elasticity
/// stress, von Mises's stress and the principal stresses. Values differ where elements meet if the fields do.
void write_fields_vtu(const std::filesystem::path& path, const AnyAnalysis& analysis, int threads);

/// Every probe as probe_NAME.vtp and probe_NAME.csv (17 digits), every grid as grid_NAME.vti, points outside the domain
/// blanked.
void write_samples(const std::filesystem::path& folder, const AnalysisReport& report);

}  // namespace isorim::io
