#pragma once

#include <Eigen/Core>

/// The Eigen types that the whole project shares. Every matrix is column-major; a column is a point.
namespace isorim::geometry {

/// A point of the plane (Dim = 2) or of space (Dim = 3), in the units of the shape.
template <int Dim>
using Point = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

using Point2 = Point<2>;
using Point3 = Point<3>;
using Vector2 = Vector<2>;
using Vector3 = Vector<3>;

/// Dim x n; column i is point i.
template <int Dim>
using Points = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

/// (Dim + 1) x n homogeneous points: column i is (w x, w y, [w z,] w), coordinates already multiplied by the weight.
template <int Dim>
using HomogeneousPoints = Eigen::Matrix<double, Dim + 1, Eigen::Dynamic>;

/// The closed interval [first, last] of a parameter.
struct Interval {
  double first = 0.0;
  double last = 1.0;

  double length() const { return last - first; }
  double middle() const { return 0.5 * (first + last); }
  bool contains(double u) const { return first <= u && u <= last; }
};

/// x -> linear x + translation.
template <int Dim>
struct AffineMap {
  Eigen::Matrix<double, Dim, Dim> linear = Eigen::Matrix<double, Dim, Dim>::Identity();
  Vector<Dim> translation = Vector<Dim>::Zero();

  Point<Dim> operator()(const Point<Dim>& x) const { return linear * x + translation; }
};

}  // namespace isorim::geometry
