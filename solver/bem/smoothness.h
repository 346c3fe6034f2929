#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

/// Where the tangent plane of a patch is continuous: across such places functions are continuous, elsewhere they jump,
/// since fluxes and tractions do.
namespace isorim::solver {

/// Normals that differ by more make a crease, in radians. Smaller kinks change the flux of a smooth field by no more
/// than this share.
inline constexpr double crease_angle = 1e-6;

/// A curve or whole surface of a patch.
template <int Dim>
using CarrierShape = std::conditional_t<Dim == 2, geometry::NurbsCurve<2>, geometry::NurbsSurface<3>>;

template <int Dim>
struct PatchSmoothness {
  /// For each direction the inner knots at which the normal jumps somewhere along the knot line.
  std::array<std::vector<double>, Dim - 1> creases;
  /// For each direction: the shape closes, with a continuous normal, and a basis continues across the seam.
  std::array<bool, Dim - 1> closed{};
  /// Side 2 d + e (e = 0: the first, 1: the last value of parameter d): it is a single point at which the surface has
  /// a tangent plane. (A cone's tip has none.)
  std::array<bool, 2 * (Dim - 1)> pole{};
};

PatchSmoothness<2> smoothness(const geometry::NurbsCurve<2>& curve);
PatchSmoothness<3> smoothness(const geometry::NurbsSurface<3>& surface);

/// Whether the normals of two elements differ at a point that both have.
template <int Dim>
bool has_crease(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& a,
                const geometry::Point<Dim - 1>& place_a, const geometry::BezierElement<Dim>& b,
                const geometry::Point<Dim - 1>& place_b);

}  // namespace isorim::solver
