#pragma once

#include <string>

namespace isorim::io {

/// What a name means in every expression, "a constant" (pi, e) or "a function" (sqrt, min, ...); empty if nothing.
std::string constant_or_function(const std::string& name);

}  // namespace isorim::io
