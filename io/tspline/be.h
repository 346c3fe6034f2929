#pragma once

#include <filesystem>
#include <string_view>

#include "io/tspline/extraction_data.h"

/// `.be`: Bézier elements of T-splines for boundary-element analysis (Peres, Sanches, Paiva and Pagliosa, Computer
/// Methods in Applied Mechanics and Engineering 432A (2024)).
namespace isorim::io::tspline {

/// Reads the text of a `.be` file. Elements come with or without a line of four face nodes (the same way in a whole
/// file: the way that can be read is taken); nodes have numbers of any order. Collocation points are checked and
/// counted; regions are passed over.
///
/// Throws InputError with the line, as parse_iga() does, and for a number of node or element that is there twice.
ExtractionData parse_be(std::string_view text);

CadModel read_be(const std::filesystem::path& path);

}  // namespace isorim::io::tspline
