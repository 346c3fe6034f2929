#pragma once

#include <vector>

#include <Eigen/Core>

#include "quadrature/target_rules.h"
#include "solver/bem/field_space.h"
#include "solver/bem/solve.h"

namespace isorim::io {

/// The solution at the nodes of one element's rule: components x nodes.
template <int Dim>
struct BoundarySample {
  quadrature::NodeView<Dim> nodes;
  /// From the coefficients: of prescribed data what the space makes of them.
  Eigen::MatrixXd value;
  Eigen::MatrixXd flux;
};

/// Samples a solution on the boundary, element by element; an object serves one thread.
template <int Dim>
class BoundarySampler {
 public:
  /// The arguments must outlive the object.
  BoundarySampler(const solver::FieldSpace<Dim>& space, const solver::Solution<Dim>& solution,
                  const quadrature::TargetRules<Dim>& rules);

  /// At the nodes of the rule for targets about an element's size away: products of the fields are integrated far
  /// better than the fields are known.
  const BoundarySample<Dim>& sample(int element);

 private:
  const solver::FieldSpace<Dim>* space_;
  const solver::Solution<Dim>* solution_;
  const quadrature::TargetRules<Dim>* rules_;
  BoundarySample<Dim> sample_;
  std::vector<double> basis_;
};

/// Values of the fields with the given coefficients (functions x components) at a place of an element.
template <int Dim>
Eigen::VectorXd field_at(const solver::FieldSpace<Dim>& space, const Eigen::MatrixXd& coefficients, int element,
                         const geometry::Point<Dim - 1>& place, std::vector<double>& basis);

/// Rules that suit a space.
template <int Dim>
quadrature::TargetRules<Dim> sampling_rules(const solver::FieldSpace<Dim>& space);

}  // namespace isorim::io
