#pragma once

#include <span>

#include "geometry/bezier/element_table.h"
#include "geometry/trimming/trimmed_surface.h"
#include "solver/bem/patch_space.h"
#include "solver/bem/tensor_space.h"

namespace isorim::solver {

/// The space on the kept part of a surface.
///
/// whole: the functions of the whole refined surface. face: the refined surface with its loops; kept: its elements, as
/// bezier_elements() gives them. A function keeps a coefficient of its own if enough of it is seen and it can be told
/// from the others; a cell all of whose functions do is sound. The other functions are extensions (extension.h) from
/// the nearest sound cell between the same jumps. So the functions' values at the collocation points stay well
/// conditioned whatever slivers a trim leaves of cells, and the order of approximation is kept. In a part between jumps
/// without a sound cell of which much is kept, elements have functions of their own, fitted to what is kept of each.
///
/// Points of the tensor-product space that are kept, well off the trims, are kept; the other functions get points by
/// choose_points(). Fields are continuous across cuts and gaps thinner than the functions' supports: refine there.
PatchSpace<3> trimmed_space(const TensorSpace<3>& whole, const geometry::TrimmedSurface& face,
                            std::span<const geometry::BezierElement<3>> kept,
                            std::span<const geometry::TrimmedRegion> regions);

}  // namespace isorim::solver
