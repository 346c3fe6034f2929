#pragma once

#include "geometry/fitting/fit_frame.h"

namespace isorim::geometry {

/// The curve of FitMethod::free with this number of distinct control points.
template <int Dim>
FitState<Dim> free_fit(const FitFrame<Dim>& frame, int control_points);

}  // namespace isorim::geometry
