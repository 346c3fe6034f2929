#pragma once

#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/topology/orientation.h"
#include "geometry/tspline/extracted_surface.h"
#include "solver/bem/patch_space.h"

/// Spaces on surfaces that are given by Bézier extraction (T-splines).
namespace isorim::solver {

/// The same surface with every element bisected `levels` times in both directions: 4^levels for each in its place, the
/// first parameter fastest. The functions stay what they are.
geometry::ExtractedSurface bisected(const geometry::ExtractedSurface& surface, int levels);

/// For each element the number of the region that it belongs to: elements of one group that hang together across edges
/// without a crease. edges: those of the boundary's topology; where the surface has none among them, elements that
/// share functions hang together. A crease that ends inside the surface divides nothing.
std::vector<int> smooth_regions(const geometry::ExtractedSurface& surface, int patch,
                                std::span<const geometry::BoundaryEdge> edges, const geometry::ElementTable<3>& table,
                                std::size_t first_element, std::span<const int> groups);

/// The surface's own functions w_a N_a / W, each as many times as there are regions that it lives on. Points by
/// require_points() throughout. elements: those of the table.
PatchSpace<3> extracted_space(const geometry::ExtractedSurface& surface, std::span<const int> regions,
                              std::span<const geometry::BezierElement<3>> elements);

}  // namespace isorim::solver
