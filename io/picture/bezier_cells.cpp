#include "io/picture/bezier_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkHigherOrderQuadrilateral.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include "geometry/errors.h"
#include "io/vtk/bernstein.h"

namespace isorim::io::picture {
namespace {

/// What the file says, or equal degrees that fit the number of points.
std::array<int, 2> degrees_of(vtkDataSet* data, vtkIdType cell, bool is_curve, vtkIdType count) {
  if (is_curve) return {static_cast<int>(count) - 1, 0};
  if (vtkDataArray* degrees = data->GetCellData()->GetHigherOrderDegrees()) {
    return {static_cast<int>(degrees->GetComponent(cell, 0)), static_cast<int>(degrees->GetComponent(cell, 1))};
  }
  const int degree = static_cast<int>(std::lround(std::sqrt(static_cast<double>(count)))) - 1;
  return {degree, degree};
}

/// The derivatives of the Bernstein polynomials at t.
Eigen::VectorXd bernstein_derivatives(int degree, double t) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(degree + 1);
  if (degree == 0) return values;
  const Eigen::VectorXd lower = bernstein(degree - 1, t);
  values.tail(degree) += degree * lower;
  values.head(degree) -= degree * lower;
  return values;
}

/// The normal of a surface at a place, of length 1; 0 where tangents vanish beside `squared_size`, or are parallel.
Eigen::Vector3d normal_at(const BezierCell& cell, double squared_size, double s, double t) {
  const int columns = cell.degree[0] + 1;
  const Eigen::VectorXd in_s = bernstein(cell.degree[0], s);
  const Eigen::VectorXd in_t = bernstein(cell.degree[1], t);
  const Eigen::VectorXd ds = bernstein_derivatives(cell.degree[0], s);
  const Eigen::VectorXd dt = bernstein_derivatives(cell.degree[1], t);
  Eigen::Vector4d at = Eigen::Vector4d::Zero();
  Eigen::Vector4d along_s = Eigen::Vector4d::Zero();
  Eigen::Vector4d along_t = Eigen::Vector4d::Zero();
  for (Eigen::Index k = 0; k < cell.net.cols(); ++k) {
    const Eigen::Index i = k % columns;
    const Eigen::Index j = k / columns;
    at += in_s[i] * in_t[j] * cell.net.col(k);
    along_s += ds[i] * in_t[j] * cell.net.col(k);
    along_t += in_s[i] * dt[j] * cell.net.col(k);
  }
  const Eigen::Vector3d point = at.head<3>() / at[3];
  const Eigen::Vector3d u = along_s.head<3>() - along_s[3] * point;
  const Eigen::Vector3d v = along_t.head<3>() - along_t[3] * point;
  const Eigen::Vector3d cross = u.cross(v);
  const double length = cross.norm();
  // A side without length leaves a tangent of rounding errors alone.
  return length > 1e-10 * squared_size * at[3] * at[3] ? Eigen::Vector3d(cross / length) : Eigen::Vector3d::Zero();
}

/// Where a side has no length the normal is the one nearby.
Eigen::Vector3d normal_or_nearby(const BezierCell& cell, double squared_size, double s, double t) {
  for (const double inwards : {0.0, 1e-4, 1e-2}) {
    const Eigen::Vector3d normal = normal_at(cell, squared_size, s + inwards * (0.5 - s), t + inwards * (0.5 - t));
    if (normal.squaredNorm() > 0.0) return normal;
  }
  return Eigen::Vector3d::Zero();
}

double squared_size_of(const BezierCell& cell) {
  const Eigen::Matrix3Xd points = cell.net.colwise().hnormalized();
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).squaredNorm();
}

/// The largest second difference of the control polygons in one direction.
double largest_second_difference(const BezierCell& cell, int direction) {
  const int columns = cell.degree[0] + 1;
  const int rows = cell.degree[1] + 1;
  const Eigen::Index step = direction == 0 ? 1 : columns;
  double largest = 0.0;
  for (int j = 0; j < (direction == 0 ? rows : rows - 2); ++j) {
    for (int i = 0; i < (direction == 0 ? columns - 2 : columns); ++i) {
      const Eigen::Index k = i + Eigen::Index{j} * columns;
      const auto point = [&](Eigen::Index m) -> Eigen::Vector3d { return cell.net.col(m).head<3>() / cell.net(3, m); };
      largest = std::max(largest, (point(k) - 2.0 * point(k + step) + point(k + 2 * step)).norm());
    }
  }
  return largest;
}

}  // namespace

