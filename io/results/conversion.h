#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "io/case/case_file.h"
#include "io/results/compute.h"

/// Boundaries in other formats: IGES (.igs, .iges), T-splines by their extraction (.iga), exact cells for ParaView
/// (.vtu), a drawing of a region of the plane (.svg), a watertight mesh of a solid (.stl).
namespace isorim::io {

enum class BoundaryFormat { iges, iga, vtu, svg, stl };

/// By the extension, in small letters or capitals. Throws InputError with the known ones for another.
BoundaryFormat boundary_format(const std::filesystem::path& path);

/// How faces go into an IGES file.
enum class FaceForm {
  /// As solids where shells are closed.
  solids,
  loose,
};

struct ConversionOptions {
  FaceForm faces = FaceForm::solids;
  /// IGES: unit of the lengths of a shape that says nothing of it; mm if absent.
  std::optional<std::string> unit;
};

/// What a file holds; what its format does not have is 0.
struct Conversion {
  BoundaryFormat format = BoundaryFormat::vtu;
  /// IGES.
  int solids = 0;
  int solid_faces = 0;
  int loose_faces = 0;
  int curves = 0;
  std::string unit;
  /// iga and vtu.
  std::size_t elements = 0;
  std::size_t functions = 0;
  /// stl.
  std::size_t triangles = 0;
};

/// Writes the boundary of a case in the format that the extension of `path` tells. `file` is what `model` was built
/// from; colours and levels of its CAD file go into IGES files.
///
/// Throws InputError for what cannot be written: extensions, units, shapes of the plane as .iga or .stl, shapes in
/// space as .svg; GeometryError with the title for T-splines that an .iga file cannot hold.
Conversion write_boundary(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model,
                          const ConversionOptions& options = {});

/// "1 solid of 6 faces, unit mm", "24 triangles", ...
std::string conversion_text(const Conversion& conversion);

/// "iges", "iga", "vtu", "svg" or "stl".
std::string format_name(BoundaryFormat format);

}  // namespace isorim::io
