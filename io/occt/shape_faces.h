#pragma once

#include <functional>

#include "io/cad/cad_model.h"

class TopoDS_Face;
class TopoDS_Shape;

/// From OpenCASCADE's boundary representation to ours; for the .cpp files of this folder.
namespace isorim::io::occt {

/// Fills in what the document says about a face besides its shape.
using Describe = std::function<void(const TopoDS_Face& face, CadOrigin& origin)>;

/// Which curves bound a face.
enum class EdgeCurves {
  /// The edges' curves in space.
  in_space,
  /// Each face's own curves in its parameters: after sewing, edges in space are those of one of their faces alone. For
  /// shapes of which all surfaces are B-splines.
  on_surface,
};

/// Appends every face of the shape, those of solids first. Surfaces become exact rational B-splines over what the face
/// needs of them (offset surfaces and the like are approximated and listed); the loops' pieces run in the direction in
/// which the kept part lies on their left.
void append_faces(const TopoDS_Shape& shape, EdgeCurves curves, const Describe& describe, CadModel& model);

}  // namespace isorim::io::occt
