#include "io/results/pictures.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/tessellation/tessellation.h"
#include "geometry/topology/shape_loops.h"
#include "geometry/trimming/lifted_curve.h"
#include "io/stl/stl_writer.h"
#include "io/svg/drawing.h"
#include "io/svg/tmesh_drawing.h"
#include "io/vtk/bezier_writer.h"

namespace isorim::io {

namespace {

/// What a CAD file tells of the looks of its faces, element by element; empty where it tells nothing.
struct Looks {
  std::vector<double> colours;
  std::vector<double> levels;
};

template <int Dim>
Looks looks_of(const Model<Dim>& model) {
  constexpr Colour grey{0.8, 0.8, 0.8};
  const auto has_colour = [](const PatchOrigin& patch) { return patch.origin.colour.has_value(); };
  const auto has_level = [](const PatchOrigin& patch) { return patch.origin.level != 0; };
  const bool colours = std::ranges::any_of(model.origins, has_colour);
  const bool levels = std::ranges::any_of(model.origins, has_level);
  Looks looks;
  for (const auto& element : model.table.elements) {
    if (!colours && !levels) break;
    const CadOrigin& origin = model.origins[static_cast<std::size_t>(element.patch)].origin;
    const Colour colour = origin.colour.value_or(grey);
    if (colours) looks.colours.insert(looks.colours.end(), colour.begin(), colour.end());
    if (levels) looks.levels.push_back(origin.level);
  }
  return looks;
}

}  // namespace

void write_boundary_vtu(const std::filesystem::path& path, const AnyModel& model) {
  std::visit(
      [&](const auto& known) {
        std::vector<std::string> names;
        for (const auto& patch : known.oriented.boundary.patches) names.push_back(patch.name);
        const Looks looks = looks_of(known);
        VtuContent content;
        content.patch_names = names;
        if (!looks.colours.empty()) content.cell_fields.push_back({"colour", 3, looks.colours});
        if (!looks.levels.empty()) content.cell_fields.push_back({"level", 1, looks.levels});
        write_vtu(path, known.table, content);
      },
      model);
}

void write_boundary_svg(const std::filesystem::path& path, const std::string& title, const AnyModel& model) {
  const auto* plane = std::get_if<Model<2>>(&model);
  if (!plane) return;
  const svg::Drawing drawing{.title = title, .chains = svg::chains(plane->oriented), .x_label = "x", .y_label = "y"};
  svg::write_svg(path, drawing);
}

void write_tmesh_svgs(const std::filesystem::path& folder, const AnyBoundary& shape) {
  const auto* solid = std::get_if<BuiltBoundary<3>>(&shape);
  if (!solid || solid->meshes.empty()) return;
  auto mesh = solid->meshes.begin();
  std::set<std::string> taken;
  for (const auto& patch : solid->boundary.patches) {
    if (!std::holds_alternative<geometry::ExtractedSurface>(patch.shape)) continue;
    std::string name = patch.name;
    std::ranges::replace_if(
        name, [](unsigned char c) { return c < 128 && std::isalnum(c) == 0 && c != '-'; }, '_');
    std::string unique = name;
    for (int k = 2; !taken.insert(unique).second; ++k) unique = fmt::format("{}_{}", name, k);
    svg::write_svg(folder / ("tmesh_" + unique + ".svg"), *mesh++, "T-mesh of " + patch.name);
  }
}

bool has_free_edges(const AnyModel& model) {
  const auto* solid = std::get_if<Model<3>>(&model);
  return solid && !solid->oriented.topology.free_edges.empty();
}

bool has_edges(const AnyModel& model) {
  const auto* solid = std::get_if<Model<3>>(&model);
  return solid && !(solid->oriented.topology.edges.empty() && solid->oriented.topology.free_edges.empty());
}

namespace {

/// A stretch of a curve of a patch's loop, in space.
struct Stretch {
  int patch = 0;
  int loop = 0;
  int curve = 0;
  geometry::Interval domain;
};

/// Lifts stretches.
class EdgeLifter {
 public:
  explicit EdgeLifter(const Model<3>& model)
      : loops_(geometry::shape_loops(model.oriented.boundary)),
        tolerance_(1e-6 * geometry::bounding_box(model.table).diagonal()) {}

