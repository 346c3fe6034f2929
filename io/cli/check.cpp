#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/cli/commands.h"
#include "io/results/compute.h"
#include "io/results/table.h"

namespace isorim::cli {
namespace {

std::string point_text(const std::vector<double>& point) {
  return fmt::format("({})", fmt::join(point, ", "));
}

template <int Dim>
std::string point_text(const geometry::Point<Dim>& point) {
  return point_text(std::vector<double>(point.begin(), point.end()));
}

std::string degree_text(const geometry::Patch<2>& patch) {
  return fmt::format("{}", patch.shape.degree());
}
std::string degree_text(const geometry::Patch<3>& patch) {
  const geometry::NurbsSurface<3>& surface = geometry::surface_of(patch.shape);
  return fmt::format("{} x {}", surface.knots_u().degree(), surface.knots_v().degree());
}

bool is_polynomial(const geometry::Patch<2>& patch) {
  return patch.shape.is_polynomial();
}
bool is_polynomial(const geometry::Patch<3>& patch) {
  return geometry::surface_of(patch.shape).is_polynomial();
}

template <int Dim>
std::string patches_text(const io::Model<Dim>& model) {
  io::TextTable table({{"patch"}, {"degree"}, {"elements", io::Align::right}, {"kind"}, {"orientation"}});
  const auto& patches = model.oriented.boundary.patches;
  std::vector<std::size_t> counts(patches.size(), 0);
  for (const auto& element : model.table.elements) ++counts[std::size_t(element.patch)];
  for (std::size_t i = 0; i < patches.size(); ++i) {
    table.add_row({patches[i].name, degree_text(patches[i]), fmt::format("{}", counts[i]),
                   is_polynomial(patches[i]) ? "polynomial" : "rational",
                   patches[i].orientation > 0 ? "as given" : "reversed"});
  }
  return table.text(2);
}

template <int Dim>
std::string shells_text(const io::Model<Dim>& model) {
  std::string text;
  const auto& shells = model.oriented.topology.shells;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    std::vector<std::string> names;
    for (const int patch : shells[i].patches) names.push_back(model.oriented.boundary.patches[std::size_t(patch)].name);
    const char* kind = shells[i].is_void ? (Dim == 2 ? "hole" : "void") : "outer";
    text += fmt::format("  {} {} ({}, {}): {}\n", Dim == 2 ? "loop" : "shell", i + 1, kind,
                        shells[i].closed ? "closed" : "open", fmt::join(names, ", "));
  }
  return text;
}

template <int Dim>
std::string free_edges_text(const io::Model<Dim>& model) {
  std::string text;
  for (const auto& edge : model.oriented.topology.free_edges) {
    const std::string& patch = model.oriented.boundary.patches[std::size_t(edge.patch)].name;
    if constexpr (Dim == 2) {
      text += fmt::format("  free end: {} of {} at {}\n", edge.side == 0 ? "start" : "end", patch,
                          point_text<Dim>(edge.from));
    } else {
      text += fmt::format("  free edge: curve {} of loop {} of {} from {} to {}, {:.3g} from the nearest other\n",
                          edge.curve + 1, edge.loop + 1, patch, point_text<Dim>(edge.from), point_text<Dim>(edge.to),
                          edge.gap);
    }
  }
  return text;
}

template <int Dim>
std::string model_text(const io::Model<Dim>& model, const io::GeometrySummary& summary) {
  return fmt::format("\n{}\n{}{}  largest gap {:.2g} (counted as closed up to {:.2g})\n  control net from {} to {}\n",
                     patches_text(model), shells_text(model), free_edges_text(model), summary.largest_gap,
                     model.oriented.topology.tolerance, point_text(summary.box_lower), point_text(summary.box_upper));
}

}  // namespace

int check_case(const CheckArguments& arguments, std::ostream& out, std::ostream& /*err*/) {
  const io::CaseFile file = io::read_case(arguments.case_file, arguments.overrides);
  const io::AnyModel model = io::build_model(file);
  const io::GeometrySummary summary = io::summarise(model);
  out << fmt::format("{}\n  {}\n", file.title(), io::geometry_line(summary))
      << std::visit([&](const auto& known) { return model_text(known, summary); }, model);
  return 0;
}

}  // namespace isorim::cli
