#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "solver/bem/line_space.h"
#include "solver/bem/patch_space.h"
#include "solver/bem/smoothness.h"

/// Tensor-product splines on a curve or a whole surface.
namespace isorim::solver {

/// The breakpoints and `levels` times the midpoints between them.
std::vector<double> bisected(std::span<const double> breakpoints, int levels);

/// The field's knots in one parameter, clamped. At a knot of the geometry functions are as smooth as the geometry, at
/// the other breakpoints C^(p - 1), and they may jump at `jumps` (increasing, among the breakpoints).
geometry::KnotVector field_knots(const geometry::KnotVector& geometry, int degree, std::span<const double> breakpoints,
                                 std::span<const double> jumps);

/// Products of the lines' functions, w_a N_a / W or N_a, some of them added up to one.
template <int Dim>
struct TensorSpace {
  std::array<LineSpace, Dim - 1> lines;
  /// Coefficients of the geometry's weight function W in the B-splines, the first parameter fastest; empty: the
  /// functions are polynomials.
  Eigen::VectorXd weights;
  /// For each B-spline, the first parameter fastest, the function that it is a part of.
  std::vector<std::int32_t> number;
  /// For each function the B-spline whose collocation point is taken.
  std::vector<std::int32_t> representative;
};

/// shape: of which the knots of `lines` are refinements. Functions are continued across smooth seams (the lines say
/// so), and those that differ at a smooth pole alone become one.
TensorSpace<2> tensor_space(const geometry::NurbsCurve<2>& shape, std::array<LineSpace, 1> lines);
TensorSpace<3> tensor_space(const geometry::NurbsSurface<3>& shape, std::array<LineSpace, 2> lines,
                            const PatchSmoothness<3>& smooth);

/// The functions of one cell of the knots' grid (the first parameter fastest).
struct CellFunctions {
  std::vector<std::int32_t> functions;
  /// Bernstein coefficients, one column a function; polynomial: as in an element of equal weights, divided out.
  Eigen::MatrixXd rows;
};
template <int Dim>
std::vector<std::int32_t> functions_on(const TensorSpace<Dim>& space, std::size_t cell);
template <int Dim>
CellFunctions cell_functions(const TensorSpace<Dim>& space, std::size_t cell, bool polynomial);

/// Where the collocation point of a function is.
template <int Dim>
typename PatchSpace<Dim>::Place collocation_place(const TensorSpace<Dim>& space, std::int32_t function);

/// Rows and points; elements: those of the refined patch, for which the functions are N_a / w with the elements' own
/// weight functions.
template <int Dim>
PatchSpace<Dim> patch_space(const TensorSpace<Dim>& space, std::span<const geometry::BezierElement<Dim>> elements);

}  // namespace isorim::solver
