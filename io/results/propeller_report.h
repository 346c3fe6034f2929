#pragma once

#include <string>
#include <vector>

#include "io/propeller/propeller_facts.h"
#include "io/results/json_parts.h"
#include "io/results/report.h"
#include "quadrature/options.h"

namespace isorim::io {

/// propeller_quantity_names() of a screw: area ratios, control points, and the volumes of a blade and of the hub alone,
/// integrated as the options say; `properties` of the shape serve where it is the screw itself.
std::vector<Quantity> propeller_quantities(const PropellerFacts& facts, const std::vector<Quantity>& properties,
                                           const quadrature::Options& options);

/// What results.json says under "propeller".
Json propeller_json(const PropellerFacts& facts, const std::vector<Quantity>& quantities);

/// A line for the terminal: "4 blades, right-handed; 25 x 9 control points a blade, ...".
std::string propeller_text(const PropellerFacts& facts);

}  // namespace isorim::io
