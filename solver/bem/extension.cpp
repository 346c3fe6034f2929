#include "solver/bem/extension.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "geometry/bezier/element_jet.h"
#include "quadrature/gauss_legendre.h"
#include "solver/bem/point_selection.h"

namespace isorim::solver {

using geometry::BezierElement;
using geometry::ElementJet;
using geometry::ElementTable;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;

namespace {

/// Constants and coordinates.
constexpr Eigen::Index linear_count = 4;

/// Coordinates about a cell: two along the surface, one across it, in units of the cell's size.
struct Frame {
  Point3 origin;
  /// Rows.
  Eigen::Matrix3d axes;

  Vector3 local(const Point3& x) const { return axes * (x - origin); }
};

Frame frame_of(const ElementTable<3>& table, int cell) {
  const ElementJet<3> jet = evaluate_jet<3>(table, table.elements[static_cast<std::size_t>(cell)], Point2(0.5, 0.5));
  const Vector3 first = jet.tangents.col(0).normalized();
  const Vector3 along = jet.tangents.col(1) - jet.tangents.col(1).dot(first) * first;
  const Vector3 second = along.normalized();
  const Vector3 normal(first.y() * second.z() - first.z() * second.y(), first.z() * second.x() - first.x() * second.z(),
                       first.x() * second.y() - first.y() * second.x());
  Frame frame{jet.position, {}};
  frame.axes.row(0) = first / jet.tangents.col(0).norm();
  frame.axes.row(1) = second / along.norm();
  frame.axes.row(2) = normal / std::sqrt(jet.tangents.col(0).norm() * along.norm());
  return frame;
}

/// 1 and the coordinates, then the other monomials of the two along the surface up to the degree.
Eigen::RowVectorXd test_functions(const Vector3& x, int degree) {
  Eigen::RowVectorXd values(linear_count + std::max(0, (degree + 1) * (degree + 2) / 2 - 3));
  values.head<linear_count>() << 1.0, x.x(), x.y(), x.z();
  Eigen::Index k = linear_count;
  for (int total = 2; total <= degree; ++total)
    for (int j = 0; j <= total; ++j) values(k++) = std::pow(x.x(), total - j) * std::pow(x.y(), j);
  return values;
}

/// The coefficients of the test functions in the cell's functions, by interpolation at Gauss points: one row a
/// function.
Eigen::MatrixXd coefficients(const PatchSpace<3>& cells, const ElementTable<3>& table, int cell, const Frame& frame,
                             int degree) {
  const FieldElement<3>& field = cells.elements[static_cast<std::size_t>(cell)];
  const std::vector<double>& s = quadrature::gauss_legendre(field.degree[0] + 1).nodes;
  const std::vector<double>& t = quadrature::gauss_legendre(field.degree[1] + 1).nodes;
  const Eigen::Index nodes = static_cast<Eigen::Index>(s.size() * t.size());
  Eigen::MatrixXd functions(nodes, field.count);
  Eigen::MatrixXd tests(nodes, test_functions(Vector3::Zero(), degree).size());
  std::vector<double> values(static_cast<std::size_t>(field.count));
  Eigen::Index node = 0;
  for (const double v : t)
    for (const double u : s) {
      const Point2 place(u, v);
      const auto jet = evaluate_jet<3>(table, table.elements[static_cast<std::size_t>(cell)], place);
      numerators<3>(cells, cell, place, values);
      functions.row(node) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), field.count);
      functions.row(node) /= functions.row(node).sum();
      tests.row(node++) = test_functions(frame.local(jet.position), degree);
    }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(functions);
  Eigen::MatrixXd result = factors.solve(tests);
  result += factors.solve(tests - functions * result);
  result.col(0).setOnes();
  return result;
}

/// The smallest shares with tests * shares = wanted: exactly in the first rows, in the others by least squares. (On
/// curved surfaces the squares of the coordinates and the coordinate across nearly depend on one another.)
Eigen::MatrixXd least_shares(const Eigen::MatrixXd& tests, const Eigen::MatrixXd& wanted) {
  using Decomposition = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
  Decomposition linear;
  linear.setThreshold(1e-12);
  linear.compute(tests.topRows(linear_count));
  Eigen::MatrixXd shares = linear.solve(wanted.topRows(linear_count));
  const Eigen::Index others = tests.rows() - linear_count;
  if (others == 0) return shares;
  // Columns that the linear functions leave free.
  const Eigen::MatrixXd along = linear.pseudoInverse() * tests.topRows(linear_count);
  const Eigen::MatrixXd free = Eigen::MatrixXd::Identity(along.rows(), along.cols()) - along;
  Decomposition rest;
  rest.setThreshold(1e-6);
  rest.compute(tests.bottomRows(others) * free);
  shares += free * rest.solve(wanted.bottomRows(others) - tests.bottomRows(others) * shares);
  return shares + linear.solve(wanted.topRows(linear_count) - tests.topRows(linear_count) * shares);
}

}  // namespace

Eigen::MatrixXd extension(const PatchSpace<3>& cells, const ElementTable<3>& table, int donor, int target) {
  const Frame frame = frame_of(table, donor);
  const FieldElement<3>& field = cells.elements[static_cast<std::size_t>(donor)];
  const int degree = std::min(field.degree[0], field.degree[1]);
  const Eigen::MatrixXd have = coefficients(cells, table, donor, frame, degree);
  const Eigen::MatrixXd wanted = coefficients(cells, table, target, frame, degree);
  return least_shares(have.transpose(), wanted.transpose());
}

}  // namespace isorim::solver
