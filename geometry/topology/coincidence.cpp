#include "geometry/topology/coincidence.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {

template <int Dim>
double coincidence_tolerance(const BoundingBox<Dim>& box, double relative) {
  constexpr double smallest = 1e-60;
  constexpr double largest = 1e60;
  const double farthest = std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
  const double size = (box.upper - box.lower).stableNorm();
  if (size == 0.0) throw GeometryError("all points of the boundary coincide");
  if (!(size >= smallest && size <= largest)) {
    throw GeometryError(
        fmt::format("the boundary has the size {:.3g}; expected a size from {} to {} (choose other units)", size,
                    smallest, largest));
  }
  const double tolerance = relative * size;
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * farthest;
  if (tolerance < rounding) {
    throw GeometryError(fmt::format(
        "points nearer than {:.2g} are to count as the same, but coordinates up to {:.3g} are rounded by {:.2g}; "
        "expected a larger closure tolerance, or the shape of size {:.3g} nearer to the origin",
        tolerance, farthest, rounding, size));
  }
  return tolerance;
}

template double coincidence_tolerance(const BoundingBox<2>&, double);
template double coincidence_tolerance(const BoundingBox<3>&, double);

}  // namespace isorim::geometry
