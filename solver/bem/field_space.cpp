#include "solver/bem/field_space.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/bezier/subdivision.h"
#include "geometry/errors.h"
#include "solver/bem/bodies.h"
#include "solver/bem/extracted_space.h"
#include "solver/bem/hierarchical_space.h"
#include "solver/bem/patch_space.h"
#include "solver/bem/smoothness.h"
#include "solver/bem/tensor_space.h"
#include "solver/bem/trimmed_space.h"

namespace isorim::solver {

using geometry::BezierElement;
using geometry::Boundary;
using geometry::ElementTable;
using geometry::ExtractedSurface;
using geometry::ExtractionElement;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::OrientedBoundary;
using geometry::Patch;
using geometry::Point;
using geometry::TrimmedSurface;

namespace {

/// What is asked of one patch; degree absent: the geometry's.
struct PatchRequest {
  std::optional<int> degree;
  int refine = 0;

  int degree_over(const KnotVector& geometry) const { return degree.value_or(std::max(2, geometry.degree())); }
};

template <int Dim>
void require_in_range(const PatchRequest& request, const std::string& where) {
  using Options = DiscretisationOptions<Dim>;
  if (request.degree && (*request.degree < 1 || *request.degree > Options::max_degree))
    throw InputError(fmt::format("{}: the degree of the functions is {}; expected 1 to {}", where, *request.degree,
                                 Options::max_degree));
  if (request.refine < 0 || request.refine > Options::max_refine)
    throw InputError(
        fmt::format("{}: refine is {}; expected 0 to {} bisections", where, request.refine, Options::max_refine));
}

template <int Dim>
std::vector<PatchRequest> patch_requests(const Boundary<Dim>& boundary, const DiscretisationOptions<Dim>& options) {
  const PatchRequest general{options.degree, options.refine};
  require_in_range<Dim>(general, "discretisation");
  std::vector<PatchRequest> requests(boundary.patches.size(), general);
  for (const auto& [name, special] : options.patches) {
    const auto patch = std::ranges::find(boundary.patches, name, &Patch<Dim>::name);
    if (patch == boundary.patches.end()) {
      std::vector<std::string> names;
      for (const Patch<Dim>& known : boundary.patches) names.push_back(fmt::format("\"{}\"", known.name));
      throw InputError(
          fmt::format("discretisation: there is no patch \"{}\"; the patches are {}", name, fmt::join(names, ", ")));
    }
    PatchRequest& request = requests[static_cast<std::size_t>(patch - boundary.patches.begin())];
    if (special.degree) request.degree = special.degree;
    if (special.refine) request.refine = *special.refine;
    require_in_range<Dim>(request, fmt::format("discretisation of patch \"{}\"", name));
  }
  return requests;
}

std::vector<double> new_knots(const KnotVector& knots, int levels) {
  const std::vector<double> old = knots.breakpoints();
  const std::vector<double> all = bisected(old, levels);
  std::vector<double> added;
  std::ranges::set_difference(all, old, std::back_inserter(added));
  return added;
}

NurbsCurve<2> refined(const NurbsCurve<2>& curve, int levels) {
  const NurbsCurve<2> clamped = clamp(curve);
  return refine_knots(clamped, new_knots(clamped.knots(), levels));
}

NurbsSurface<3> refined(const NurbsSurface<3>& surface, int levels) {
  using geometry::Direction;
  const NurbsSurface<3> clamped = clamp(surface);
  const NurbsSurface<3> in_u = refine_knots(clamped, Direction::u, new_knots(clamped.knots_u(), levels));
  return refine_knots(in_u, Direction::v, new_knots(clamped.knots_v(), levels));
}

geometry::SurfaceShape refined(const geometry::SurfaceShape& shape, int levels) {
  if (const auto* face = std::get_if<TrimmedSurface>(&shape))
    return TrimmedSurface(refined(face->surface(), levels), face->loops());
  if (const auto* extracted = std::get_if<ExtractedSurface>(&shape)) return bisected(*extracted, levels);
  return refined(std::get<NurbsSurface<3>>(shape), levels);
}

/// The group of every element.
template <int Dim>
std::vector<int> element_groups(const ElementTable<Dim>& table, const DiscretisationOptions<Dim>& options) {
  std::vector<int> groups(table.elements.size(), 0);
  if (!options.group) return groups;
  for (std::size_t e = 0; e < groups.size(); ++e) {
    const BezierElement<Dim>& element = table.elements[e];
    const auto jet = evaluate_jet<Dim>(table, element, Point<Dim - 1>::Constant(0.5));
    groups[e] = options.group(element.patch, jet.position, jet.normal());
  }
  return groups;
}

/// The groups of a patch's cells; no_group where nothing is kept.
struct GroupGrid {
  static constexpr int no_group = std::numeric_limits<int>::min();
  std::vector<int> groups;
  std::array<std::size_t, 2> count{1, 1};

