#pragma once

#include <span>
#include <vector>

#include "geometry/fitting/spline_least_squares.h"

namespace isorim::geometry {

/// Rules for `count` knots inside (first, last) of one smooth piece of an open curve, whose data have the parameters
/// given (increasing, ends of the piece among them).
///
/// Equal spans.
std::vector<double> uniform_knots(double first, double last, int count);
/// Means of p successive parameters, as for interpolation (Piegl & Tiller, eq. 9.8), of count + p + 1 parameters: those
/// given, or evenly chosen ones (by linear interpolation in their index) if there are more. If there are fewer (as with
/// end conditions), the first one counts up to 1 + at_start times, the last one as often as need be.
std::vector<double> averaged_knots(std::span<const double> parameters, int degree, int count, int at_start = 0);
/// As many data in every span (Piegl & Tiller, eqs. 9.68 and 9.69).
std::vector<double> piegl_tiller_knots(std::span<const double> parameters, int count);

/// Breakpoints b_0 < .. < b_n = b_0 + 1 of a closed curve of n spans, b_0 >= -1/2, whose data have the parameters
/// given, the first of which is 0 and follows the last one after the closing chord.
///
/// As many data in every span; b_0 = 0.
std::vector<double> closed_piegl_tiller_knots(std::span<const double> parameters, int count);
/// At the data for odd degrees, halfway between them for even ones; with fewer knots than data at evenly chosen places.
/// With as many knots as data there is exactly one interpolating spline.
std::vector<double> closed_averaged_knots(std::span<const double> parameters, int degree, int count);

}  // namespace isorim::geometry
