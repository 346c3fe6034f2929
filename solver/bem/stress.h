#pragma once

#include <Eigen/Core>

namespace isorim::solver {

/// The von Mises stress of a tensor: 3 x 3, or 2 x 2 with the stress across the plane (the other components across it
/// vanish).
double von_mises(const Eigen::Ref<const Eigen::MatrixXd>& stress, double stress_across = 0.0);

/// The principal stresses of a symmetric tensor, increasing; in the plane those in it.
Eigen::VectorXd principal_stresses(const Eigen::Ref<const Eigen::MatrixXd>& stress);

}  // namespace isorim::solver
