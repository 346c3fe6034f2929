#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
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

/// A rectangle in a cell's unit square.
struct CellPart {
  int cell = 0;
  std::array<geometry::Interval, 2> within;
};

/// Functions of a part alone, with their points.
struct PartFunctions {
  /// Bernstein coefficients over the part of the functions times the cell's weight function: a row each.
  Eigen::MatrixXd rows;
  /// In the part's unit square; function i is 1 at point i and 0 at the others.
  std::vector<geometry::Point2> points;
};

/// Functions of the cell's degree that are fitted to what is kept of a part, of which `candidates` are places: however
/// small or thin that is, they are bounded there. They interpolate at approximate Fekete points; polynomials that can
/// hardly be told from the others on what is kept (to 1e-5) are left out, but for the constants and, if the cell's
/// functions hold them, the linear functions of the position.
PartFunctions fitted_functions(const PatchSpace<3>& cells, const geometry::ElementTable<3>& table, const CellPart& part,
                               std::span<const geometry::Point2> candidates);

/// The rows on another part of functions that are continued there like those of extension().
Eigen::MatrixXd continued_rows(const PatchSpace<3>& cells, const geometry::ElementTable<3>& table,
                               const CellPart& donor, const PartFunctions& functions, const CellPart& target);

}  // namespace isorim::solver
