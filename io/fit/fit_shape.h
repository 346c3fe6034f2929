#pragma once

#include "io/case/fit_keys.h"
#include "io/case/shape_builder.h"
#include "io/fit/fit_facts.h"

namespace isorim::io {

struct FitShape {
  AnyBoundary boundary;
  FitFacts facts;
};

/// Reads the points, puts them in order, fits the curves and, for sections or slices, skins the body. Throws InputError
/// with file, line and key of the case, and with file and line of the points where these are at fault: what
/// read_points() refuses, and whatever reduction, order, fit and body find wrong.
FitShape build_fit_shape(const FitKeys& keys);

}  // namespace isorim::io
