#pragma once

#include <vector>

#include "io/results/json_parts.h"
#include "io/results/plane_sections.h"

namespace isorim::io {

/// What results.json says under "sections": a table for each family by its name.
Json sections_json(const std::vector<SectionFamily>& families);

}  // namespace isorim::io
