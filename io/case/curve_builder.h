#pragma once

#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"
#include "io/case/shape_keys.h"

/// From the keys of curves to curves. Every function throws InputError that begins with file, line and key.
namespace isorim::io {

/// "case.toml:12: geometry.loops[1]: message".
[[noreturn]] void refuse(const KeyPlace& where, std::string_view message);

/// Calls `build`; a GeometryError becomes an InputError that says where.
template <class Build>
auto located(const KeyPlace& where, Build&& build) {
  try {
    return build();
  } catch (const GeometryError& error) {
    refuse(where, error.what());
  }
}

/// Throws unless there are exactly Dim coordinates.
template <int Dim>
geometry::Point<Dim> point_of(const Coordinates& coordinates);
template <int Dim>
geometry::Points<Dim> points_of(const std::vector<Coordinates>& coordinates);

/// The map that the list of transforms amounts to, the first applied first.
template <int Dim>
geometry::AffineMap<Dim> affine_map(const OneOrMany<TransformKeys>& transforms);

template <int Dim>
geometry::NurbsCurve<Dim> nurbs_curve(const NurbsCurveKeys& keys);

/// The curves of a shape of the plane, its transform applied; several for a rectangle or polygon.
std::vector<geometry::NurbsCurve<2>> plane_curves(const CurveKeys& keys);

/// The same in space: what is given by plane coordinates lies in z = 0 before its transform.
std::vector<geometry::NurbsCurve<3>> space_curves(const CurveKeys& keys);

/// As space_curves, joined to one curve.
geometry::NurbsCurve<3> single_space_curve(const CurveKeys& keys);

/// The keys that every alternative has.
template <class Variant>
const ShapeKeys& common_keys(const Variant& keys) {
  return std::visit([](const auto& shape) -> const ShapeKeys& { return shape; }, keys);
}

}  // namespace isorim::io
