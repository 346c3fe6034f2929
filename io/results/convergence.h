#pragma once

#include <filesystem>
#include <string>

#include "io/results/compute.h"

namespace isorim::io {

/// A line for each number of points: "points,area,volume,..." and the relative errors with 17 digits.
void write_convergence_csv(const std::filesystem::path& path, const Convergence& study);

/// The relative errors against the number of points, on a logarithmic scale.
void write_convergence_svg(const std::filesystem::path& path, const std::string& title, const Convergence& study);

}  // namespace isorim::io
