#pragma once

#include "geometry/boundary.h"
#include "io/case/shape_keys.h"

namespace isorim::io {

/// The screw of the keys. Throws InputError that begins with file, line and key.
geometry::Boundary<3> propeller(const PropellerKeys& keys);

}  // namespace isorim::io
