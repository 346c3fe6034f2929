#include "io/results/inspection.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <variant>

#include <fmt/format.h>

#include "solver/properties.h"

namespace isorim::io {
namespace {

std::vector<int> degrees(const geometry::Patch<2>& patch) {
  return {patch.shape.degree()};
}
std::vector<int> degrees(const geometry::Patch<3>& patch) {
  const auto* extracted = std::get_if<geometry::ExtractedSurface>(&patch.shape);
  if (!extracted) {
    const geometry::NurbsSurface<3>& surface = geometry::surface_of(patch.shape);
    return {surface.knots_u().degree(), surface.knots_v().degree()};
  }
  std::vector<int> highest{0, 0};
  for (const geometry::ExtractionElement& element : extracted->elements())
    for (const std::size_t d : {0u, 1u}) highest[d] = std::max<int>(highest[d], element.degree[d]);
  return highest;
}

bool is_trimmed(const geometry::Patch<2>& /*patch*/) {
  return false;
}
bool is_trimmed(const geometry::Patch<3>& patch) {
  return std::holds_alternative<geometry::TrimmedSurface>(patch.shape);
}

std::optional<InspectedExtraction> extraction_of(const geometry::Patch<2>& /*patch*/) {
  return std::nullopt;
}
std::optional<InspectedExtraction> extraction_of(const geometry::Patch<3>& patch) {
  const auto* extracted = std::get_if<geometry::ExtractedSurface>(&patch.shape);
  if (!extracted) return std::nullopt;
  InspectedExtraction result;
  result.functions = extracted->function_count();
  std::set<std::size_t> counts;
  for (const geometry::ExtractionElement& element : extracted->elements()) counts.insert(element.functions.size());
  result.functions_per_element.assign(counts.begin(), counts.end());
  for (const double defect : partition_defects(*extracted)) {
    result.partition_defect = std::max(result.partition_defect, defect);
    if (defect > geometry::partition_rounding) ++result.defective_elements;
  }
  return result;
}

void count_hanging_sides(const geometry::Topology<2>& /*topology*/, std::vector<InspectedPatch>& /*patches*/) {}
void count_hanging_sides(const geometry::Topology<3>& topology, std::vector<InspectedPatch>& patches) {
  std::map<std::tuple<int, int, int>, int> uses;
  for (const geometry::BoundaryEdge& edge : topology.edges)
    for (const geometry::EdgeUse* use : {&edge.first, &edge.second}) ++uses[{use->patch, use->loop, use->curve}];
  for (const auto& [side, count] : uses) {
    InspectedPatch& patch = patches[static_cast<std::size_t>(std::get<0>(side))];
    if (patch.extraction && count > 1) ++patch.extraction->hanging_sides;
  }
}

template <int Dim>
std::vector<InspectedPatch> patches_of(const Model<Dim>& model) {
  std::vector<InspectedPatch> patches;
  for (const geometry::Patch<Dim>& patch : model.oriented.boundary.patches) {
    patches.push_back({.name = patch.name,
                       .degrees = degrees(patch),
                       .polynomial = true,
                       .trimmed = is_trimmed(patch),
                       .extraction = extraction_of(patch),
                       .orientation = patch.orientation,
                       .origin = std::nullopt});
    if (!model.origins.empty()) patches.back().origin = model.origins[patches.size() - 1];
  }
  for (const geometry::BezierElement<Dim>& element : model.table.elements) {
    InspectedPatch& patch = patches[static_cast<std::size_t>(element.patch)];
    ++patch.elements;
    patch.polynomial = patch.polynomial && element.polynomial;
    if (element.is_cut()) ++patch.cut_elements;
  }
  count_hanging_sides(model.oriented.topology, patches);
  return patches;
}

template <int Dim>
std::vector<InspectedShell> shells_of(const Model<Dim>& model) {
  std::vector<InspectedShell> shells;
  for (const geometry::Shell<Dim>& shell : model.oriented.topology.shells) {
    shells.push_back({shell.closed, shell.is_void, {}});
    for (const int patch : shell.patches) {
      shells.back().patches.push_back(model.oriented.boundary.patches[static_cast<std::size_t>(patch)].name);
    }
  }
  return shells;
}

std::vector<double> list(const auto& point) {
  return {point.begin(), point.end()};
}

template <int Dim>
const geometry::Patch<Dim>& patch_at(const Model<Dim>& model, int index) {
  return model.oriented.boundary.patches[static_cast<std::size_t>(index)];
}

InspectedFreeEdge free_edge_of(const Model<2>& model, const geometry::FreeEdge<2>& edge) {
  InspectedFreeEdge result;
  result.patch = patch_at(model, edge.patch).name;
  result.place = edge.side == 0 ? "start" : "end";
  result.from = list(edge.from);
  result.to = list(edge.to);
  return result;
}

std::string place_of(const geometry::Patch<3>& patch, const geometry::FreeEdge<3>& edge) {
  constexpr std::array<const char*, 4> sides{"v = first", "u = last", "v = last", "u = first"};
  constexpr std::array<const char*, 4> cell_sides{"t = 0", "s = 1", "t = 1", "s = 0"};
  const auto side = static_cast<std::size_t>(edge.curve);
  if (is_trimmed(patch)) return fmt::format("loop {}, curve {}", edge.loop + 1, edge.curve + 1);
  if (std::holds_alternative<geometry::ExtractedSurface>(patch.shape))
    return fmt::format("{} of element {}", cell_sides[side], edge.loop);
  return sides[side];
}

InspectedFreeEdge free_edge_of(const Model<3>& model, const geometry::FreeEdge<3>& edge) {
  const geometry::Patch<3>& patch = patch_at(model, edge.patch);
  InspectedFreeEdge result;
  result.patch = patch.name;
  result.place = place_of(patch, edge);
  result.from = list(edge.from);
  result.to = list(edge.to);
  result.length = edge.length;
  if (edge.nearest >= 0) {
    const auto& nearest = model.oriented.topology.free_edges[static_cast<std::size_t>(edge.nearest)];
    result.nearest = patch_at(model, nearest.patch).name;
    result.gap = edge.gap;
  }
  return result;
}

template <int Dim>
std::vector<InspectedFreeEdge> free_edges_of(const Model<Dim>& model) {
  std::vector<InspectedFreeEdge> edges;
  for (const geometry::FreeEdge<Dim>& edge : model.oriented.topology.free_edges) {
    edges.push_back(free_edge_of(model, edge));
  }
  return edges;
}

/// From the boundary alone.
template <int Dim>
void add_closure(const Model<Dim>& model, const RunOptions& run, GeometrySummary& summary) {
  solver::PropertyOptions<Dim> options;
  options.integration.tolerance = 1e-9;
  options.integration.threads = run.threads;
  options.scope = solver::PropertyOptions<Dim>::Scope::boundary_only;
  const solver::GeometricProperties<Dim> properties = solver::geometric_properties(model.table, options);
  summary.closure_defect = properties.closure_defect;
  summary.pole_shift = properties.pole_shift;
}

}  // namespace

Inspection inspect(const CaseFile& file, const AnyModel& model, const RunOptions& options) {
  Inspection inspection;
  inspection.title = file.title();
  inspection.cad = file.cad;
  inspection.geometry = summarise(model);
  std::visit(
      [&](const auto& known) {
        add_closure(known, options, *inspection.geometry);
        inspection.patches = patches_of(known);
        inspection.shells = shells_of(known);
        inspection.free_edges = free_edges_of(known);
      },
      model);
  return inspection;
}

}  // namespace isorim::io
