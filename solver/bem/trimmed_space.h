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
/// bezier_elements() gives them. A function keeps a coefficient of its own if it lives on a sound cell, one of which
/// most is kept; the others are extensions of these (extension.h), from the nearest sound cell between the same jumps.
/// So the functions' values at the collocation points stay well conditioned whatever slivers a trim leaves of cells,
/// and the order of approximation is kept. A part between jumps that holds no sound cell makes one of its largest.
///
/// Points of the tensor-product space that are kept, well off the trims, are kept; the other functions get points by
/// choose_points(). Fields are continuous across cuts and gaps thinner than the functions' supports: refine there.
PatchSpace<3> trimmed_space(const TensorSpace<3>& whole, const geometry::TrimmedSurface& face,
                            std::span<const geometry::BezierElement<3>> kept,
                            std::span<const geometry::TrimmedRegion> regions);

}  // namespace isorim::solver
