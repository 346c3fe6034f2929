#pragma once

#include "io/fit/fit_facts.h"
#include "io/results/json_parts.h"

namespace isorim::io {

/// What results.json says under "fit".
Json fit_json(const FitFacts& facts);

}  // namespace isorim::io
