#pragma once

#include <array>
#include <string>
#include <string_view>

namespace isorim::io::iges {

/// A unit of length that IGES has a flag for.
struct LengthUnit {
  int flag;
  std::string_view symbol;
  double millimetres;
  /// As the standard (first) and files spell it, in capitals.
  std::array<std::string_view, 6> names;
};

/// nullptr if the flag is unknown, or 3: the name tells the unit.
const LengthUnit* unit_of_flag(int flag);
/// Whatever the case; nullptr if the name is unknown.
const LengthUnit* unit_of_name(std::string_view name);
/// "in, mm, ...", for messages.
std::string unit_symbols();

}  // namespace isorim::io::iges
