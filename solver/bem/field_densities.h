#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"
#include "solver/bem/boundary_data.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"

namespace isorim::solver {

/// Both fields at some points, in x, y, z: n x components each.
struct Densities {
  Eigen::MatrixXd potential;
  Eigen::MatrixXd flux;
};

/// What a solution is at points of one element: unknown fields from their coefficients, prescribed ones from the
/// conditions' own functions, the flux of a Robin condition from the potential. An object serves one thread; the
/// arguments of the constructor must outlive it.
template <int Dim>
class FieldDensities {
 public:
  FieldDensities(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution);

  int components() const { return components_; }
  void at_nodes(int element, const quadrature::NodeView<Dim>& nodes, Densities& densities);
  /// At one place, where the boundary has that position and outward unit normal.
  void at_place(int element, const geometry::Point<Dim - 1>& place, const geometry::Point<Dim>& position,
                const geometry::Vector<Dim>& normal, Densities& densities);
  /// components x (Dim - 1): the derivatives of the potential by the cell's coordinates, from its coefficients.
  Eigen::MatrixXd potential_derivatives(int element, const geometry::Point<Dim - 1>& place);

 private:
  /// Makes `bernstein_` that of the element.
  void set_element(int element);
  void fill_products(int element, const quadrature::NodeView<Dim>& nodes);
  void interpolate(int element, Densities& densities);
  void prescribe(int element, Densities& densities) const;

  const Problem<Dim>* problem_;
  const FieldSpace<Dim>* space_;
  const Solution<Dim>* solution_;
  int components_;
  BoundaryData<Dim> data_;
  ConditionValues<Dim> values_;
  /// Functions of the element x 1.
  Eigen::MatrixXd basis_;
  Eigen::MatrixXd coefficients_;
  /// Of which element `bernstein_` is; -1: of none.
  int element_ = -1;
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Components of the potential, then of the flux, by the products of Bernstein polynomials, the first parameter
  /// fastest.
  RowMatrix bernstein_;
  /// Those products at nodes, and the fields: rows padded to product_lanes.
  std::vector<double> products_;
  std::vector<double> fields_;
  std::array<std::vector<double>, Dim - 1> polynomials_;
  std::vector<double> reciprocal_weight_;
  std::vector<double> room_;
};

}  // namespace isorim::solver
