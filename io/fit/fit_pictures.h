#pragma once

#include <filesystem>
#include <string>

#include "io/fit/fit_facts.h"

/// Files that show how well curves fit their points.
namespace isorim::io {

/// The data, the curves, and, if there are no more than three curves, their control polygons and curvature combs.
/// Sections of a body are laid over each other in the coordinates of their planes. Combs point outward where a closed
/// curve is convex; their teeth are as long as the curvature says, the usual largest one (the 0.95 quantile) being an
/// eighth of the picture, at most twice that.
void write_fit_svg(const std::filesystem::path& path, const std::string& title, const FitFacts& facts);

/// The error table: curve, x, y, z, distance and parameter of the nearest point, one line for each point fitted to.
void write_fit_points(const std::filesystem::path& path, const FitFacts& facts);

}  // namespace isorim::io
