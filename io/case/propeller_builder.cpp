#include "io/case/propeller_builder.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/propeller/propeller.h"
#include "geometry/propeller/radial_law.h"
#include "geometry/propeller/series.h"
#include "io/case/curve_builder.h"

namespace isorim::io {
namespace {

using geometry::RadialLaw;

constexpr double degree = std::numbers::pi / 180.0;

/// Rows of r / R and a value, each value times `unit`.
RadialLaw table(const NumberArray& rows, const char* quantity, double unit) {
  std::vector<double> radii;
  std::vector<double> values;
  for (std::size_t i = 0; i < rows.values.size(); i += 2) {
    radii.push_back(rows.values[i]);
    values.push_back(rows.values[i + 1] * unit);
  }
  return located(rows.where, [&] { return RadialLaw(quantity, std::move(radii), std::move(values)); });
}

bool is_number(const NumberArray& given) {
  return given.values.size() == 1;
}

/// A straight generator line that leans aft by an angle.
RadialLaw rake_law(const PropellerKeys& keys) {
  if (keys.rake.values.empty()) return RadialLaw(0.0);
  if (!is_number(keys.rake)) return table(keys.rake, "rake", 1.0);
  const double at_tip = 0.5 * keys.diameter * std::tan(keys.rake.values.front() * degree);
  return {"rake", {0.0, 1.0}, {0.0, at_tip}};
}

/// Growing from the hub with the square of the distance.
RadialLaw skew_law(const PropellerKeys& keys) {
  if (keys.skew.values.empty()) return RadialLaw(0.0);
  if (!is_number(keys.skew)) return table(keys.skew, "skew", degree);
  std::vector<double> radii;
  std::vector<double> values;
  for (int k = 0; k <= 40; ++k) {
    radii.push_back(keys.hub_ratio + (1.0 - keys.hub_ratio) * k / 40.0);
    values.push_back(keys.skew.values.front() * degree * std::pow(k / 40.0, 2));
  }
  return {"skew", radii, values};
}

}  // namespace

geometry::Boundary<3> propeller(const PropellerKeys& keys) {
  geometry::SeriesBlade blade;
  blade.series = keys.series;
  blade.diameter = keys.diameter;
  blade.blades = keys.blades;
  blade.area_ratio = keys.area_ratio;
  blade.pitch_ratio = is_number(keys.pitch_ratio) ? RadialLaw(keys.pitch_ratio.values.front())
                                                  : table(keys.pitch_ratio, "pitch_ratio", 1.0);
  blade.rake = rake_law(keys);
  blade.skew = skew_law(keys);
  blade.has_reduced_root_pitch = keys.has_reduced_root_pitch;
  geometry::Propeller screw;
  screw.sections = geometry::series_sections(blade);
  screw.blades = keys.blades;
  screw.surface.hand = keys.hand;
  if (keys.hub_ratio > 0.0) {
    screw.hub = geometry::Hub{0.5 * keys.diameter * keys.hub_ratio};
    if (keys.hub_ends) {
      screw.hub->aft = (*keys.hub_ends)(0);
      screw.hub->forward = (*keys.hub_ends)(1);
    }
  }
  return geometry::propeller(screw);
}

}  // namespace isorim::io