  int at(int d, std::size_t across, std::size_t along) const {
    return groups[d == 0 ? across + count[0] * along : along + count[0] * across];
  }
  static bool differ(int a, int b) { return a != b && a != no_group && b != no_group; }
  bool differ(int d, std::size_t before, std::size_t after) const {
    for (std::size_t along = 0; along < count[static_cast<std::size_t>(1 - d)]; ++along)
      if (differ(at(d, before, along), at(d, after, along))) return true;
    return false;
  }
};

/// Where functions may jump: at creases and between groups.
std::vector<double> jumps(std::span<const double> breakpoints, std::span<const double> creases, const GroupGrid& groups,
                          int d) {
  std::vector<double> result(creases.begin(), creases.end());
  for (std::size_t i = 1; i + 1 < breakpoints.size(); ++i)
    if (groups.differ(d, i - 1, i)) result.push_back(breakpoints[i]);
  std::ranges::sort(result);
  return result;
}

/// The line's splines on `fine`, a refinement of the breakpoints of level 0, whose cells the groups are of.
LineSpace field_line(const KnotVector& geometry, int degree, std::span<const double> breakpoints,
                     std::span<const double> fine, std::span<const double> creases, bool closed,
                     const GroupGrid& groups, int d) {
  const bool periodic = closed && !groups.differ(d, breakpoints.size() - 2, 0);
  return line_space(field_knots(geometry, degree, fine, jumps(breakpoints, creases, groups, d)), periodic);
}

/// A patch in the table of elements of level 0.
template <int Dim>
struct PatchElements {
  int patch = 0;
  const ElementTable<Dim>& table;
  std::size_t first = 0;
  /// One for each element.
  std::span<const int> groups;
  const geometry::Topology<Dim>& topology;
  const CellTree<Dim>* tree = nullptr;

