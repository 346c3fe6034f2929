#pragma once

#include <filesystem>
#include <string>

#include "io/cad/cad_model.h"

/// Files that OpenCASCADE reads for us: STEP, and IGES files that are too broken to be taken as they are. An optional
/// component (ISORIM_WITH_OCCT); the functions are there without it and say so.
namespace isorim::io {

/// Whether this build contains OpenCASCADE.
bool has_occt();

/// "OpenCASCADE 7.6.3", or empty without it.
std::string occt_version();

/// The faces of a STEP file (AP203, AP214, AP242) in the file's own unit: exact NURBS surfaces and, for each loop, the
/// edges' curves in space with the file's topology (LoosePiece::edge). Parameter curves are left out: in STEP the
/// curves in space are what is meant, and assemble_face() inverts them more accurately than the file or OpenCASCADE
/// does. Names and colours are kept.
///
/// Throws InputError, naming the file, if it cannot be read, holds no face, or this build has no OpenCASCADE.
CadModel read_step(const std::filesystem::path& path);

/// The faces of an IGES file after OpenCASCADE has read, repaired (ShapeFix) and sewn them with the given tolerance
/// (millimetres): a last resort for files that our own reader, which alters nothing, refuses or finds open. In
/// millimetres. Throws as read_step().
CadModel read_iges_repaired(const std::filesystem::path& path, double sewing_tolerance);

}  // namespace isorim::io
