#pragma once

#include <cstddef>

#include "geometry/bezier/element_table.h"

namespace isorim::quadrature::testing {

/// What `outer` encloses without what `inner` encloses.
template <int Dim>
geometry::ElementTable<Dim> hollow(const geometry::Boundary<Dim>& outer, const geometry::Boundary<Dim>& inner) {
  geometry::Boundary<Dim> both = outer;
  for (geometry::Patch<Dim> patch : inner.patches) {
    patch.orientation = -patch.orientation;
    both.patches.push_back(patch);
  }
  return geometry::bezier_elements(both);
}

}  // namespace isorim::quadrature::testing
