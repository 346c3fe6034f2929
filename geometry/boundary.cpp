#include "geometry/boundary.h"

namespace isorim::geometry {

const NurbsSurface<3>& surface_of(const SurfaceShape& shape) {
  if (const auto* trimmed = std::get_if<TrimmedSurface>(&shape)) return trimmed->surface();
  return std::get<NurbsSurface<3>>(shape);
}

std::vector<TrimLoop> trim_loops(const SurfaceShape& shape) {
  if (const auto* trimmed = std::get_if<TrimmedSurface>(&shape)) return trimmed->loops();
  return {domain_loop(std::get<NurbsSurface<3>>(shape))};
}

SurfaceShape transform(const SurfaceShape& shape, const AffineMap<3>& map) {
  return std::visit([&](const auto& known) -> SurfaceShape { return transform(known, map); }, shape);
}

}  // namespace isorim::geometry
