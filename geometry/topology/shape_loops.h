#pragma once

#include <cstddef>
#include <vector>

#include "geometry/boundary.h"

namespace isorim::geometry {

/// The loops that bound a patch, each in the parameters of the surface that carries it.
///
/// A whole or trimmed surface carries the loops that trim_loops() tells. Every element of an extracted surface is a
/// surface of its own, over the unit square, and its four sides (s: along t = 0, up s = 1, back along t = 1, down
/// s = 0) are one loop: the index of the loop is that of the element, the index of the curve that of the side. Sides
/// inside the surface meet other elements, or several of them, as those of patches do.
class ShapeLoops {
 public:
  /// The shape has to outlive it.
  explicit ShapeLoops(const SurfaceShape& shape);

  std::size_t size() const { return loops_.size(); }
  const TrimLoop& loop(int index) const { return loops_[static_cast<std::size_t>(index)]; }
  const NurbsSurface<3>& surface(int loop) const {
    return elements_.empty() ? *surface_ : elements_[static_cast<std::size_t>(loop)];
  }
  const NurbsCurve<2>& curve(int loop, int index) const {
    return this->loop(loop).curves[static_cast<std::size_t>(index)];
  }
  /// Every surface once.
  std::vector<const NurbsSurface<3>*> surfaces() const;

 private:
  const NurbsSurface<3>* surface_ = nullptr;
  std::vector<NurbsSurface<3>> elements_;
  std::vector<TrimLoop> loops_;
};

/// Of every patch, which have to outlive them.
std::vector<ShapeLoops> shape_loops(const Boundary<3>& boundary);

}  // namespace isorim::geometry
