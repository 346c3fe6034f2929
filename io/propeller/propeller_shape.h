#pragma once

#include "io/case/shape_builder.h"
#include "io/case/shape_keys.h"
#include "io/propeller/propeller_facts.h"

namespace isorim::io {

struct PropellerShape {
  BuiltBoundary<3> boundary;
  PropellerFacts facts;
};

/// The screw of the keys, moved, cut and named as they say. Throws InputError that begins with file, line and key.
PropellerShape build_propeller_shape(const PropellerKeys& keys);

}  // namespace isorim::io
