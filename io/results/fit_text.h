#pragma once

#include <string>

#include "io/fit/fit_facts.h"

namespace isorim::io {

/// Of a fit, for the terminal: what became of the points, and the largest and RMS distance of each curve with its worst
/// point.
std::string fit_text(const FitFacts& facts);

}  // namespace isorim::io
