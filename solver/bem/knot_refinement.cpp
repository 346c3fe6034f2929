#include "solver/bem/knot_refinement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

namespace isorim::solver {

namespace {

using geometry::Direction;
using geometry::NurbsCurve;
using geometry::NurbsSurface;

/// Increasing, each once.
void make_unique(std::vector<double>& knots) {
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
}

void refine(geometry::Patch<2>& patch, const std::array<std::vector<double>, 1>& knots) {
  patch.shape = geometry::refine_knots(patch.shape, knots[0]);
}

void refine(geometry::Patch<3>& patch, const std::array<std::vector<double>, 2>& knots) {
  const auto* surface = std::get_if<NurbsSurface<3>>(&patch.shape);
  if (!surface)
    throw InputError(
        fmt::format("patch '{}': found marked elements of a trimmed or extracted surface; expected a whole "
                    "NURBS surface, into which knots can be inserted",
                    patch.name));
  const NurbsSurface<3> half = geometry::refine_knots(*surface, Direction::u, knots[0]);
  patch.shape = geometry::refine_knots(half, Direction::v, knots[1]);
}

NurbsCurve<2> raised(const NurbsCurve<2>& curve, int degree) {
  return curve.degree() < degree ? geometry::elevate_degree(curve, degree - curve.degree()) : curve;
}

geometry::SurfaceShape raised(const geometry::SurfaceShape& shape, int degree) {
  const auto* surface = std::get_if<NurbsSurface<3>>(&shape);
  if (!surface) return shape;
  NurbsSurface<3> result = *surface;
  for (const Direction direction : {Direction::u, Direction::v}) {
    const int missing = degree - result.knots(direction).degree();
    if (missing > 0) result = geometry::elevate_degree(result, direction, missing);
  }
  return result;
}

}  // namespace

template <int Dim>
geometry::OrientedBoundary<Dim> bisect_elements(const geometry::OrientedBoundary<Dim>& boundary,
                                                const FieldSpace<Dim>& space, std::span<const int> marked) {
  std::vector<std::array<std::vector<double>, Dim - 1>> knots(boundary.boundary.patches.size());
  for (const int element : marked) {
    const geometry::BezierElement<Dim>& bezier = space.table.elements[static_cast<std::size_t>(element)];
    for (std::size_t d = 0; d < Dim - 1; ++d)
      knots[static_cast<std::size_t>(bezier.patch)][d].push_back(bezier.domain[d].middle());
  }
  geometry::OrientedBoundary<Dim> refined = boundary;
  for (std::size_t p = 0; p < knots.size(); ++p) {
    if (knots[p][0].empty()) continue;
    for (std::vector<double>& in_direction : knots[p]) make_unique(in_direction);
    refine(refined.boundary.patches[p], knots[p]);
  }
  return refined;
}

template <int Dim>
geometry::OrientedBoundary<Dim> raise_degree(const geometry::OrientedBoundary<Dim>& boundary, int degree) {
  geometry::OrientedBoundary<Dim> result = boundary;
  for (geometry::Patch<Dim>& patch : result.boundary.patches) patch.shape = raised(patch.shape, degree);
  return result;
}

template geometry::OrientedBoundary<2> bisect_elements(const geometry::OrientedBoundary<2>&, const FieldSpace<2>&,
                                                       std::span<const int>);
template geometry::OrientedBoundary<3> bisect_elements(const geometry::OrientedBoundary<3>&, const FieldSpace<3>&,
                                                       std::span<const int>);
template geometry::OrientedBoundary<2> raise_degree(const geometry::OrientedBoundary<2>&, int);
template geometry::OrientedBoundary<3> raise_degree(const geometry::OrientedBoundary<3>&, int);

}  // namespace isorim::solver