  std::span<const BezierElement<Dim>> elements() const {
    return std::span(table.elements).subspan(first, groups.size());
  }
};

/// Its groups, in the order of the cells.
GroupGrid group_grid(const NurbsCurve<2>&, const PatchRequest&, const PatchElements<2>& refined) {
  return {{refined.groups.begin(), refined.groups.end()}, {refined.groups.size(), 1}};
}

/// leaves: the curve's elements, bisected as they may be.
PatchSpace<2> spline_space(const NurbsCurve<2>& curve, const PatchRequest& request, const PatchElements<2>& patch,
                           std::span<const BezierElement<2>> leaves) {
  const NurbsCurve<2> shape = clamp(curve);
  const PatchSmoothness<2> smooth = smoothness(shape);
  const std::vector<double> breakpoints = bisected(shape.knots().breakpoints(), request.refine);
  std::vector<double> fine;
  for (const BezierElement<2>& leaf : leaves) fine.push_back(leaf.domain[0].first);
  fine.push_back(breakpoints.back());
  const LineSpace line = field_line(shape.knots(), request.degree_over(shape.knots()), breakpoints, fine,
                                    smooth.creases[0], smooth.closed[0], group_grid(shape, request, patch), 0);
  return patch_space<2>(tensor_space(shape, {line}), leaves);
}

std::array<std::vector<double>, 2> breakpoints_of(const NurbsSurface<3>& surface, const PatchRequest& request) {
  return {bisected(surface.knots_u().breakpoints(), request.refine),
          bisected(surface.knots_v().breakpoints(), request.refine)};
}

/// The cells of a surface by their groups, some without one.
GroupGrid group_grid(const NurbsSurface<3>& surface, const PatchRequest& request, const PatchElements<3>& refined) {
  const std::array<std::vector<double>, 2> breakpoints = breakpoints_of(surface, request);
  GroupGrid grid;
  for (std::size_t d = 0; d < 2; ++d) grid.count[d] = breakpoints[d].size() - 1;
  grid.groups.assign(grid.count[0] * grid.count[1], GroupGrid::no_group);
  const auto index = [&](std::size_t d, double u) {
    const auto& lines = breakpoints[d];
    return static_cast<std::size_t>(std::upper_bound(lines.begin() + 1, lines.end() - 1, u) - lines.begin()) - 1;
  };
  const std::span<const BezierElement<3>> elements = refined.elements();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto& domain = elements[e].domain;
    grid.groups[index(0, domain[0].middle()) + grid.count[0] * index(1, domain[1].middle())] = refined.groups[e];
  }
  return grid;
}

TensorSpace<3> whole_space(const NurbsSurface<3>& surface, const PatchRequest& request, const GroupGrid& grid,
                           int level = 0) {
  const NurbsSurface<3> shape = clamp(surface);
  const PatchSmoothness<3> smooth = smoothness(shape);
  const std::array<std::vector<double>, 2> breakpoints = breakpoints_of(shape, request);
  const auto line = [&](std::size_t d) {
    const KnotVector& knots = shape.knots(d == 0 ? geometry::Direction::u : geometry::Direction::v);
    return field_line(knots, request.degree_over(knots), breakpoints[d], bisected(breakpoints[d], level),
                      smooth.creases[d], smooth.closed[d], grid, static_cast<int>(d));
  };
  return tensor_space(shape, {line(0), line(1)}, smooth);
}

/// The same functions with other numbers, at the end of the space.
void append(PatchSpace<3>& space, const PatchSpace<3>& part) {
  const int first_element = static_cast<int>(space.elements.size());
  const std::int32_t first_function = static_cast<std::int32_t>(space.points.size());
  for (FieldElement<3> element : part.elements) {
    element.first += space.functions.size();
    element.row += space.rows.size();
    space.elements.push_back(element);
  }
  for (const std::int32_t function : part.functions) space.functions.push_back(first_function + function);
  space.rows.insert(space.rows.end(), part.rows.begin(), part.rows.end());
  for (const auto& point : part.points) space.points.push_back({first_element + point.element, point.place});
}

/// Whether the surface's own functions are what is asked for.
bool takes_own_functions(const ExtractedSurface& surface, const PatchRequest& request) {
  return request.refine == 0 && std::ranges::all_of(surface.elements(), [&](const ExtractionElement& element) {
           const int least = std::min(element.degree[0], element.degree[1]);
           const int most = std::max(element.degree[0], element.degree[1]);
           return request.degree ? least == *request.degree && most == *request.degree : least >= 2;
         });
}

/// The space on a whole surface: of tensor products, or locally refined; leaves: its elements.
PatchSpace<3> spline_space(const NurbsSurface<3>& shape, const PatchRequest& request, const PatchElements<3>& patch,
                           std::span<const BezierElement<3>> leaves) {
  const GroupGrid grid = group_grid(shape, request, patch);
  if (!patch.tree || patch.tree->levels() == 1) return patch_space<3>(whole_space(shape, request, grid), leaves);
  std::vector<TensorSpace<3>> levels;
  for (int level = 0; level < patch.tree->levels(); ++level) levels.push_back(whole_space(shape, request, grid, level));
  return hierarchical_space<3>(*patch.tree, levels, leaves);
}

/// A patch's space by the kind of its shape.
struct SurfaceSpace {
  const PatchRequest& request;
  const PatchElements<3>& patch;
  std::span<const BezierElement<3>> leaves;