  geometry::NurbsCurve<3> lift(const Stretch& stretch) const {
    const geometry::ShapeLoops& loops = loops_[static_cast<std::size_t>(stretch.patch)];
    const geometry::NurbsCurve<2> pcurve =
        geometry::restrict_to(loops.curve(stretch.loop, stretch.curve), stretch.domain);
    return geometry::lift(loops.surface(stretch.loop), pcurve, tolerance_);
  }

 private:
  std::vector<geometry::ShapeLoops> loops_;
  double tolerance_;
};

/// Curves of a file and what is said about each.
struct EdgeCurves {
  std::vector<geometry::NurbsCurve<3>> curves;
  std::vector<std::string> names;
  std::vector<double> free;
  std::vector<double> gaps;
  /// Between two elements of one T-spline.
  std::vector<double> inner;

  void write(const std::filesystem::path& path) const {
    const std::vector<VtuField> fields{{"free", 1, free}, {"gap", 1, gaps}, {"inner", 1, inner}};
    write_curves_vtu<3>(path, curves, names, fields);
  }
};

bool is_t_spline(const geometry::Patch<3>& patch) {
  return std::holds_alternative<geometry::ExtractedSurface>(patch.shape);
}

void append_free_edges(const Model<3>& model, EdgeCurves& edges) {
  const EdgeLifter lifter(model);
  for (const geometry::FreeEdge<3>& edge : model.oriented.topology.free_edges) {
    edges.curves.push_back(lifter.lift({edge.patch, edge.loop, edge.curve, edge.domain}));
    edges.names.push_back(model.oriented.boundary.patches[static_cast<std::size_t>(edge.patch)].name);
    edges.free.push_back(1.0);
    edges.gaps.push_back(edge.nearest < 0 ? -1.0 : edge.gap);
    edges.inner.push_back(0.0);
  }
}

}  // namespace

void write_edges_vtu(const std::filesystem::path& path, const AnyModel& model) {
  const auto& solid = std::get<Model<3>>(model);
  const auto& patches = solid.oriented.boundary.patches;
  const EdgeLifter lifter(solid);
  EdgeCurves edges;
  for (const geometry::BoundaryEdge& edge : solid.oriented.topology.edges) {
    const geometry::EdgeUse& use = edge.first;
    edges.curves.push_back(lifter.lift({use.patch, use.loop, use.curve, use.domain}));
    edges.names.push_back(patches[static_cast<std::size_t>(use.patch)].name + ", " +
                          patches[static_cast<std::size_t>(edge.second.patch)].name);
    edges.free.push_back(0.0);
    edges.gaps.push_back(edge.gap);
    const bool is_inner = use.patch == edge.second.patch && use.loop != edge.second.loop;
    edges.inner.push_back(is_inner && is_t_spline(patches[static_cast<std::size_t>(use.patch)]) ? 1.0 : 0.0);
  }
  append_free_edges(solid, edges);
  edges.write(path);
}

void write_free_edges_vtu(const std::filesystem::path& path, const AnyModel& model) {
  EdgeCurves edges;
  append_free_edges(std::get<Model<3>>(model), edges);
  edges.write(path);
}

std::size_t write_boundary_stl(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model) {
  const auto* solid = std::get_if<Model<3>>(&model);
  if (!solid)
    throw InputError(
        fmt::format("{}: a mesh (.stl) is that of a solid, and this is a shape of the plane", file.path.string()));
  try {
    return write_stl(path, file.title(),
                     geometry::tessellate(solid->oriented, {.chord_tolerance = file.keys.output.stl_tolerance}));
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
}

}  // namespace isorim::io
