#pragma once

#include <Eigen/Core>

#include "geometry/spline/knot_vector.h"

namespace isorim::geometry {

/// (p + 1) x (Orders + 1), column d the d-th derivatives; lives on the stack.
template <int Orders>
using LocalBasisTable =
    Eigen::Matrix<double, Eigen::Dynamic, Orders + 1, Eigen::ColMajor, KnotVector::max_degree + 1, Orders + 1>;

/// The p + 1 functions that live on the span of one parameter.
template <int Orders>
struct LocalBasis {
  /// Index of the first of them.
  int first = 0;
  LocalBasisTable<Orders> table;
};

/// Fills table, (p + 1) x (orders + 1): the transpose of basis_derivatives(), orders given by its columns.
void fill_basis_table(const KnotVector& knots, int span, double u, Eigen::Ref<Eigen::MatrixXd> table);

/// Basis functions and derivatives at u without touching the heap; limits at breakpoints as everywhere.
template <int Orders>
LocalBasis<Orders> local_basis(const KnotVector& knots, double u) {
  LocalBasis<Orders> basis;
  const int span = knots.find_span(u);
  basis.first = span - knots.degree();
  basis.table.resize(knots.degree() + 1, Orders + 1);
  fill_basis_table(knots, span, u, basis.table);
  return basis;
}

}  // namespace isorim::geometry
