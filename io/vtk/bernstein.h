#pragma once

#include <Eigen/Core>

namespace isorim::io {

/// The degree + 1 Bernstein polynomials at t, by their recurrence.
inline Eigen::VectorXd bernstein(int degree, double t) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(degree + 1);
  values[0] = 1.0;
  for (int k = 1; k <= degree; ++k) {
    for (int i = k; i > 0; --i) values[i] = t * values[i - 1] + (1.0 - t) * values[i];
    values[0] *= 1.0 - t;
  }
  return values;
}

}  // namespace isorim::io
