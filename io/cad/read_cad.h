#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/cad/cad_model.h"

namespace isorim::io {

enum class CadFormat { iges, step, iga, be, bext };

/// The format of a file: by its content, then by its extension. Empty if neither tells. Throws InputError if the file
/// cannot be read.
std::optional<CadFormat> cad_format(const std::filesystem::path& path);

/// Whether the name ends like that of a CAD file (.igs, .iges, .stp, .step, .iga, .be, .json, in any case).
bool has_cad_extension(const std::filesystem::path& path);

/// Whether files of the format say in which unit their lengths are.
bool has_units(CadFormat format);

/// The formats that read_cad() knows, for messages: "IGES (.igs, .iges), STEP
/// (.stp, .step), ...".
std::string cad_formats();

/// What is switched off in the program that wrote the file.
enum class BlankedEntities { skip, include };

/// What becomes of faces and curves that cannot be read.
enum class BadEntities {
  /// The file is refused, with the entity.
  refuse,
  /// They are left out with a warning each: for reports, not for numbers.
  skip,
};

struct CadOptions {
  BlankedEntities blanked = BlankedEntities::skip;
  BadEntities bad_entities = BadEntities::refuse;
  /// IGES alone: read by OpenCASCADE, repaired and sewn within this many millimetres.
  std::optional<double> repair = std::nullopt;
};

/// Reads a CAD file of any format that we know: IGES by ourselves unless repair is asked for, STEP by OpenCASCADE where
/// that is built in (CadModel::reader tells), T-splines (.iga, .be, BEXT as .json) by ourselves. Throws InputError,
/// naming the file and the line or entity, if it cannot be read or is of no known format.
CadModel read_cad(const std::filesystem::path& path, const CadOptions& options = {});

}  // namespace isorim::io
