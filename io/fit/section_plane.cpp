#include "io/fit/section_plane.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io {

PlaneOfPoints plane_of_points(const geometry::Points<3>& points) {
  PlaneOfPoints result;
  result.plane.origin = points.rowwise().mean();
  const geometry::Points<3> arms = points.colwise() - result.plane.origin;
  const double size = arms.colwise().norm().maxCoeff();
  if (!(size > 0.0)) throw GeometryError("the points of the section coincide");
  const Eigen::Matrix3d moments = (arms / size) * (arms / size).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments);
  const double width = size * std::sqrt(std::max(axes.eigenvalues()(1), 0.0) / static_cast<double>(points.cols()));
  if (width <= 1e-6 * size) throw GeometryError("the points of the section lie on a line");
  geometry::Vector3 normal = axes.eigenvectors().col(0);
  // Sections that are nearly parallel look to the same side.
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal(largest) < 0.0) normal = -normal;
  result.plane.first = axes.eigenvectors().col(2);
  result.plane.second = normal.cross(result.plane.first);
  result.off_plane = (normal.transpose() * arms).cwiseAbs().maxCoeff();
  if (result.off_plane > 0.01 * size) {
    throw GeometryError(
        fmt::format("a point lies {:.4g} from the plane of the section, whose size is {:.4g}; expected "
                    "points in one plane",
                    result.off_plane, size));
  }
  result.points.resize(2, points.cols());
  result.points.row(0) = result.plane.first.transpose() * arms;
  result.points.row(1) = result.plane.second.transpose() * arms;
  return result;
}

}  // namespace isorim::io
