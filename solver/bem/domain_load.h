#pragma once

#include <span>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"

namespace isorim::solver {

/// A load in the domain, brought to the boundary by the radial integration method with the pole at the target: rays run
/// from the target to the nodes, and the fundamental solution's singularity cancels against the Jacobian of the rays
/// (Gao 2002). The load's function has to be defined on the rays, which leave a domain that is not convex.
template <int Dim>
class DomainLoad {
 public:
  virtual ~DomainLoad() = default;

  /// What to sum with the nodes' weights to get int_Omega U(x, y) b(y) dOmega: components x nodes.
  virtual void potential(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                         Eigen::Ref<Eigen::MatrixXd> values) const = 0;
  /// Likewise for the derivatives by the target's coordinates: (Dim * components) x nodes, row k * components + i.
  virtual void gradient(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                        Eigen::Ref<Eigen::MatrixXd> values) const = 0;
  /// int_Omega b dOmega and its moments are the caller's, by quadrature/rim.h; b at a point: components numbers.
  virtual void density(const geometry::Point<Dim>& point, std::span<double> values) const = 0;
};

}  // namespace isorim::solver
