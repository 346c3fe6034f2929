#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "io/results/compute.h"

namespace isorim::io {

/// The oriented boundary as exact rational Bézier cells, triangles where faces are trimmed; see io/vtk/bezier_writer.h.
/// If it comes from a CAD file that tells colours or levels, these are cell data `colour` (red, green, blue in [0, 1];
/// grey where the file tells none) and `level`.
void write_boundary_vtu(const std::filesystem::path& path, const AnyModel& model);

/// A picture of a region of the plane; nothing for a solid.
void write_boundary_svg(const std::filesystem::path& path, const std::string& title, const AnyModel& model);

/// "tmesh_<patch>.svg" in the folder for each T-spline of the case; what is neither letter, digit nor "-" in the
/// patch's name becomes "_". Where two names lead to the same file the later one gets a number, "tmesh_<patch>_2.svg".
void write_tmesh_svgs(const std::filesystem::path& folder, const AnyBoundary& shape);

/// Whether a solid's boundary has edges that nothing continues.
bool has_free_edges(const AnyModel& model);

/// Whether a solid's boundary has edges at all (one closed patch without seams has none).
bool has_edges(const AnyModel& model);

/// All edges of a solid's boundary as rational Bézier curves, exact or within a millionth of the boundary's size. Cell
/// data: `free`, 1 where no other patch continues the edge; `gap`, the largest distance between the two patches there,
/// or from a free edge to the next one (-1 if there is none).
void write_edges_vtu(const std::filesystem::path& path, const AnyModel& model);

/// The free edges alone as rational Bézier curves, exact or within a millionth of the boundary's size; a solid's alone.
void write_free_edges_vtu(const std::filesystem::path& path, const AnyModel& model);

/// The watertight mesh of a solid to the tolerance of the case's [output]; the number of its triangles. Throws
/// InputError for a shape of the plane, and as tessellate() and write_stl() do.
std::size_t write_boundary_stl(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model);

}  // namespace isorim::io
