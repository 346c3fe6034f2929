#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "solver/bem/patch_space.h"

/// Extended splines: functions of which a trim leaves too little follow the functions of a sound cell nearby instead of
/// having coefficients of their own (K. Höllig, U. Reif & J. Wipper, Weighted extended B-spline approximation of
/// Dirichlet problems, SIAM J. Numer. Anal. 39, 2001).
namespace isorim::solver {

/// The share of each function of cell `donor` in those of cell `target`: rows as the donor's functions, columns as the
/// target's. A field whose coefficients in the target's functions are these shares of the donor's continues its smooth
/// fields: polynomials in space of the functions' degree p, of which the constants and linear ones are continued
/// exactly (if the space holds them), the others to the order p + 1. Of all such shares the smallest.
///
/// Unlike the polynomials of the parameters that are continued usually, these do not stop at knots of the geometry.
/// Cells are those of the whole surface and lie near each other on a smooth part of it.
Eigen::MatrixXd extension(const PatchSpace<3>& cells, const geometry::ElementTable<3>& table, int donor, int target);

}  // namespace isorim::solver
