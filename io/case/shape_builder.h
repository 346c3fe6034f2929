#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/tspline/tmesh.h"
#include "io/case/shape_keys.h"

namespace isorim::io {

/// What the author of a case said a loop is.
struct LoopClaim {
  /// Index of a patch of the loop.
  int patch = 0;
  LoopRole role = LoopRole::any;
  KeyPlace where;
};

template <int Dim>
struct BuiltBoundary {
  /// As the case gives it: not oriented yet, patch names unique.
  geometry::Boundary<Dim> boundary;
  std::vector<LoopClaim> claims;
  /// Of the patches that were extracted from T-splines of the case, in their order.
  std::vector<geometry::TMesh> meshes = {};
};

using AnyBoundary = std::variant<BuiltBoundary<2>, BuiltBoundary<3>>;

/// 2 if the shape is a region of the plane, 3 if it is a solid; empty for a file, which has to be read to know.
std::optional<int> dimension(const GeometryKeys& keys);

/// The shape moved by the keys' transform, its patches renamed after the keys' name.
template <int Dim>
geometry::Boundary<Dim> finished(geometry::Boundary<Dim> boundary, const ShapeKeys& keys);

/// The same for a solid, cut by the keys' clip between the two.
geometry::Boundary<3> finished_solid(geometry::Boundary<3> boundary, const SolidKeys& keys);

/// Builds the exact boundary of a shape of the plane (Dim = 2) or of space (Dim = 3); Dim must be the shape's
/// dimension(). Files are for build_file_shape() (file_shape.h). Throws InputError with all complaints at once, each
/// with file, line and key: knots that contradict themselves or the points, wrong numbers of coordinates, loops that
/// are open or without area, an axis that cuts a profile, ...
template <int Dim>
BuiltBoundary<Dim> build_boundary(const GeometryKeys& keys);

/// The loops of a region of the plane; each must close, without crossing itself, around something.
BuiltBoundary<2> build_region(const RegionKeys& keys);

}  // namespace isorim::io
