#include "io/cad/cad_facts.h"

#include <algorithm>

#include <fmt/format.h>

namespace isorim::io {

geometry::FaceRepairs all_repairs(const CadFacts& facts) {
  geometry::FaceRepairs all;
  for (const PatchOrigin& patch : facts.patches) {
    const geometry::FaceRepairs& own = patch.repairs;
    all.inverted_pieces += own.inverted_pieces;
    all.bridged_ends += own.bridged_ends;
    all.shifted_curves += own.shifted_curves;
    all.reversed_loops += own.reversed_loops;
    all.largest_deviation = std::max(all.largest_deviation, own.largest_deviation);
    all.largest_disagreement = std::max(all.largest_disagreement, own.largest_disagreement);
    all.largest_bridge = std::max(all.largest_bridge, own.largest_bridge);
    for (const std::string& note : own.notes) all.notes.push_back(fmt::format("{}: {}", patch.origin.entity, note));
  }
  return all;
}

}  // namespace isorim::io
