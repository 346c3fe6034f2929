#pragma once

#include <string>
#include <vector>

#include "geometry/trimming/loose_face.h"
#include "io/cad/cad_model.h"

/// What is known of a boundary from a CAD file besides its shape.
namespace isorim::io {

/// Where a patch comes from.
struct PatchOrigin {
  CadOrigin origin;
  /// Index of the file's solid that it belongs to; -1 if it is loose.
  int solid = -1;
  /// What had to be done to the face; lengths in the unit of the boundary.
  geometry::FaceRepairs repairs;
  /// For each loop and curve of the patch the file's edge that it came from, or -1 (AssembledFace::edges).
  std::vector<std::vector<int>> edges;
};

/// A face or curve that could not be made a patch.
struct RefusedEntity {
  /// The name that its patch would have, and the entity in the file.
  std::string name;
  std::string entity;
  std::string reason;
};

/// Everything about a file but its shape.
struct CadFacts {
  std::string format;
  std::string reader;
  std::string author;
  /// The file's unit, that of the boundary, and by how much coordinates were multiplied to get from one to the other.
  std::string file_unit;
  std::string unit;
  double scale = 1.0;
  /// What the file holds, whether used or not.
  int faces = 0;
  int solids = 0;
  int curves = 0;
  int points = 0;
  std::vector<EntityCount> entities;
  /// Lengths in the unit of the boundary.
  std::vector<Approximation> approximations;
  /// One a patch of the boundary, in its order.
  std::vector<PatchOrigin> patches;
  std::vector<RefusedEntity> refused;
  /// What the reader said, and what was left out or decided on the way.
  std::vector<std::string> warnings;
};

/// The repairs of all faces together: sums, largest lengths, and the notes with the entity before each.
geometry::FaceRepairs all_repairs(const CadFacts& facts);

}  // namespace isorim::io
