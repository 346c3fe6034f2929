#pragma once

#include <filesystem>
#include <string>

#include "io/results/compute.h"

namespace isorim::io {

/// The oriented boundary as exact rational Bézier cells; see io/vtk/bezier_writer.h.
void write_boundary_vtu(const std::filesystem::path& path, const AnyModel& model);

/// A picture of a region of the plane; nothing for a solid.
void write_boundary_svg(const std::filesystem::path& path, const std::string& title, const AnyModel& model);

/// Whether a solid's boundary has edges that nothing continues.
bool has_free_edges(const AnyModel& model);

/// These edges as rational Bézier curves, exact or within a millionth of the boundary's size; a solid's alone.
void write_free_edges_vtu(const std::filesystem::path& path, const AnyModel& model);

}  // namespace isorim::io
