#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/boundary.h"
#include "io/cad/cad_facts.h"
#include "io/cad/cad_model.h"

/// From what a CAD file holds to patches of a boundary.
namespace isorim::io {

struct AssemblyOptions {
  /// The unit of the boundary ("m", see io/cad/units.h); that of the file if empty.
  std::string unit = {};
  /// 2: a region of the plane; 3: a solid. If absent 3 where the file has faces, else 2.
  std::optional<int> dimension = {};
  /// Only faces and curves of these names; all if empty.
  std::vector<std::string> names = {};
  /// Only faces and curves on these levels (layers); all if empty.
  std::vector<int> levels = {};
  /// Number of threads; 0: all.
  int threads = 0;
};

struct AssembledModel {
  /// Not oriented yet; patch names unique: the file's, else "face_12" or "curve_3" (counted in the file's order).
  std::variant<geometry::Boundary<2>, geometry::Boundary<3>> boundary;
  CadFacts facts;
};

/// Makes a patch of every face of the model, in parallel (Dim = 3); or plane curves of the edges of its flat faces, of
/// its curves if it has no faces (Dim = 2).
///
/// Plane curves must lie in one plane. If that is z = const, x and y stay; another plane gets axes of its own: x
/// horizontal and y upwards for a plane that is not (y and z of the file for x = const), the origin being the plane's
/// point nearest to that of space; a warning says so.
///
/// A face that cannot be assembled is left out and listed in CadFacts::refused: callers that want numbers must not pass
/// over it. Throws InputError if there is nothing to make a boundary of, telling what was found instead; if names or
/// levels select nothing; for plane curves that lie in no plane.
AssembledModel assemble(const CadModel& model, const AssemblyOptions& options = {});

}  // namespace isorim::io
