#pragma once

#include <filesystem>
#include <string>

#include "geometry/tspline/tmesh.h"

/// Pictures of T-meshes in their parameters.
namespace isorim::io::svg {

/// The T-mesh as an SVG document, the same text for the same mesh on every machine: its edges, the face extensions that
/// the Bézier mesh adds to them, T-junctions, and anchors, with their numbers where the row has room. Intervals are as
/// long as their knots tell, those of zero a little wider than nothing, so that lines of equal knots stand side by
/// side. The frame, which lies outside the domain, is pale.
std::string to_svg(const geometry::TMesh& mesh, const std::string& title);

/// Writes to_svg() atomically; errors as write_file().
void write_svg(const std::filesystem::path& path, const geometry::TMesh& mesh, const std::string& title);

}  // namespace isorim::io::svg