  PatchSpace<3> operator()(const NurbsSurface<3>& surface) const {
    return spline_space(surface, request, patch, leaves);
  }
  PatchSpace<3> operator()(const TrimmedSurface& face) const {
    return trimmed_space(whole_space(face.surface(), request, group_grid(face.surface(), request, patch)),
                         TrimmedSurface(refined(face.surface(), request.refine), face.loops()), patch.elements(),
                         patch.table.regions);
  }
  PatchSpace<3> operator()(const ExtractedSurface& surface) const {
    if (takes_own_functions(surface, request))
      return extracted_space(
          surface, smooth_regions(surface, patch.patch, patch.topology.edges, patch.table, patch.first, patch.groups),
          patch.elements());
    // Every element by itself.
    const std::size_t side = std::size_t{1} << request.refine;
    PatchSpace<3> space;
    for (std::size_t e = 0; e < surface.elements().size(); ++e) {
      const std::span<const int> groups = patch.groups.subspan(e * side * side, side * side);
      const GroupGrid grid{{groups.begin(), groups.end()}, {side, side}};
      append(space, patch_space<3>(whole_space(bezier_surface(surface, static_cast<int>(e)), request, grid),
                                   patch.elements().subspan(e * side * side, side * side)));
    }
    return space;
  }
};

PatchSpace<3> patch_space(const geometry::SurfaceShape& shape, const PatchRequest& request,
                          const PatchElements<3>& patch, std::span<const BezierElement<3>> leaves) {
  return std::visit(SurfaceSpace{request, patch, leaves}, shape);
}

PatchSpace<2> patch_space(const NurbsCurve<2>& curve, const PatchRequest& request, const PatchElements<2>& patch,
                          std::span<const BezierElement<2>> leaves) {
  return spline_space(curve, request, patch, leaves);
}

/// Cells of level 0 in each direction; nothing for patches that cannot be refined locally.
std::optional<std::array<int, 1>> cell_counts(const NurbsCurve<2>& curve, const PatchRequest& request) {
  return {{static_cast<int>(curve.knots().breakpoints().size() - 1) << request.refine}};
}
std::optional<std::array<int, 2>> cell_counts(const geometry::SurfaceShape& shape, const PatchRequest& request) {
  const auto* surface = std::get_if<NurbsSurface<3>>(&shape);
  if (!surface) return std::nullopt;
  return {{static_cast<int>(surface->knots_u().breakpoints().size() - 1) << request.refine,
           static_cast<int>(surface->knots_v().breakpoints().size() - 1) << request.refine}};
}

/// The bisected cells of every patch that can have such.
template <int Dim>
std::vector<std::optional<CellTree<Dim>>> cell_trees(const Boundary<Dim>& boundary,
                                                     const std::vector<PatchRequest>& requests,
                                                     const DiscretisationOptions<Dim>& options) {
  std::vector<std::vector<GridCell<Dim>>> cells(requests.size());
  for (const auto& bisected : options.bisected) {
    const bool is_known = bisected.patch >= 0 && bisected.patch < static_cast<int>(requests.size());
    if (!is_known || !cell_counts(boundary.patches[static_cast<std::size_t>(bisected.patch)].shape,
                                  requests[static_cast<std::size_t>(bisected.patch)]))
      throw InputError(fmt::format("local refinement: patch {} is no curve or whole surface", bisected.patch));
    if (bisected.cell.level + 1 >= DiscretisationOptions<Dim>::max_local_levels)
      throw InputError(fmt::format("local refinement: a cell of level {} is bisected; expected levels below {}",
                                   bisected.cell.level, DiscretisationOptions<Dim>::max_local_levels - 1));
    cells[static_cast<std::size_t>(bisected.patch)].push_back(bisected.cell);
  }
  std::vector<std::optional<CellTree<Dim>>> trees;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto counts = cell_counts(boundary.patches[i].shape, requests[i]);
    if (counts)
      trees.emplace_back(CellTree<Dim>(*counts, std::move(cells[i])));
    else
      trees.emplace_back(std::nullopt);
  }
  return trees;
}

/// Appends the part of an element of level 0 that is the cell.
template <int Dim>
void append_part(ElementTable<Dim>& table, const ElementTable<Dim>& from, BezierElement<Dim> element,
                 const GridCell<Dim>& cell) {
  const std::span<const double> whole = from.net(element);
  element.offset = table.nets.size();
  table.nets.insert(table.nets.end(), whole.begin(), whole.end());
  std::array<int, Dim - 1> degrees;
  for (std::size_t d = 0; d + 1 < Dim; ++d) degrees[d] = element.degree[d];
  for (std::size_t d = 0; d + 1 < Dim && cell.level > 0; ++d) {
    const std::int64_t count = std::int64_t{1} << cell.level;
    const double width = 1.0 / static_cast<double>(count);
    const double index = static_cast<double>(cell.index[d] % count);
    const geometry::Interval part{index * width, (index + 1.0) * width};
    geometry::restrict_net(std::span(table.nets).subspan(element.offset), Dim + 1, degrees, static_cast<int>(d), part);
    const geometry::Interval domain = element.domain[d];
    element.domain[d] = {domain.first + part.first * domain.length(), domain.first + part.last * domain.length()};
  }
  table.elements.push_back(element);
}

