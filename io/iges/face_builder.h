#pragma once

#include <optional>
#include <vector>

#include "geometry/trimming/loose_face.h"
#include "io/iges/entity_reader.h"

namespace isorim::io::iges {

/// A piece of a loop in the parameters that IGES gives the surface.
struct RawPiece {
  std::optional<geometry::NurbsCurve<2>> pcurve;
  std::optional<geometry::NurbsCurve<3>> model_curve;
  int edge = -1;
};

using RawLoop = std::vector<RawPiece>;

/// How far the directions in a file can be believed.
enum class PieceDirections {
  /// Pieces follow one another, but one may have been written backwards (142).
  from_ends,
  /// Each is turned as the file says (141, 508).
  given,
};

struct RawFace {
  AnySurface surface;
  std::vector<RawLoop> loops;
  PieceDirections directions = PieceDirections::from_ends;
  geometry::LoopSides sides = geometry::LoopSides::outer_first;
  bool natural_outer_boundary = false;
};

/// A face on the parameters of its NURBS.
///
/// Surfaces without ends get those that their loops need. Which convention and which turn the curves in parameter space
/// are meant on is found by comparing them with the curves in space where both are there, else by where they fit; then
/// they are mapped (map_pcurve()). Where the file does not define a surface's parameters only curves in space count.
/// Curves in space that run against their partner in parameter space are turned, and dropped if they lie elsewhere.
/// Pieces without length are left out.
///
/// Throws InputError, naming the entity, if a loop has no curves that could be used, or if nothing says how far a
/// surface reaches.
geometry::LooseFace build_face(RawFace face, const Entity& entity, EntityReader& reader);

/// The face moved: its surface and its curves in space.
geometry::LooseFace transform(const geometry::LooseFace& face, const geometry::AffineMap<3>& map);

}  // namespace isorim::io::iges
