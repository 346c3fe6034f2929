#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/tspline/extracted_surface.h"
#include "io/cad/cad_model.h"

/// What the formats of Bézier extraction share.
namespace isorim::io::tspline {

/// Functions and elements as a file gives them, not validated yet.
struct ExtractionData {
  geometry::HomogeneousPoints<3> points;
  std::vector<geometry::ExtractionElement> elements;
  /// What else stands in the file, for reports.
  std::vector<EntityCount> entities;
  std::vector<std::string> warnings;
};

/// The parts of a surface that share no function, in the order of their first elements. Functions that live on no
/// element are left out; those of a part keep their order. A surface of one part all of whose functions live somewhere
/// comes back as it is.
std::vector<geometry::ExtractedSurface> connected_parts(geometry::ExtractedSurface surface);

/// A model of the file's surfaces: one for each connected part. Throws InputError if they are none (ExtractedSurface).
CadModel model_of(ExtractionData data, std::string_view format);

}  // namespace isorim::io::tspline
