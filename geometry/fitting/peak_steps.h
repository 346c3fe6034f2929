#pragma once

#include "geometry/fitting/fit_frame.h"

namespace isorim::geometry {

/// Lowers the largest distance of the data by up to `rounds` rounds of C. L. Lawson's method for minimax approximation
/// (Contributions to the theory of linear least maximum approximation, thesis, UCLA, 1961): in each of them the weights
/// of the data grow with their distances, by the factor 1 + (d / largest d)^2, and control points, knots and parameters
/// follow (move_knots()).
///
/// The state becomes the one with the least product of largest and root mean square distance, among those whose root
/// mean square is at most a tenth above that at the start and, in the plane, whose curvature changes its sign no more
/// often. It is left as it was if there is none. The state's fairness term stays. O(points + knots) each.
template <int Dim>
void lower_peaks(const FitFrame<Dim>& frame, int rounds, FitState<Dim>& state);

}  // namespace isorim::geometry
