#pragma once

#include "geometry/fitting/fit_frame.h"

namespace isorim::geometry {

/// Moves the free knots of a curve by one step of Levenberg and Marquardt's method for the mean squared distance plus
/// the fairness term, parameters held, control points and knots varying together (the control points are then solved
/// for anew: variable projection in Kaufman's form, BIT 15, 1975). The derivative of a spline with respect to a knot is
/// a spline on the knots with that knot doubled (Piegl & Tiller, Computing the derivative of NURBS with respect to a
/// knot, CAGD 15, 1998). No knot moves by more than 0.4 of the distance to its neighbour.
///
/// The state must hold the control points of its knots, parameters and fairness. `damping` is relative and carried from
/// step to step. False if no step lowers the sum; the state is then as it was. O(points + knots).
template <int Dim>
bool move_knots(const FitFrame<Dim>& frame, const Fairness& fairness, FitState<Dim>& state, double& damping);

/// What move_knots() lowers.
template <int Dim>
double fit_objective(const FitFrame<Dim>& frame, const Fairness& fairness, const FitState<Dim>& state);

/// The integral of |C^(derivative)|^2 over the domain, with the factors of `fairness` but without mu.
template <int Dim>
double roughness(const FitFrame<Dim>& frame, const Fairness& fairness, const FitState<Dim>& state);

}  // namespace isorim::geometry
