#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/tspline/extracted_surface.h"
#include "io/tspline/extraction_data.h"

/// `.iga`: Bézier extraction as text, as the T-spline plug-ins of modelling programs write it.
namespace isorim::io::tspline {

/// Reads the text of an `.iga` file. Surfaces, in the plane ("type plane") or in space, of any degrees; lines in any
/// order. Sets are checked and counted, a "domain" is passed over.
///
/// Throws InputError with the line: for volumes and thickened surfaces; words that are none of the format; numbers of
/// nodes or elements other than announced; a node or function that does not exist; a row that is too short or holds
/// what is no finite number. Needs memory for a small multiple of the text, whatever it announces.
///
/// Lines that begin with "#isorim" are comments to others; here they add what the format has no place for:
///   #isorim cell ELEMENT s0 s1 t0 t1      the element's domain, where that is not the unit square
///   #isorim point NODE wx wy wz           the products of a node's coordinates and its weight, where no coordinates
///   give
///                                         them to the last bit
ExtractionData parse_iga(std::string_view text);

/// The surface as `.iga` text, from which parse_iga() gets the same surface to the last bit: all digits of all numbers,
/// and "#isorim" lines where needed. Each line of `comment` becomes a comment at the beginning.
std::string iga_text(const geometry::ExtractedSurface& surface, std::string_view comment = {});

CadModel read_iga(const std::filesystem::path& path);
/// Writes atomically. Throws InputError if the file cannot be written.
void write_iga(const std::filesystem::path& path, const geometry::ExtractedSurface& surface,
               std::string_view comment = {});

}  // namespace isorim::io::tspline
