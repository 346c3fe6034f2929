#include "solver/bem/stress.h"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace isorim::solver {

double von_mises(const Eigen::Ref<const Eigen::MatrixXd>& stress, double stress_across) {
  Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
  whole(2, 2) = stress_across;
  whole.topLeftCorner(stress.rows(), stress.cols()) = stress;
  const Eigen::Matrix3d deviator = whole - whole.trace() / 3.0 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

Eigen::VectorXd principal_stresses(const Eigen::Ref<const Eigen::MatrixXd>& stress) {
  if (stress.rows() == 2) {
    const Eigen::Matrix2d plane = stress;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(plane, Eigen::EigenvaluesOnly).eigenvalues();
  }
  const Eigen::Matrix3d space = stress;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(space, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace isorim::solver