/// The leaves of a patch with their groups, at the end of the space's table.
template <int Dim>
void append_leaves(FieldSpace<Dim>& space, const PatchElements<Dim>& patch) {
  const std::span<const BezierElement<Dim>> coarse = patch.elements();
  const CellTree<Dim>* tree = patch.tree;
  const GridCell<Dim> none{-1, {}};
  if (!tree) {
    for (const BezierElement<Dim>& element : coarse) {
      append_part<Dim>(space.table, patch.table, element, none);
      space.cells.push_back(none);
    }
    space.groups.insert(space.groups.end(), patch.groups.begin(), patch.groups.end());
    return;
  }
  for (const GridCell<Dim>& leaf : tree->leaves()) {
    std::size_t index = static_cast<std::size_t>(leaf.index[0] >> leaf.level);
    if constexpr (Dim == 3)
      index += static_cast<std::size_t>(leaf.index[1] >> leaf.level) * static_cast<std::size_t>(tree->counts()[0]);
    append_part<Dim>(space.table, patch.table, coarse[index], leaf);
    space.cells.push_back(leaf);
    space.groups.push_back(patch.groups[index]);
  }
}

/// Appends a patch whose elements begin at `first_element` of the table.
template <int Dim>
void append(FieldSpace<Dim>& space, const PatchSpace<Dim>& patch) {
  const std::size_t first_element = space.elements.size();
  const std::int32_t first_function = static_cast<std::int32_t>(space.points.size());
  for (FieldElement<Dim> element : patch.elements) {
    element.first += space.functions.size();
    element.row += space.rows.size();
    space.elements.push_back(element);
  }
  for (const std::int32_t function : patch.functions) space.functions.push_back(first_function + function);
  space.rows.insert(space.rows.end(), patch.rows.begin(), patch.rows.end());
  for (const auto& point : patch.points) {
    const std::size_t element = first_element + static_cast<std::size_t>(point.element);
    const auto jet = evaluate_jet<Dim>(space.table, space.table.elements[element], point.place);
    space.points.push_back({static_cast<int>(element), point.place, jet.position, jet.normal()});
  }
}

template <int Dim>
void set_bodies(const OrientedBoundary<Dim>& oriented, const ElementTable<Dim>& table, FieldSpace<Dim>& space) {
  space.body_of_patch = bodies_of_patches(oriented.topology, table);
  for (std::size_t i = space.body_of_patch.size(); i-- > 0;) {
    const auto body = static_cast<std::size_t>(space.body_of_patch[i]);
    if (space.bodies.size() <= body) space.bodies.resize(body + 1);
    space.bodies[body] = oriented.boundary.patches[i].name;
  }
}

}  // namespace

namespace {

double cell_count(const NurbsCurve<2>& curve) {
  return static_cast<double>(curve.knots().breakpoints().size() - 1);
}
double cell_count(const geometry::SurfaceShape& shape) {
  if (const auto* extracted = std::get_if<ExtractedSurface>(&shape))
    return static_cast<double>(extracted->elements().size());
  const NurbsSurface<3>& surface = geometry::surface_of(shape);
  return static_cast<double>(surface.knots_u().breakpoints().size() - 1) *
         static_cast<double>(surface.knots_v().breakpoints().size() - 1);
}

/// Before memory is taken for them.
template <int Dim>
void require_few_elements(const Boundary<Dim>& boundary, const std::vector<PatchRequest>& requests) {
  double count = 0.0;
  for (std::size_t i = 0; i < requests.size(); ++i)
    count += std::ldexp(cell_count(boundary.patches[i].shape), (Dim - 1) * requests[i].refine);
  if (count > DiscretisationOptions<Dim>::max_elements)
    throw InputError(fmt::format("discretisation: the bisections make {:.0f} elements; expected no more than {}", count,
                                 DiscretisationOptions<Dim>::max_elements));
}

}  // namespace

