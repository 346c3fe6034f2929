#include "io/results/json_parts.h"

#include <cmath>

namespace isorim::io {

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json list_json(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double x : values) list.push_back(number(x));
  return list;
}

Json geometry_json(const GeometrySummary& geometry, const std::optional<CadFacts>& cad) {
  Json json;
  json["dimension"] = geometry.dimension;
  json["patches"] = geometry.patches;
  json["elements"] = geometry.elements;
  json["trimmed_faces"] = geometry.trimmed_faces;
  json["t_splines"] = geometry.t_splines;
  json["partition_defect"] = geometry.t_splines > 0 ? number(geometry.partition_defect) : Json(nullptr);
  json["closed"] = geometry.closed;
  json["closure_defect"] = number(geometry.closure_defect);
  json["pole_shift"] = number(geometry.pole_shift);
  // The shapes of a case file are in no unit of their own, nor those of T-spline files.
  json["units"] = cad && !cad->unit.empty() ? Json(cad->unit) : Json(nullptr);
  json["shells"] = geometry.shells;
  json["voids"] = geometry.voids;
  json["free_edges"] = geometry.free_edges;
  json["largest_gap"] = number(geometry.largest_gap);
  json["largest_gap_place"] =
      geometry.largest_gap_place.empty() ? Json(nullptr) : list_json(geometry.largest_gap_place);
  json["edge_tolerance"] = number(geometry.edge_tolerance);
  json["reader"] = cad ? Json(cad->reader) : Json(nullptr);
  json["format"] = cad ? Json(cad->format) : Json(nullptr);
  json["bounding_box"] = {list_json(geometry.box_lower), list_json(geometry.box_upper)};
  return json;
}

Json repairs_json(const geometry::FaceRepairs& repairs) {
  Json json;
  json["inverted_pieces"] = repairs.inverted_pieces;
  json["largest_deviation"] = number(repairs.largest_deviation);
  json["largest_disagreement"] = number(repairs.largest_disagreement);
  json["bridged_ends"] = repairs.bridged_ends;
  json["largest_bridge"] = number(repairs.largest_bridge);
  json["shifted_curves"] = repairs.shifted_curves;
  json["reversed_loops"] = repairs.reversed_loops;
  json["notes"] = repairs.notes;
  return json;
}

Json cad_json(const CadFacts& facts) {
  Json json;
  json["author"] = facts.author;
  json["file_unit"] = facts.file_unit.empty() ? Json(nullptr) : Json(facts.file_unit);
  json["scale"] = number(facts.scale);
  json["faces"] = facts.faces;
  json["solids"] = facts.solids;
  json["curves"] = facts.curves;
  json["points"] = facts.points;
  Json& entities = json["entities"] = Json::array();
  for (const EntityCount& entity : facts.entities) {
    entities.push_back({{"type", entity.type},
                        {"description", entity.description},
                        {"count", entity.count},
                        {"unsupported", entity.unsupported}});
  }
  json["repairs"] = repairs_json(all_repairs(facts));
  Json& approximations = json["approximations"] = Json::array();
  for (const Approximation& approximation : facts.approximations) {
    approximations.push_back({{"entity", approximation.entity},
                              {"tolerance", number(approximation.tolerance)},
                              {"deviation", number(approximation.deviation)}});
  }
  Json& refused = json["refused"] = Json::array();
  for (const RefusedEntity& entity : facts.refused) {
    refused.push_back({{"name", entity.name}, {"entity", entity.entity}, {"reason", entity.reason}});
  }
  json["warnings"] = facts.warnings;
  return json;
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace isorim::io
