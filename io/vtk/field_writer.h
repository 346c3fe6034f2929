#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "io/results/analysis_report.h"

/// Values at points, for ParaView: facets, images and sets of points. All reals are doubles, bit for bit.
namespace isorim::io {

/// components x points (or cells).
struct PointArray {
  std::string name;
  Eigen::MatrixXd values;
  /// One a component, or none.
  std::vector<std::string> components = {};
};

/// Flat facets, or pieces of lines in the plane. Facets of different elements share no point, since fields may jump
/// there.
struct FacetMesh {
  /// 3 x n.
  Eigen::Matrix3Xd points;
  /// Two vertices, three or four; unused ones -1. Counter-clockwise seen from outside.
  std::vector<std::array<std::int64_t, 4>> facets;
  std::vector<PointArray> point_arrays;
  /// One column a facet.
  std::vector<PointArray> cell_arrays;
};

/// Each throws InputError with the path for what cannot be written, or arrays of the wrong length.
void write_facets_vtu(const std::filesystem::path& path, const FacetMesh& mesh);

/// An image; points for which `hidden` holds are blanked (vtkGhostType), so that ParaView leaves them out.
void write_image_vti(const std::filesystem::path& path, const ImageShape& shape, const std::vector<PointArray>& arrays,
                     const std::vector<char>& hidden);

enum class PointForm { points, line };
/// A vertex at every point; with PointForm::line also a line through them. points: 3 x n.
void write_points_vtp(const std::filesystem::path& path, const Eigen::Matrix3Xd& points, PointForm form,
                      const std::vector<PointArray>& arrays);

}  // namespace isorim::io
