#pragma once

#include <filesystem>
#include <string_view>

#include "geometry/tessellation/tessellation.h"

/// Meshes for printers and mills: binary STL files.
namespace isorim::io {

/// Writes the triangles with their normals, coordinates in single precision; those that have no area in it are left
/// out, which leaves no hole. The header begins with the title. Returns how many triangles were written. Throws
/// InputError as write_file() does, and if a coordinate is too large for single precision.
std::size_t write_stl(const std::filesystem::path& path, std::string_view title, const geometry::TriangleMesh& mesh);

}  // namespace isorim::io
