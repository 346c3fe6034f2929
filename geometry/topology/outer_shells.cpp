#include "geometry/topology/outer_shells.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace isorim::geometry {

OrientedBoundary<3> outer_shells(const OrientedBoundary<3>& solid) {
  const std::vector<Shell<3>>& shells = solid.topology.shells;
  if (std::ranges::none_of(shells, [](const Shell<3>& shell) { return shell.is_void; })) return solid;
  Boundary<3> rest;
  for (const Shell<3>& shell : shells)
    for (const int patch : shell.patches)
      if (!shell.is_void) rest.patches.push_back(solid.boundary.patches[static_cast<std::size_t>(patch)]);
  // A body in a void is now one in a body, which orient() takes for a void.
  return outer_shells(orient(rest));
}

}  // namespace isorim::geometry
