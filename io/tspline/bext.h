#pragma once

#include <filesystem>
#include <string_view>

#include "io/cad/cad_model.h"

/// BEXT: Bézier extraction as JSON. Experimental: all files that are public hold curves; what is read of surfaces
/// follows from these and from `.iga`.
namespace isorim::io::tspline {

/// The surface, or the curves, of a BEXT text. Curve elements (deg_t = -1) become curves, one an element. Of surfaces
/// the Bernstein coefficients are taken with s fastest; a warning says that no file has shown it yet.
///
/// Throws InputError, naming the place in the text ("elements.element_blocks[3].node_ids"): for what is no JSON or
/// lacks a key; numbers of nodes, elements or coefficients that do not agree; ids out of range; volumes; sparse
/// coefficient vectors, whose layout is not known.
CadModel parse_bext(std::string_view text);

CadModel read_bext(const std::filesystem::path& path);

}  // namespace isorim::io::tspline
