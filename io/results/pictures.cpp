#include "io/results/pictures.h"

#include <variant>
#include <vector>

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

}  // namespace isorim::io
