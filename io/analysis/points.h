#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "io/case/case_file.h"
#include "io/results/analysis_report.h"

/// The points that probes and grids stand for.
namespace isorim::io {

/// dim x n. Throws InputError, with file and line, for a file of points that cannot be read or has a line that is not
/// `dim` finite numbers.
Eigen::MatrixXd probe_points(const ProbeKeys& keys, int dim, const std::filesystem::path& folder);

ImageShape grid_shape(const GridKeys& keys, int dim);
/// dim x n, i fastest, then j.
Eigen::MatrixXd grid_points(const ImageShape& shape, int dim);

}  // namespace isorim::io
