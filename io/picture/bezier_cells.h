#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <vtkType.h>

class vtkDataSet;

namespace isorim::io::picture {

/// A rational Bézier curve or quadrilateral of a VTK file.
struct BezierCell {
  /// The second is 0 for a curve.
  std::array<int, 2> degree{};
  /// 4 x count homogeneous points (w x, w y, w z, w), the first parameter fastest.
  Eigen::Matrix4Xd net;
  /// The points of the data set, in the order of the net.
  std::vector<vtkIdType> ids;

  bool is_curve() const { return degree[1] == 0; }
};

/// Reads a cell of type VTK_BEZIER_CURVE or VTK_BEZIER_QUADRILATERAL. Throws InputError if degrees and number of points
/// disagree, or for weights that are not positive.
BezierCell read_bezier_cell(vtkDataSet* data, vtkIdType cell);

/// A cell at the points of a lattice of pieces[0] x pieces[1] pieces, the first parameter fastest.
struct BezierSamples {
  std::array<int, 2> pieces{1, 0};
  /// 3 x count.
  Eigen::Matrix3Xd points;
  /// 3 x count, of length 1 (0 where there is none); without columns for a curve.
  Eigen::Matrix3Xd normals;
  /// Rows of control values, evaluated: rows x count.
  Eigen::MatrixXd values;
};

/// Pieces so that chords are within about `chord_tolerance` of the cell, at least `least` a direction.
std::array<int, 2> pieces_for(const BezierCell& cell, double chord_tolerance, int least);

/// `control_values`: rows x control points, in the rational basis of the cell; may have no rows.
BezierSamples evaluate(const BezierCell& cell, const Eigen::MatrixXd& control_values, const std::array<int, 2>& pieces);

}  // namespace isorim::io::picture
