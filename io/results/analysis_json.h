#pragma once

#include "io/results/analysis_report.h"
#include "io/results/json_parts.h"

namespace isorim::io {

/// What results.json says under "analysis".
Json analysis_json(const AnalysisReport& report);

}  // namespace isorim::io