template <int Dim>
FieldSpace<Dim> field_space(const OrientedBoundary<Dim>& oriented, const DiscretisationOptions<Dim>& options) {
  const Boundary<Dim>& boundary = oriented.boundary;
  const std::vector<PatchRequest> requests = patch_requests(boundary, options);
  require_few_elements(boundary, requests);
  Boundary<Dim> fine = boundary;
  for (std::size_t i = 0; i < requests.size(); ++i)
    fine.patches[i].shape = refined(boundary.patches[i].shape, requests[i].refine);
  const std::vector<std::optional<CellTree<Dim>>> trees = cell_trees(boundary, requests, options);
  const ElementTable<Dim> table = bezier_elements(fine);
  const std::vector<int> groups = element_groups(table, options);
  FieldSpace<Dim> space;
  space.table.regions = table.regions;
  std::size_t first = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    std::size_t count = 0;
    while (first + count < table.elements.size() && table.elements[first + count].patch == static_cast<std::int32_t>(i))
      ++count;
    const PatchElements<Dim> patch{static_cast<int>(i),
                                   table,
                                   first,
                                   std::span<const int>(groups).subspan(first, count),
                                   oriented.topology,
                                   trees[i] ? &*trees[i] : nullptr};
    const std::size_t begin = space.table.elements.size();
    append_leaves<Dim>(space, patch);
    const std::span<const BezierElement<Dim>> leaves = std::span(std::as_const(space.table.elements)).subspan(begin);
    try {
      append<Dim>(space, patch_space(boundary.patches[i].shape, requests[i], patch, leaves));
    } catch (Error& error) {
      error.add_context(fmt::format("patch \"{}\"", boundary.patches[i].name));
      throw;
    }
    first += count;
  }
  set_bodies(oriented, table, space);
  space.coarse = coarse_table(boundary, space.table);
  return space;
}

namespace {

/// Bisects the patch as a whole.
template <int Dim>
void refine_patch(DiscretisationOptions<Dim>& options, const std::string& name, int refine) {
  auto special = std::ranges::find(options.patches, name, [](const auto& entry) { return entry.first; });
  if (special == options.patches.end()) special = options.patches.insert(special, {name, {}});
  special->second.refine = refine;
}

/// In cells: how far around a bisected one levels differ by one at most.
int grading_radius(const NurbsCurve<2>&, const PatchRequest&) {
  return 1;
}
int grading_radius(const geometry::SurfaceShape& shape, const PatchRequest& request) {
  const NurbsSurface<3>& surface = std::get<NurbsSurface<3>>(shape);
  const int degree = std::max(request.degree_over(surface.knots_u()), request.degree_over(surface.knots_v()));
  return (degree + 1) / 2;
}

}  // namespace

template <int Dim>
DiscretisationOptions<Dim> refine_locally(const OrientedBoundary<Dim>& oriented,
                                          const DiscretisationOptions<Dim>& options, const FieldSpace<Dim>& space,
                                          std::span<const int> marked) {
  const Boundary<Dim>& boundary = oriented.boundary;
  const std::vector<PatchRequest> requests = patch_requests(boundary, options);
  const std::vector<std::optional<CellTree<Dim>>> trees = cell_trees(boundary, requests, options);
  std::vector<std::vector<GridCell<Dim>>> cells(requests.size());
  for (const int e : marked) {
    const auto element = static_cast<std::size_t>(e);
    if (space.cells[element].level + 2 <= DiscretisationOptions<Dim>::max_local_levels)
      cells[static_cast<std::size_t>(space.table.elements[element].patch)].push_back(space.cells[element]);
  }
  DiscretisationOptions<Dim> result = options;
  result.bisected.clear();
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (!trees[i]) {
      if (!cells[i].empty() && requests[i].refine < DiscretisationOptions<Dim>::max_refine)
        refine_patch(result, boundary.patches[i].name, requests[i].refine + 1);
      continue;
    }
    const int radius = grading_radius(boundary.patches[i].shape, requests[i]);
    for (const GridCell<Dim>& cell : graded<Dim>(*trees[i], cells[i], radius))
      result.bisected.push_back({static_cast<int>(i), cell});
  }
  return result;
}

template DiscretisationOptions<2> refine_locally(const OrientedBoundary<2>&, const DiscretisationOptions<2>&,
                                                 const FieldSpace<2>&, std::span<const int>);
template DiscretisationOptions<3> refine_locally(const OrientedBoundary<3>&, const DiscretisationOptions<3>&,
                                                 const FieldSpace<3>&, std::span<const int>);
template FieldSpace<2> field_space(const OrientedBoundary<2>&, const DiscretisationOptions<2>&);
template FieldSpace<3> field_space(const OrientedBoundary<3>&, const DiscretisationOptions<3>&);

}  // namespace isorim::solver
