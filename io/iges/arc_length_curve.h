#pragma once

#include "io/iges/curves.h"

namespace isorim::io::iges {

/// The same curve with its relative arc length in [0, 1] as parameter. Exact for lines, whose parameter it is already,
/// for circular arcs (their angle) and for curves without length (points); all others are fitted to the tolerance.
ParametrisedCurve by_relative_length(const ParametrisedCurve& curve, double tolerance);

}  // namespace isorim::io::iges
