#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"

namespace isorim::solver {

/// The solution at one point.
template <int Dim>
struct FieldValue {
  /// Potential (1) or displacement (Dim).
  Eigen::VectorXd value;
  /// components x Dim: row i is the gradient of component i.
  Eigen::MatrixXd gradient;
  /// Elasticity: the stress tensor (in the plane the components in it; the one across is in stress_across). Else 0 x 0.
  Eigen::MatrixXd stress;
  double stress_across = 0.0;
};

enum class Location { inside, outside, on_boundary };

template <int Dim>
struct PointEvaluation {
  Location location = Location::inside;
  /// Empty if the point lies outside the domain.
  FieldValue<Dim> field;
};

/// The solution anywhere in the domain and on its boundary, without loss of accuracy near the boundary: there a linear
/// solution that agrees with the field at the nearest boundary point is subtracted first. points: Dim x n.
template <int Dim>
std::vector<PointEvaluation<Dim>> evaluate_at(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                              const Solution<Dim>& solution,
                                              const Eigen::Ref<const geometry::Points<Dim>>& points, int threads = 0);

/// On the boundary itself: values as above from the boundary data alone (the gradient from the flux and the tangential
/// derivatives), and the flux or traction.
template <int Dim>
struct BoundaryValue {
  FieldValue<Dim> field;
  Eigen::VectorXd flux;
};
template <int Dim>
BoundaryValue<Dim> evaluate_on_boundary(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                        const Solution<Dim>& solution, int element,
                                        const geometry::Point<Dim - 1>& place);

}  // namespace isorim::solver
