#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/results/inspection.h"
#include "io/results/table.h"

namespace isorim::io {
namespace {

/// Of longer lists only this many lines are shown.
constexpr std::size_t most_lines = 40;

std::string more(std::size_t count) {
  return count <= most_lines ? "" : fmt::format("  and {} more: --json lists all\n", count - most_lines);
}

std::string point_text(const std::vector<double>& point) {
  return fmt::format("({:.9g})", fmt::join(point, ", "));
}

std::string entities_text(const std::vector<EntityCount>& entities) {
  TextTable table({{"entity"}, {""}, {"count", Align::right}, {"not read", Align::right}});
  for (const EntityCount& entity : entities) {
    table.add_row({entity.type, entity.description, fmt::format("{}", entity.count),
                   entity.unsupported > 0 ? fmt::format("{}", entity.unsupported) : "-"});
  }
  return table.text(2);
}

std::string repairs_text(const geometry::FaceRepairs& repairs, const std::string& unit) {
  std::vector<std::string> lines;
  if (repairs.inverted_pieces > 0) {
    lines.push_back(
        fmt::format("{} parameter curves computed from the curves in space, which lie within {:.2g} {} of "
                    "their surfaces",
                    repairs.inverted_pieces, repairs.largest_deviation, unit));
  }
  if (repairs.largest_disagreement > 0.0) {
    lines.push_back(fmt::format("parameter curves and curves in space disagree by up to {:.2g} {}",
                                repairs.largest_disagreement, unit));
  }
  if (repairs.bridged_ends > 0) {
    lines.push_back(fmt::format("{} ends of loops joined along poles and seams", repairs.bridged_ends));
  }
  if (repairs.largest_bridge > 0.0) {
    lines.push_back(fmt::format("gaps in loops of up to {:.2g} {} bridged", repairs.largest_bridge, unit));
  }
  if (repairs.shifted_curves > 0) {
    lines.push_back(fmt::format("{} parameter curves moved by a period, clipped to the domain or split at a seam",
                                repairs.shifted_curves));
  }
  if (repairs.reversed_loops > 0) lines.push_back(fmt::format("{} loops turned round", repairs.reversed_loops));
  std::string text;
  for (const std::string& line : lines) text += fmt::format("  repair: {}\n", line);
  for (std::size_t i = 0; i < std::min(most_lines, repairs.notes.size()); ++i) {
    text += fmt::format("  note: {}\n", repairs.notes[i]);
  }
  return text + more(repairs.notes.size());
}

std::string cad_text(const CadFacts& facts) {
  std::string text = fmt::format("  {}, read by {}\n", facts.format, facts.reader);
  if (!facts.author.empty()) text += fmt::format("  written by {}\n", facts.author);
  text += facts.unit.empty() ? "  no unit\n"
          : facts.unit == facts.file_unit
              ? fmt::format("  unit {}\n", facts.unit)
              : fmt::format("  unit {}, converted to {} (times {:g})\n", facts.file_unit, facts.unit, facts.scale);
  text += fmt::format("  faces {}, solids {}, curves {}, points {}\n\n", facts.faces, facts.solids, facts.curves,
                      facts.points);
  return text + entities_text(facts.entities) + '\n';
}

std::string trouble_text(const CadFacts& facts) {
  std::string text = repairs_text(all_repairs(facts), facts.unit);
  for (const Approximation& approximation : facts.approximations) {
    text += fmt::format("  approximated: {} within {:.2g} {} (asked for {:.2g})\n", approximation.entity,
                        approximation.deviation, facts.unit, approximation.tolerance);
  }
  for (const RefusedEntity& entity : facts.refused) {
    text += fmt::format("  REFUSED: {} ({}): {}\n", entity.name, entity.entity, entity.reason);
  }
  for (const std::string& warning : facts.warnings) text += fmt::format("  warning: {}\n", warning);
  return text;
}

std::string elements_text(const InspectedPatch& patch) {
  return patch.cut_elements == 0 ? fmt::format("{}", patch.elements)
                                 : fmt::format("{} ({} cut)", patch.elements, patch.cut_elements);
}

std::string kind_text(const InspectedPatch& patch) {
  return std::string(patch.polynomial ? "polynomial" : "rational") + (patch.trimmed ? ", trimmed" : "") +
         (patch.extraction ? ", T-spline" : "");
}

std::string extraction_text(const std::string& name, const InspectedExtraction& extraction) {
  std::string text = fmt::format("  {}: {} functions, {} on an element", name, extraction.functions,
                                 fmt::join(extraction.functions_per_element, ", "));
  text += extraction.defective_elements == 0
              ? ", which sum to one"
              : fmt::format("; on {} elements they do not sum to one, by up to {:.2g}: divided by their sum",
                            extraction.defective_elements, extraction.partition_defect);
  if (extraction.hanging_sides > 0)
    text += fmt::format("; {} sides of elements face several others", extraction.hanging_sides);
  return text + '\n';
}

/// A line for each T-spline.
std::string extractions_text(const std::vector<InspectedPatch>& patches) {
  std::string text;
  std::size_t count = 0;
  for (const InspectedPatch& patch : patches)
    if (patch.extraction && ++count <= most_lines) text += extraction_text(patch.name, *patch.extraction);
  return text + more(count);
}

std::string patches_text(const std::vector<InspectedPatch>& patches) {
  TextTable table({{"patch"}, {"degree"}, {"elements", Align::right}, {"kind"}, {"orientation"}, {"entity"}});
  for (std::size_t i = 0; i < std::min(most_lines, patches.size()); ++i) {
    const InspectedPatch& patch = patches[i];
    table.add_row({patch.name, fmt::format("{}", fmt::join(patch.degrees, " x ")), elements_text(patch),
                   kind_text(patch), patch.orientation > 0 ? "as given" : "reversed",
                   patch.origin ? patch.origin->origin.entity : ""});
  }
  return table.text(2) + more(patches.size()) + extractions_text(patches) + '\n';
}

std::string shells_text(const Inspection& inspection) {
  const bool plane = inspection.geometry->dimension == 2;
  std::string text;
  for (std::size_t i = 0; i < std::min(most_lines, inspection.shells.size()); ++i) {
    const InspectedShell& shell = inspection.shells[i];
    const char* kind = shell.is_void ? (plane ? "hole" : "void") : "outer";
    constexpr std::size_t most_names = 8;
    std::vector<std::string> names(
        shell.patches.begin(),
        shell.patches.begin() + static_cast<std::ptrdiff_t>(std::min(most_names, shell.patches.size())));
    if (shell.patches.size() > most_names) {
      names.push_back(fmt::format("{} more", shell.patches.size() - most_names));
    }
    text += fmt::format("  {} {} ({}, {}): {}\n", plane ? "loop" : "shell", i + 1, kind,
                        shell.closed ? "closed" : "open", fmt::join(names, ", "));
  }
  return text + more(inspection.shells.size());
}

std::string free_edge_text(const InspectedFreeEdge& edge, int dimension) {
  if (dimension == 2) return fmt::format("  free end: {} of {} at {}\n", edge.place, edge.patch, point_text(edge.from));
  const std::string gap =
      edge.nearest.empty() ? "" : fmt::format(", {:.2g} from a free edge of {}", edge.gap, edge.nearest);
  return fmt::format("  free edge: {} of {} from {} to {}, length {:.4g}{}\n", edge.place, edge.patch,
                     point_text(edge.from), point_text(edge.to), edge.length, gap);
}

std::string free_edges_text(const Inspection& inspection) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most_lines, inspection.free_edges.size()); ++i) {
    text += free_edge_text(inspection.free_edges[i], inspection.geometry->dimension);
  }
  text += more(inspection.free_edges.size());
  if (!inspection.free_edges_file.empty()) text += fmt::format("  free edges in {}\n", inspection.free_edges_file);
  return text;
}

