#include "geometry/boundary.h"

#include "geometry/errors.h"

namespace isorim::geometry {

namespace {

[[noreturn]] void refuse_extracted() {
  throw GeometryError(
      "the patch is a T-spline, given by its Bézier elements; expected a NURBS surface or a trimmed one");
}

}  // namespace

const NurbsSurface<3>& surface_of(const SurfaceShape& shape) {
  struct Carrier {
    const NurbsSurface<3>& operator()(const NurbsSurface<3>& surface) const { return surface; }
    const NurbsSurface<3>& operator()(const TrimmedSurface& face) const { return face.surface(); }
    const NurbsSurface<3>& operator()(const ExtractedSurface&) const { refuse_extracted(); }
  };
  return std::visit(Carrier{}, shape);
}

std::vector<TrimLoop> trim_loops(const SurfaceShape& shape) {
  if (const auto* trimmed = std::get_if<TrimmedSurface>(&shape)) return trimmed->loops();
  return {domain_loop(surface_of(shape))};
}

SurfaceShape transform(const SurfaceShape& shape, const AffineMap<3>& map) {
  return std::visit([&](const auto& known) -> SurfaceShape { return transform(known, map); }, shape);
}

}  // namespace isorim::geometry
