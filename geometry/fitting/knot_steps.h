#pragma once

#include "geometry/fitting/fit_frame.h"

namespace isorim::geometry {

/// Moves the free knots and all parameters of a curve by one step of Levenberg and Marquardt's method for the mean
/// squared distance plus the fairness term; the control points are then solved for anew.
///
/// The step is that of Gauss and Newton with control points, knots and parameters varying together, so it is one of
/// variable projection (Golub & Pereyra, SIAM J. Numer. Anal. 10, 1973). A parameter stands in the rows of its own
/// datum only and is eliminated there: what is left of a residual is its part across the curve (tangent distance
/// minimisation, Wang, Pottmann & Liu, ACM Trans. Graph. 25, 2006), so normal equations for control points and knots
/// remain, banded with a border. No knot moves by more than 0.4 of the distance to its neighbour, no parameter by more
/// than half its span.
///
/// The state must hold the control points of its knots and parameters, and the fairness term. `damping` is relative and
/// carried from step to step; it follows the ratio of the decrease to the expected one (Nielsen's rule; Madsen, Nielsen
/// & Tingleff, Methods for Non-Linear Least Squares Problems, 2004, section 3.2). False if no step lowers the sum; the
/// state is then as it was. O(points + knots).
template <int Dim>
bool move_knots(const FitFrame<Dim>& frame, FitState<Dim>& state, double& damping);

/// What move_knots() lowers; measures the state's distances.
template <int Dim>
double fit_objective(const FitFrame<Dim>& frame, FitState<Dim>& state);

/// The integral of |C^(derivative)|^2 over the domain, with the factors of `fairness` but without mu.
template <int Dim>
double roughness(const FitFrame<Dim>& frame, const Fairness& fairness, const FitState<Dim>& state);

}  // namespace isorim::geometry
