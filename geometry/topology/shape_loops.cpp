#include "geometry/topology/shape_loops.h"

namespace isorim::geometry {

ShapeLoops::ShapeLoops(const SurfaceShape& shape) {
  const auto* extracted = std::get_if<ExtractedSurface>(&shape);
  if (!extracted) {
    surface_ = &surface_of(shape);
    loops_ = trim_loops(shape);
    return;
  }
  elements_.reserve(extracted->elements().size());
  loops_.reserve(extracted->elements().size());
  for (std::size_t e = 0; e < extracted->elements().size(); ++e) {
    elements_.push_back(bezier_surface(*extracted, static_cast<int>(e)));
    loops_.push_back(domain_loop(elements_.back()));
  }
}

std::vector<const NurbsSurface<3>*> ShapeLoops::surfaces() const {
  if (elements_.empty()) return {surface_};
  std::vector<const NurbsSurface<3>*> all;
  for (const NurbsSurface<3>& element : elements_) all.push_back(&element);
  return all;
}

std::vector<ShapeLoops> shape_loops(const Boundary<3>& boundary) {
  std::vector<ShapeLoops> loops;
  loops.reserve(boundary.patches.size());
  for (const Patch<3>& patch : boundary.patches) loops.emplace_back(patch.shape);
  return loops;
}

}  // namespace isorim::geometry
