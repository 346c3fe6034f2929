#pragma once

#include <string>
#include <variant>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/intersection/implicit_surface.h"
#include "geometry/vocabulary.h"

/// Solids cut by planes and round tools: what is left, closed by the tool's own faces. What a plane and a boundary have
/// in common is in plane_section.h.
namespace isorim::geometry {

/// Which side of a round tool is kept.
enum class KeptSide { inside, outside };

/// What lies on the side to which the normal points is cut away.
struct PlaneTool {
  Point3 point = Point3::Zero();
  /// Not zero; of any length.
  Vector3 normal = Vector3::UnitZ();
};

struct SphereTool {
  Point3 centre = Point3::Zero();
  double radius = 1.0;
  KeptSide keep = KeptSide::inside;
};

/// Without ends.
struct CylinderTool {
  Point3 point = Point3::Zero();
  Vector3 axis = Vector3::UnitZ();
  double radius = 1.0;
  KeptSide keep = KeptSide::inside;
};

/// One nappe: the points that the axis, from the apex, sees within the half angle.
struct ConeTool {
  Point3 apex = Point3::Zero();
  Vector3 axis = Vector3::UnitZ();
  /// Radians, in (0, pi / 2).
  double half_angle = 0.5;
  KeptSide keep = KeptSide::inside;
};

using ClipTool = std::variant<PlaneTool, SphereTool, CylinderTool, ConeTool>;

/// F of the tool, negative on the side that is kept (of a cone: on both nappes).
ImplicitSurface implicit_surface(const ClipTool& tool);

struct ClipOptions {
  /// Distances from the tool that count as zero, relative to the diagonal of the solid's box or, if that is larger, the
  /// largest coordinate: a hundred times rounding.
  double tolerance = 1e-13;
  /// How far edges of neighbouring faces may lie apart where they cross the tool, relative to the diagonal.
  double gap_tolerance = 1e-6;
};

/// The part of a solid on the kept side of a tool.
///
/// `solid` is closed and oriented (see orient()). Faces that are not met stay as they are, faces that are cut become
/// trimmed surfaces of the same name and orientation, along traced curves (ImplicitTrace); what is left is closed by
/// trimmed parts of the tool named "cap", or "cap_2", ... as long as the name is taken, with normals that point out of
/// what is left. Faces of the solid that lie on the tool are replaced by caps. Extracted surfaces become patches of
/// their elements, "name[0]", "name[1]", ... A solid of which nothing is cut off comes back as it is.
///
/// Throws GeometryError if nothing is left; if the solid is open where the tool cuts it; if the tool touches a face in
/// a singular point that is not an ordinary double point; and if a cone whose outside is kept meets the solid with its
/// other nappe too.
Boundary<3> clip(const Boundary<3>& solid, const ClipTool& tool, const ClipOptions& options = {});

}  // namespace isorim::geometry