BezierCell read_bezier_cell(vtkDataSet* data, vtkIdType index) {
  const vtkNew<vtkIdList> list;
  data->GetCellPoints(index, list);
  const vtkIdType count = list->GetNumberOfIds();
  const bool is_curve = data->GetCellType(index) == VTK_BEZIER_CURVE;
  BezierCell cell;
  cell.degree = degrees_of(data, index, is_curve, count);
  const auto [p, q] = cell.degree;
  const bool is_valid = p >= 1 && (is_curve || q >= 1) && (vtkIdType{p} + 1) * (vtkIdType{q} + 1) == count;
  if (!is_valid) {
    throw InputError(
        fmt::format("cell {}: found {} points and the degrees {}, {}, which disagree", index, count, p, q));
  }
  vtkDataArray* weights = data->GetPointData()->GetRationalWeights();
  cell.net.resize(4, count);
  for (int j = 0; j <= q; ++j) {
    for (int i = 0; i <= p; ++i) {
      const int on_curve = i == 0 ? 0 : i == p ? 1 : i + 1;
      const vtkIdType place =
          is_curve ? on_curve : vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, cell.degree.data());
      const vtkIdType id = list->GetId(place);
      const double weight = weights != nullptr ? weights->GetComponent(id, 0) : 1.0;
      if (!(weight > 0.0)) throw InputError(fmt::format("cell {}: found the weight {}, expected > 0", index, weight));
      Eigen::Vector3d point;
      data->GetPoint(id, point.data());
      cell.net.col(i + Eigen::Index{j} * (p + 1)) << weight * point, weight;
      cell.ids.push_back(id);
    }
  }
  return cell;
}

std::array<int, 2> pieces_for(const BezierCell& cell, double chord_tolerance, int least) {
  constexpr int most = 96;
  // Unequal weights crowd the points of equal parameter steps.
  const double spread = std::sqrt(cell.net.row(3).maxCoeff() / cell.net.row(3).minCoeff());
  std::array<int, 2> pieces{1, 0};
  for (int d = 0; d < (cell.is_curve() ? 1 : 2); ++d) {
    const int p = cell.degree[static_cast<std::size_t>(d)];
    // The chord of a polynomial curve over 1 / n is within p (p - 1) / 8 / n^2 times its second differences.
    const double bound = p * (p - 1) / 8.0 * largest_second_difference(cell, d);
    const double wanted = std::ceil(std::sqrt(bound / chord_tolerance) * spread);
    pieces[static_cast<std::size_t>(d)] = static_cast<int>(std::clamp(wanted, static_cast<double>(least), 1.0 * most));
  }
  return pieces;
}

BezierSamples evaluate(const BezierCell& cell, const Eigen::MatrixXd& control_values,
                       const std::array<int, 2>& pieces) {
  BezierSamples samples;
  samples.pieces = pieces;
  const auto [n, m] = pieces;
  const Eigen::Index count = Eigen::Index{n + 1} * (m + 1);
  samples.points.resize(3, count);
  samples.normals.resize(3, cell.is_curve() ? 0 : count);
  samples.values.resize(control_values.rows(), count);
  const Eigen::MatrixXd weighted = (control_values.array().rowwise() * cell.net.row(3).array()).matrix();
  const double squared_size = squared_size_of(cell);
  for (int j = 0; j <= m; ++j) {
    const double t = m == 0 ? 0.0 : static_cast<double>(j) / m;
    const Eigen::VectorXd in_t = bernstein(cell.degree[1], t);
    for (int i = 0; i <= n; ++i) {
      const double s = static_cast<double>(i) / n;
      const Eigen::VectorXd in_s = bernstein(cell.degree[0], s);
      // The first parameter runs fastest, as in the net.
      const Eigen::MatrixXd product = in_s * in_t.transpose();
      const Eigen::Map<const Eigen::VectorXd> basis(product.data(), product.size());
      const Eigen::Vector4d point = cell.net * basis;
      const Eigen::Index k = i + Eigen::Index{j} * (n + 1);
      samples.points.col(k) = point.head<3>() / point[3];
      samples.values.col(k) = weighted * basis / point[3];
      if (!cell.is_curve()) samples.normals.col(k) = normal_or_nearby(cell, squared_size, s, t);
    }
  }
  return samples;
}

}  // namespace isorim::io::picture
