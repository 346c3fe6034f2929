#pragma once

#include <Eigen/Core>

#include "solver/bem/assembly.h"

namespace isorim::solver {

/// Coefficients in x, y, z of a solution's two fields: function_count x components.
struct FieldCoefficients {
  Eigen::MatrixXd potential;
  Eigen::MatrixXd flux;
};

/// From the unknowns of an Assembler (size() numbers) and the known data of the problem with this number, which are
/// interpolated at the collocation points: one sparse factorisation of the functions' values there. Throws
/// NumericalError if it is singular.
template <int Dim>
FieldCoefficients field_coefficients(const Assembler<Dim>& assembler, const Eigen::Ref<const Eigen::VectorXd>& unknowns,
                                     int problem = 0);

}  // namespace isorim::solver
