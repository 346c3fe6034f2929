#include "io/picture/colours.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <string_view>

#include <fmt/format.h>
#include <vtkColorTransferFunction.h>
#include <vtkMath.h>
#include <vtkNew.h>

#include "geometry/errors.h"

namespace isorim::io::picture {
namespace {

/// Every 17th of the 256 colours.
constexpr std::array<std::uint32_t, 16> viridis{0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e,
                                                0x2a788e, 0x23888e, 0x1f988b, 0x22a884, 0x35b779, 0x54c568,
                                                0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725};

Colour from_hex(std::uint32_t value) {
  return {(value >> 16U & 0xffU) / 255.0, (value >> 8U & 0xffU) / 255.0, (value & 0xffU) / 255.0};
}

/// Over [0, 1].
vtkNew<vtkColorTransferFunction> transfer_function(ColourMap map) {
  vtkNew<vtkColorTransferFunction> function;
  switch (map) {
    case ColourMap::viridis:
      function->SetColorSpaceToLab();
      for (std::size_t i = 0; i < viridis.size(); ++i) {
        const Colour colour = from_hex(viridis[i]);
        function->AddRGBPoint(static_cast<double>(i) / (viridis.size() - 1.0), colour[0], colour[1], colour[2]);
      }
      break;
    case ColourMap::coolwarm:
      function->SetColorSpaceToDiverging();
      function->AddRGBPoint(0.0, 0.230, 0.299, 0.754);
      function->AddRGBPoint(1.0, 0.706, 0.016, 0.150);
      break;
    case ColourMap::grey:
      function->SetColorSpaceToLab();
      function->AddRGBPoint(0.0, 0.1, 0.1, 0.1);
      function->AddRGBPoint(1.0, 0.95, 0.95, 0.95);
      break;
  }
  return function;
}

}  // namespace

Colour colour_from(const std::string& text) {
  const std::map<std::string, Colour> names{
      {"black", {0.0, 0.0, 0.0}}, {"grey", {0.8, 0.8, 0.8}}, {"white", {1.0, 1.0, 1.0}}};
  if (const auto name = names.find(text); name != names.end()) return name->second;
  std::string digits = text.starts_with('#') ? text.substr(1) : "";
  if (digits.size() == 3) digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  std::uint32_t value = 0;
  const char* end = digits.data() + digits.size();
  if (digits.size() != 6 || std::from_chars(digits.data(), end, value, 16).ptr != end) {
    throw InputError(fmt::format("found the colour \"{}\"; expected #rrggbb, black, grey or white", text));
  }
  return from_hex(value);
}

vtkSmartPointer<vtkLookupTable> lookup_table(ColourMap map, const std::array<double, 2>& range) {
  const vtkNew<vtkColorTransferFunction> function = transfer_function(map);
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int count = 256;
  table->SetNumberOfTableValues(count);
  table->SetRange(range.data());
  for (int i = 0; i < count; ++i) {
    Colour colour{};
    function->GetColor(i / (count - 1.0), colour.data());
    table->SetTableValue(i, colour[0], colour[1], colour[2]);
  }
  table->SetNanColor(0.8, 0.8, 0.8, 1.0);
  return table;
}

Colour patch_colour(int patch) {
  constexpr double lightness = 72.0;
  constexpr double chroma = 36.0;
  constexpr double blue = 255.0;
  // The golden angle never comes near to an earlier hue.
  constexpr double golden = 137.50776405003785;
  const double hue = (blue + golden * patch) * std::numbers::pi / 180.0;
  Colour colour{};
  vtkMath::LabToRGB(lightness, chroma * std::cos(hue), chroma * std::sin(hue), colour.data(), colour.data() + 1,
                    colour.data() + 2);
  for (double& component : colour) component = std::clamp(component, 0.0, 1.0);
  return colour;
}

}  // namespace isorim::io::picture
