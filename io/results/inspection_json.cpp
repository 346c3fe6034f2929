#include "io/results/inspection.h"
#include "io/results/json_parts.h"

namespace isorim::io {
namespace {

Json patch_json(const InspectedPatch& patch) {
  Json json;
  json["name"] = patch.name;
  json["degrees"] = patch.degrees;
  json["elements"] = patch.elements;
  json["cut_elements"] = patch.cut_elements;
  json["rational"] = !patch.polynomial;
  json["trimmed"] = patch.trimmed;
  json["orientation"] = patch.orientation;
  if (patch.extraction)
    json["extraction"] = {{"functions", patch.extraction->functions},
                          {"functions_per_element", patch.extraction->functions_per_element},
                          {"partition_defect", number(patch.extraction->partition_defect)},
                          {"defective_elements", patch.extraction->defective_elements},
                          {"hanging_sides", patch.extraction->hanging_sides}};
  if (!patch.origin) return json;
  const CadOrigin& origin = patch.origin->origin;
  json["entity"] = origin.entity;
  json["solid"] = patch.origin->solid < 0 ? Json(nullptr) : Json(patch.origin->solid);
  json["level"] = origin.level;
  json["colour"] = origin.colour ? Json(*origin.colour) : Json(nullptr);
  json["repairs"] = repairs_json(patch.origin->repairs);
  return json;
}

Json free_edge_json(const InspectedFreeEdge& edge) {
  return {{"patch", edge.patch},
          {"place", edge.place},
          {"from", list_json(edge.from)},
          {"to", list_json(edge.to)},
          {"length", number(edge.length)},
          {"nearest", edge.nearest.empty() ? Json(nullptr) : Json(edge.nearest)},
          {"gap", edge.nearest.empty() ? Json(nullptr) : number(edge.gap)}};
}

Json shell_json(const InspectedShell& shell) {
  return {{"closed", shell.closed}, {"void", shell.is_void}, {"patches", shell.patches}};
}

}  // namespace

std::string inspection_json(const Inspection& inspection) {
  Json json;
  json["isorim"] = program_version();
  json["case"] = inspection.title;
  json["failure"] = inspection.failure.empty() ? Json(nullptr) : Json(inspection.failure);
  json["geometry"] = inspection.geometry ? geometry_json(*inspection.geometry, inspection.cad) : Json(nullptr);
  json["cad"] = inspection.cad ? cad_json(*inspection.cad) : Json(nullptr);
  Json& patches = json["patches"] = Json::array();
  for (const InspectedPatch& patch : inspection.patches) patches.push_back(patch_json(patch));
  Json& shells = json["shells"] = Json::array();
  for (const InspectedShell& shell : inspection.shells) shells.push_back(shell_json(shell));
  Json& edges = json["free_edges"] = Json::array();
  for (const InspectedFreeEdge& edge : inspection.free_edges) edges.push_back(free_edge_json(edge));
  json["free_edges_file"] = inspection.free_edges_file.empty() ? Json(nullptr) : Json(inspection.free_edges_file);
  return json_text(json);
}

}  // namespace isorim::io
