#pragma once

#include <string>
#include <vector>

#include "io/hull/hull_facts.h"
#include "io/results/json_parts.h"
#include "io/results/report.h"

namespace isorim::io {

/// hull_quantity_names() of a hull.
std::vector<Quantity> hull_quantities(const HullFacts& facts);

/// What results.json says under "hull".
Json hull_json(const HullFacts& facts, const std::vector<Quantity>& quantities);

/// A line for the terminal: "Series 60: 25 stations, 51 x 17 control points, ...".
std::string hull_text(const HullFacts& facts);

}  // namespace isorim::io
