#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/boundary.h"
#include "geometry/intersection/critical_points.h"
#include "geometry/intersection/implicit_surface.h"
#include "geometry/intersection/implicit_trace.h"
#include "geometry/nurbs/curve.h"
#include "geometry/trimming/face_locator.h"

namespace isorim::geometry {

/// A face made ready to be cut: what does not depend on the cutting surface.
class CuttableFace {
 public:
  /// Of a whole or trimmed surface; extracted surfaces are cut element by element.
  explicit CuttableFace(const SurfaceShape& face);

  const NurbsSurface<3>& surface() const { return *surface_; }
  const std::shared_ptr<const NurbsSurface<3>>& shared_surface() const { return surface_; }
  const std::vector<TrimLoop>& loops() const { return loops_; }
  /// The Bézier elements of the whole surface.
  const ElementTable<3>& elements() const { return elements_; }
  /// Lengths of the domain in u and v.
  const Vector2& extent() const { return extent_; }
  /// Nothing for a whole surface.
  const FaceLocator* locator() const { return locator_ ? &*locator_ : nullptr; }

  /// A part of a loop in one element.
  struct LoopPart {
    HomogeneousPoints<2> net;
    int element = 0;
    /// The side of the element along which it runs.
    std::optional<Side> side;
  };
  const std::vector<LoopPart>& loop_parts() const { return parts_; }

 private:
  std::shared_ptr<const NurbsSurface<3>> surface_;
  std::vector<TrimLoop> loops_;
  ElementTable<3> elements_;
  Vector2 extent_;
  std::optional<FaceLocator> locator_;
  std::vector<LoopPart> parts_;
};

/// Where F = 0 meets a face.
struct FaceCuts {
  struct Cut {
    /// In the surface's parameters, over [0, 1], what is left of the face on its left.
    NurbsCurve<2> curve;
    /// It is a part of a loop.
    bool is_on_loop = false;
  };
  /// The edges along which F vanishes of the part of the face with F < 0.
  std::vector<Cut> cuts;
  /// Curves inside the face along which it touches F = 0 without crossing it.
  std::vector<NurbsCurve<2>> touching;
  /// Contacts inside the face (saddle: double points of the cuts; extremum: points where it touches) and on its loops,
  /// and ends of the loops' curves on F = 0. Places on cuts and on touching curves may be among them.
  std::vector<ElementContacts::Contact> contacts;
  /// F vanishes along some part of a loop.
  bool has_loop_on_tool = false;
  /// Elements on which F vanishes altogether, of the whole surface.
  int flat_elements = 0;
};

/// What F = 0 cuts from a face and where it touches it. Throws GeometryError for singular points that ImplicitTrace
/// refuses.
FaceCuts cut_face(const CuttableFace& face, const ImplicitSurface& implicit, const TraceOptions& options);

/// The part of a face on the side where F is negative, by the curves that bound it.
struct KeptPart {
  /// All of the face; then `curves` is empty.
  bool is_whole = false;
  /// In the surface's parameters, over [0, 1], the part on the left of each, in no order: the sum over them of a line
  /// integral is one round the part. None if nothing is left.
  std::vector<NurbsCurve<2>> curves;
  /// Those edges of the part along which F vanishes.
  std::vector<NurbsCurve<2>> cuts;
};

/// For integrals over what is left of a face; clip_face() makes a face of it. Throws GeometryError, with the
/// parameters, for singular points that ImplicitTrace refuses.
KeptPart kept_part(const CuttableFace& face, const ImplicitSurface& implicit, const TraceOptions& options);

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
