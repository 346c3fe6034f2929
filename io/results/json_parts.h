#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/cad/cad_facts.h"
#include "io/results/report.h"

/// What several JSON texts hold; for .cpp files alone.
namespace isorim::io {

/// Keeps keys in the order in which they are added.
using Json = nlohmann::ordered_json;

/// The library prints the shortest text that reads back to the same bits; null for what is not finite.
Json number(double x);
Json list_json(const std::vector<double>& values);

/// What results.json says under "geometry" and, for a CAD file, under "cad".
Json geometry_json(const GeometrySummary& geometry, const std::optional<CadFacts>& cad);
Json cad_json(const CadFacts& facts);
Json repairs_json(const geometry::FaceRepairs& repairs);

/// The text of a whole file; bytes that are no UTF-8 are replaced.
std::string json_text(const Json& json);

}  // namespace isorim::io
