#include <array>
#include <cstddef>

#include "geometry/bezier/element_jet.h"
#include "solver/bem/field_space.h"

namespace isorim::solver {

using geometry::BernsteinJet;
using geometry::Point;

namespace {

constexpr int largest_count = (geometry::KnotVector::max_degree + 1) * (geometry::KnotVector::max_degree + 1);

/// The products of Bernstein polynomials of a cell, the first parameter fastest, and their derivatives by each
/// coordinate: n x Dim; on the stack.
template <int Dim>
using BernsteinProducts = Eigen::Matrix<double, Eigen::Dynamic, Dim, Eigen::ColMajor, largest_count, Dim>;

template <int Dim>
void fill_products(const std::array<std::int8_t, Dim - 1>& degree, const Point<Dim - 1>& place,
                   BernsteinProducts<Dim>& products) {
  const BernsteinJet u = geometry::bernstein_jet(degree[0], place(0));
  const Eigen::Index p = degree[0] + 1;
  if constexpr (Dim == 2) {
    products.resize(p, 2);
    for (Eigen::Index i = 0; i < p; ++i) {
      products(i, 0) = u.values[static_cast<std::size_t>(i)];
      products(i, 1) = u.derivatives[static_cast<std::size_t>(i)];
    }
  } else {
    const BernsteinJet v = geometry::bernstein_jet(degree[1], place(1));
    const Eigen::Index q = degree[1] + 1;
    products.resize(p * q, 3);
    for (Eigen::Index j = 0; j < q; ++j)
      for (Eigen::Index i = 0; i < p; ++i) {
        const std::size_t a = static_cast<std::size_t>(i);
        const std::size_t b = static_cast<std::size_t>(j);
        products(i + p * j, 0) = u.values[a] * v.values[b];
        products(i + p * j, 1) = u.derivatives[a] * v.values[b];
        products(i + p * j, 2) = u.values[a] * v.derivatives[b];
      }
  }
}

/// The element's rows, one a column.
template <int Dim>
Eigen::Map<const Eigen::MatrixXd> rows_of(const FieldSpace<Dim>& space, const FieldElement<Dim>& field) {
  return {space.rows.data() + field.row, field.bernstein_count(), field.count};
}

/// Value and derivatives of the element's weight function.
template <int Dim>
Eigen::Matrix<double, 1, Dim> weight_jet(const FieldSpace<Dim>& space, int element, const Point<Dim - 1>& place) {
  const geometry::BezierElement<Dim>& geometry = space.table.elements[static_cast<std::size_t>(element)];
  BernsteinProducts<Dim> products;
  fill_products<Dim>(geometry.degree, place, products);
  return space.table.net_matrix(geometry).row(Dim).lazyProduct(products);
}

}  // namespace

template <int Dim>
void basis_values(const FieldSpace<Dim>& space, int element, const Point<Dim - 1>& place, std::span<double> values) {
  const FieldElement<Dim>& field = space.elements[static_cast<std::size_t>(element)];
  BernsteinProducts<Dim> products;
  fill_products<Dim>(field.degree, place, products);
  Eigen::Map<Eigen::VectorXd> result(values.data(), field.count);
  result.noalias() = rows_of(space, field).transpose().lazyProduct(products.col(0));
  if (field.rational) result /= weight_jet(space, element, place)(0);
}

template <int Dim>
Eigen::Matrix<double, Eigen::Dynamic, Dim> basis_jets(const FieldSpace<Dim>& space, int element,
                                                      const Point<Dim - 1>& place) {
  const FieldElement<Dim>& field = space.elements[static_cast<std::size_t>(element)];
  BernsteinProducts<Dim> products;
  fill_products<Dim>(field.degree, place, products);
  Eigen::Matrix<double, Eigen::Dynamic, Dim> jets = rows_of(space, field).transpose().lazyProduct(products);
  if (!field.rational) return jets;
  const Eigen::Matrix<double, 1, Dim> weight = weight_jet(space, element, place);
  jets.col(0) /= weight(0);
  for (Eigen::Index d = 1; d < Dim; ++d) jets.col(d) = (jets.col(d) - weight(d) * jets.col(0)) / weight(0);
  return jets;
}

template void basis_values(const FieldSpace<2>&, int, const Point<1>&, std::span<double>);
template void basis_values(const FieldSpace<3>&, int, const Point<2>&, std::span<double>);
template Eigen::Matrix<double, Eigen::Dynamic, 2> basis_jets(const FieldSpace<2>&, int, const Point<1>&);
template Eigen::Matrix<double, Eigen::Dynamic, 3> basis_jets(const FieldSpace<3>&, int, const Point<2>&);

}  // namespace isorim::solver
