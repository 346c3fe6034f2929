#include "solver/bem/extension.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// The Bernstein polynomials of the field's degree over a part of a cell, divided by the cell's weight function.
class PartBasis {
 public:
  PartBasis(const PatchSpace<3>& cells, const ElementTable<3>& table, const CellPart& part)
      : cells_(cells), table_(table), part_(part), field_(cells.elements[static_cast<std::size_t>(part.cell)]) {}

  int degree(std::size_t d) const { return field_.degree[d]; }
  Point3 position(const Point2& place) const {
    return evaluate_jet<3>(table_, table_.elements[static_cast<std::size_t>(part_.cell)], in_cell(place)).position;
  }
  Eigen::RowVectorXd values(const Point2& place) const;
  /// Coefficients of functions of the position that are given at points: one column a function.
  template <class Functions>
  Eigen::MatrixXd interpolate(const Functions& functions) const;

 private:
  Point2 in_cell(const Point2& place) const {
    return {part_.within[0].first + place.x() * part_.within[0].length(),
            part_.within[1].first + place.y() * part_.within[1].length()};
  }

  const PatchSpace<3>& cells_;
  const ElementTable<3>& table_;
  const CellPart& part_;
  const FieldElement<3>& field_;
};

Eigen::RowVectorXd PartBasis::values(const Point2& place) const {
  const geometry::BernsteinJet u = geometry::bernstein_jet(degree(0), place.x());
  const geometry::BernsteinJet v = geometry::bernstein_jet(degree(1), place.y());
  std::vector<double> products(static_cast<std::size_t>(field_.count));
  numerators<3>(cells_, part_.cell, in_cell(place), products);
  const double weight = std::accumulate(products.begin(), products.end(), 0.0);
  Eigen::RowVectorXd result(field_.bernstein_count());
  Eigen::Index k = 0;
  for (std::size_t j = 0; j <= static_cast<std::size_t>(degree(1)); ++j)
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree(0)); ++i)
      result(k++) = u.values[i] * v.values[j] / weight;
  return result;
}

template <class Functions>
Eigen::MatrixXd PartBasis::interpolate(const Functions& functions) const {
  std::vector<Point2> places;
  for (const double t : quadrature::gauss_legendre(degree(1) + 1).nodes)
    for (const double s : quadrature::gauss_legendre(degree(0) + 1).nodes) places.emplace_back(s, t);
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd basis(count, count);
  Eigen::MatrixXd wanted(count, functions(position(places[0])).size());
  for (Eigen::Index k = 0; k < count; ++k) {
    basis.row(k) = values(places[static_cast<std::size_t>(k)]);
    wanted.row(k) = functions(position(places[static_cast<std::size_t>(k)]));
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(basis);
  Eigen::MatrixXd result = factors.solve(wanted);
  result += factors.solve(wanted - basis * result);
  return result;
}

/// Coordinates about the middle of a part, in units of its size.
Frame frame_of_part(const PartBasis& basis) {
  const Point3 middle = basis.position({0.5, 0.5});
  double size = 0.0;
  for (const double s : {0.0, 1.0})
    for (const double t : {0.0, 1.0}) size = std::max(size, (basis.position({s, t}) - middle).norm());
  return {middle, Eigen::Matrix3d::Identity() / size};
}

}  // namespace

PartFunctions fitted_functions(const PatchSpace<3>& cells, const ElementTable<3>& table, const CellPart& part,
                               std::span<const Point2> candidates) {
  constexpr double indistinct = 1e-5;
  const PartBasis basis(cells, table, part);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(candidates.size()), (basis.degree(0) + 1) * (basis.degree(1) + 1));
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    values.row(i) = basis.values(candidates[static_cast<std::size_t>(i)]);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(values.transpose());
  const Eigen::VectorXd pivots = factors.matrixQR().diagonal().cwiseAbs();
  const Eigen::Index count = (pivots.array() > indistinct * pivots(0)).count();
  PartFunctions result;
  Eigen::MatrixXd at_points(count, values.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index chosen = factors.colsPermutation().indices()(k);
    result.points.push_back(candidates[static_cast<std::size_t>(chosen)]);
    at_points.row(k) = values.row(chosen);
  }
  // The smallest coefficients that interpolate, then corrected to hold linear functions of the position.
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse(at_points);
  Eigen::MatrixXd rows = inverse.solve(Eigen::MatrixXd::Identity(count, count));
  rows += inverse.solve(Eigen::MatrixXd::Identity(count, count) - at_points * rows);
  const Frame frame = frame_of_part(basis);
  const Eigen::MatrixXd linear = basis.interpolate([&](const Point3& x) { return test_functions(frame.local(x), 1); });
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> known;
  known.setThreshold(indistinct);
  known.compute(at_points * linear);
  rows += (linear - rows * (at_points * linear)) * known.pseudoInverse();
  result.rows = rows.transpose();
  return result;
}

Eigen::MatrixXd continued_rows(const PatchSpace<3>& cells, const ElementTable<3>& table, const CellPart& donor,
                               const PartFunctions& functions, const CellPart& target) {
  const PartBasis from(cells, table, donor);
  const PartBasis to(cells, table, target);
  const Frame frame = frame_of(table, donor.cell);
  const int degree = std::min(from.degree(0), from.degree(1));
  const auto tests = [&](const Point3& x) { return test_functions(frame.local(x), degree); };
  const Eigen::MatrixXd wanted = to.interpolate(tests);
  Eigen::MatrixXd have(static_cast<Eigen::Index>(functions.points.size()), wanted.cols());
  for (Eigen::Index k = 0; k < have.rows(); ++k)
    have.row(k) = tests(from.position(functions.points[static_cast<std::size_t>(k)]));
  return least_shares(have.transpose(), wanted.transpose());
}

Eigen::MatrixXd extension(const PatchSpace<3>& cells, const ElementTable<3>& table, int donor, int target) {
  const Frame frame = frame_of(table, donor);
  const FieldElement<3>& field = cells.elements[static_cast<std::size_t>(donor)];
  const int degree = std::min(field.degree[0], field.degree[1]);
  const Eigen::MatrixXd have = coefficients(cells, table, donor, frame, degree);
  const Eigen::MatrixXd wanted = coefficients(cells, table, target, frame, degree);
  return least_shares(have.transpose(), wanted.transpose());
}

}  // namespace isorim::solver
