#pragma once

#include <optional>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/intersection/implicit_surface.h"
#include "geometry/intersection/implicit_trace.h"
#include "geometry/nurbs/curve.h"

namespace isorim::geometry {

/// What is left of a face on the side where F is negative.
struct ClippedFace {
  /// The face as it was if nothing is cut off; nothing if nothing is left.
  std::optional<SurfaceShape> shape;
  /// The edges of what is left along which F vanishes, in the surface's parameters, what is left on their left.
  std::vector<NurbsCurve<2>> cuts;
  /// Something is cut off or left out.
  bool is_reduced = false;
  /// F vanishes on a part of the face of positive area. That part is left out.
  bool lies_on_tool = false;
};

/// Cuts a whole or trimmed face. Its loops are divided where F changes its sign along them (or, where they run along
/// F = 0, where the sign beside them changes) and the parts with F < 0 chained with the traced curves inside the face.
///
/// Throws GeometryError, with the parameters, for singular points (ImplicitTrace) and where the pieces do not chain.
ClippedFace clip_face(const SurfaceShape& face, const ImplicitSurface& implicit, const TraceOptions& options = {});

}  // namespace isorim::geometry