std::string numbers_text(const Inspection& inspection) {
  const GeometrySummary& geometry = *inspection.geometry;
  const std::string unit = inspection.cad && !inspection.cad->unit.empty() ? ' ' + inspection.cad->unit : "";
  const std::string place = geometry.largest_gap > 0.0 && !geometry.largest_gap_place.empty()
                                ? fmt::format(" near {}", point_text(geometry.largest_gap_place))
                                : "";
  std::string text = fmt::format("  largest gap {:.2g}{}{} (edges searched up to {:.2g}{})\n", geometry.largest_gap,
                                 unit, place, geometry.edge_tolerance, unit);
  text += fmt::format("  closure defect {:.2g}: gaps may cost {:.2g}{} of {}\n", geometry.closure_defect,
                      geometry.pole_shift, unit.empty() ? "" : unit + (geometry.dimension == 2 ? "^2" : "^3"),
                      geometry.dimension == 2 ? "area" : "volume");
  return text +
         fmt::format("  control net from {} to {}\n", point_text(geometry.box_lower), point_text(geometry.box_upper));
}

}  // namespace

std::string inspection_text(const Inspection& inspection) {
  std::string text = inspection.title + '\n';
  if (inspection.cad) text += cad_text(*inspection.cad);
  if (inspection.geometry) {
    text += fmt::format("  {}\n\n{}{}{}{}", geometry_line(*inspection.geometry), patches_text(inspection.patches),
                        shells_text(inspection), free_edges_text(inspection), numbers_text(inspection));
  }
  if (inspection.cad) text += trouble_text(*inspection.cad);
  return text;
}

}  // namespace isorim::io
