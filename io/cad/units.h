#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace isorim::io {

struct LengthUnit {
  std::string_view name;
  double millimetres;
};

/// The units of IGES 5.3 (section 2.2.4.3.14) by the names that we use for them.
inline constexpr std::array<LengthUnit, 10> length_units{{{"mm", 1.0},
                                                          {"cm", 10.0},
                                                          {"m", 1000.0},
                                                          {"km", 1e6},
                                                          {"um", 1e-3},
                                                          {"in", 25.4},
                                                          {"ft", 304.8},
                                                          {"mi", 1609344.0},
                                                          {"mil", 0.0254},
                                                          {"uin", 2.54e-5}}};

/// Its length in millimetres; empty for a name that is not among them.
constexpr std::optional<double> unit_in_millimetres(std::string_view name) {
  for (const LengthUnit& unit : length_units) {
    if (unit.name == name) return unit.millimetres;
  }
  return std::nullopt;
}

}  // namespace isorim::io
