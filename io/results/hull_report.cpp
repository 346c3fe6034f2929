#include "io/results/hull_report.h"

#include <fmt/format.h>

namespace isorim::io {

std::vector<Quantity> hull_quantities(const HullFacts& facts) {
  return {{"prismatic", single(facts.prismatic), {}, {}, {}, ""},
          {"lcb", single(100.0 * facts.buoyancy_centre), {}, {}, {}, ""},
          {"offset_distance", single(facts.offset_distance), {}, {}, {}, ""},
          {"bending_energy", single(facts.fairness.bending_energy), {}, {}, {}, ""},
          {"curvature_sign_changes",
           single(facts.fairness.station_sign_changes + facts.fairness.waterline_sign_changes),
           {},
           {},
           {},
           ""}};
}

Json hull_json(const HullFacts& facts, const std::vector<Quantity>& quantities) {
  const geometry::OffsetTable& table = facts.table;
  Json json{{"name", table.name},
            {"source", table.source},
            {"length", number(table.length)},
            {"beam", number(table.beam)},
            {"draught", number(table.draught)},
            {"after_perpendicular", number(table.after_perpendicular)},
            {"baseline", number(table.baseline)},
            {"stations", table.stations.size()},
            {"waterlines", table.waterlines.size()}};
  for (const Quantity& quantity : quantities) json[quantity.name] = number(quantity.value.values.front());
  json["station_sign_changes"] = facts.fairness.station_sign_changes;
  json["waterline_sign_changes"] = facts.fairness.waterline_sign_changes;
  if (facts.fairing) {
    const HullFairing& fairing = *facts.fairing;
    json["fairing"] = {{"tolerance", number(fairing.tolerance)},
                       {"moved", fairing.moved},
                       {"largest_move", number(fairing.largest_move)},
                       {"roughness_before", number(fairing.roughness_before)},
                       {"roughness", number(fairing.roughness)},
                       {"bending_energy_before", number(fairing.before.bending_energy)},
                       {"station_sign_changes_before", fairing.before.station_sign_changes},
                       {"waterline_sign_changes_before", fairing.before.waterline_sign_changes}};
  }
  json["control_points"] = Json::array();
  for (const geometry::NurbsSurface<3>& band : facts.port)
    json["control_points"].push_back({band.count_u(), band.count_v()});
  return json;
}

std::string hull_text(const HullFacts& facts) {
  const geometry::OffsetTable& table = facts.table;
  std::string nets;
  for (const geometry::NurbsSurface<3>& band : facts.port)
    nets += fmt::format("{}{} x {}", nets.empty() ? "" : ", ", band.count_u(), band.count_v());
  std::string faired;
  if (facts.fairing) {
    const HullFairing& fairing = *facts.fairing;
    faired = fmt::format(
        "  faired: {} half-breadths moved by at most {:.4g}; roughness {:.4g} -> {:.4g}, changes of curvature's sign "
        "{} "
        "-> {}\n",
        fairing.moved, fairing.largest_move, fairing.roughness_before, fairing.roughness,
        fairing.before.station_sign_changes + fairing.before.waterline_sign_changes,
        facts.fairness.station_sign_changes + facts.fairness.waterline_sign_changes);
  }
  return fmt::format(
      "  {}: length {:g}, beam {:g}, draught {:g}; {} stations, {} waterlines, {} control points\n"
      "  to the design draught: prismatic coefficient {:.4f}, centre of buoyancy {:+.3f} % of the length forward\n{}",
      table.name, table.length, table.beam, table.draught, table.stations.size(), table.waterlines.size(), nets,
      facts.prismatic, 100.0 * facts.buoyancy_centre, faired);
}

}  // namespace isorim::io
