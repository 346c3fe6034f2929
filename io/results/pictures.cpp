#include "io/results/pictures.h"

#include <cstddef>
#include <variant>
#include <vector>

#include "geometry/trimming/lifted_curve.h"
#include "io/svg/drawing.h"
#include "io/vtk/bezier_writer.h"

namespace isorim::io {

void write_boundary_vtu(const std::filesystem::path& path, const AnyModel& model) {
  std::visit(
      [&](const auto& known) {
        std::vector<std::string> names;
        for (const auto& patch : known.oriented.boundary.patches) names.push_back(patch.name);
        VtuContent content;
        content.patch_names = names;
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

bool has_free_edges(const AnyModel& model) {
  const auto* solid = std::get_if<Model<3>>(&model);
  return solid && !solid->oriented.topology.free_edges.empty();
}

void write_free_edges_vtu(const std::filesystem::path& path, const AnyModel& model) {
  const auto& solid = std::get<Model<3>>(model);
  const double tolerance = 1e-6 * geometry::bounding_box(solid.table).diagonal();
  std::vector<geometry::NurbsCurve<3>> curves;
  std::vector<std::string> names;
  for (const geometry::FreeEdge<3>& edge : solid.oriented.topology.free_edges) {
    const geometry::Patch<3>& patch = solid.oriented.boundary.patches[static_cast<std::size_t>(edge.patch)];
    const geometry::TrimLoop loop = geometry::trim_loops(patch.shape)[static_cast<std::size_t>(edge.loop)];
    const geometry::NurbsCurve<2>& pcurve = loop.curves[static_cast<std::size_t>(edge.curve)];
    curves.push_back(
        geometry::lift(geometry::surface_of(patch.shape), geometry::restrict_to(pcurve, edge.domain), tolerance));
    names.push_back(patch.name);
  }
  write_curves_vtu<3>(path, curves, names);
}

}  // namespace isorim::io
