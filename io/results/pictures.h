#pragma once

#include <filesystem>
#include <string>

#include "io/results/compute.h"

namespace isorim::io {

/// The oriented boundary as exact rational Bézier cells; see io/vtk/bezier_writer.h.
void write_boundary_vtu(const std::filesystem::path& path, const AnyModel& model);

/// A picture of a region of the plane; nothing for a solid.
void write_boundary_svg(const std::filesystem::path& path, const std::string& title, const AnyModel& model);

}  // namespace isorim::io
