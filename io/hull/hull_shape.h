#pragma once

#include "io/case/hull_keys.h"
#include "io/case/shape_builder.h"
#include "io/hull/hull_facts.h"

namespace isorim::io {

struct HullShape {
  BuiltBoundary<3> boundary;
  HullFacts facts;
};

/// Reads the offsets, scales and shifts them and makes the closed hull. Throws InputError with file, line and key of
/// the case, and with file and line of the offsets where these are at fault.
HullShape build_hull_shape(const HullKeys& keys);

}  // namespace isorim::io
