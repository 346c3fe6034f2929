#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/surface.h"
#include "geometry/topology/orientation.h"
#include "io/case/shape_keys.h"

/// From the keys that take parts of surfaces and solids away to what is left. Every function throws InputError that
/// begins with file, line and key.
namespace isorim::io {

/// The part of a surface that the loops keep; the whole surface without loops. Loops nest: what is outermost bounds
/// what is kept, unless it has the role of a hole; then the surface's domain does. `where`: of the key "trims".
geometry::SurfaceShape trimmed(const geometry::NurbsSurface<3>& surface, const std::vector<LoopKeys>& trims,
                               const KeyPlace& where);

/// What the tools leave of a solid, one after the other, oriented. The solid need not be oriented but must be closed,
/// as `options` judge it.
geometry::Boundary<3> clipped(const geometry::Boundary<3>& solid, const OneOrMany<ClipKeys>& tools,
                              const KeyPlace& where, const geometry::OrientationOptions& options = {});

}  // namespace isorim::io
