#include "io/iges/units.h"

#include <algorithm>
#include <cctype>

#include "io/cad/units.h"
#include "io/iges/free_format.h"

namespace isorim::io::iges {
namespace {

/// IGES 5.3, section 2.2.4.3.14 and .15.
constexpr std::array<LengthUnit, 10> length_units{{
    {1, "in", *unit_in_millimetres("in"), {"IN", "INCH", "INCHES", "\"", "", ""}},
    {2, "mm", *unit_in_millimetres("mm"), {"MM", "MILLIMETER", "MILLIMETRE", "MILLIMETERS", "MILLIMETRES", ""}},
    {4, "ft", *unit_in_millimetres("ft"), {"FT", "FOOT", "FEET", "'", "", ""}},
    {5, "mi", *unit_in_millimetres("mi"), {"MI", "MILE", "MILES", "", "", ""}},
    {6, "m", *unit_in_millimetres("m"), {"M", "METER", "METRE", "METERS", "METRES", ""}},
    {7, "km", *unit_in_millimetres("km"), {"KM", "KILOMETER", "KILOMETRE", "KILOMETERS", "KILOMETRES", ""}},
    {8, "mil", *unit_in_millimetres("mil"), {"MIL", "MILS", "", "", "", ""}},
    {9, "um", *unit_in_millimetres("um"), {"UM", "MICRON", "MICRONS", "MICROMETER", "MICROMETRE", "MICROMETERS"}},
    {10, "cm", *unit_in_millimetres("cm"), {"CM", "CENTIMETER", "CENTIMETRE", "CENTIMETERS", "CENTIMETRES", ""}},
    {11, "uin", *unit_in_millimetres("uin"), {"UIN", "MICROINCH", "MICROINCHES", "", "", ""}},
}};

}  // namespace

const LengthUnit* unit_of_flag(int flag) {
  const auto* found =
      std::find_if(length_units.begin(), length_units.end(), [&](const LengthUnit& unit) { return unit.flag == flag; });
  return found == length_units.end() ? nullptr : found;
}

const LengthUnit* unit_of_name(std::string_view name) {
  std::string capitals(trim(name));
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (capitals.empty()) return nullptr;
  const auto* found = std::find_if(length_units.begin(), length_units.end(), [&](const LengthUnit& unit) {
    return std::find(unit.names.begin(), unit.names.end(), capitals) != unit.names.end();
  });
  return found == length_units.end() ? nullptr : found;
}

std::string unit_symbols() {
  std::string text;
  for (const LengthUnit& unit : length_units) text += (text.empty() ? "" : ", ") + std::string(unit.symbol);
  return text;
}

}  // namespace isorim::io::iges
