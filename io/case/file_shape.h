#pragma once

#include "io/cad/cad_facts.h"
#include "io/case/shape_builder.h"
#include "io/case/shape_keys.h"

namespace isorim::io {

/// What becomes of a file of which some faces cannot be made patches.
enum class RefusedFaces {
  /// It is refused, with all of them.
  refuse,
  /// They are left out and listed in CadFacts::refused: for reports, not for numbers.
  leave_out,
};

struct FileShapeOptions {
  RefusedFaces refused_faces = RefusedFaces::refuse;
  /// Number of threads; 0: all.
  int threads = 0;
};

struct FileShape {
  /// Without patches if every face was left out.
  AnyBoundary boundary;
  CadFacts facts;
};

/// Reads a CAD file and makes a boundary of it. Throws InputError with file, line and key of the case and the file's
/// own name and entity: whatever read_cad() and assemble() find wrong.
FileShape build_file_shape(const FileKeys& keys, const FileShapeOptions& options = {});

}  // namespace isorim::io
