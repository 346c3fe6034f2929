#include "geometry/propeller/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/propeller/series_tables.h"
#include "geometry/propeller/tip_outline.h"
#include "geometry/shapes/checks.h"

namespace isorim::geometry {
namespace {

constexpr int fewest_blades = 3;
constexpr int most_blades = 7;

std::string_view name_of(BladeSeries series) {
  return series == BladeSeries::kaplan ? "Kaplan" : "Wageningen B";
}

void check_blade(const SeriesBlade& blade) {
  const std::string name = fmt::format("{} blade", name_of(blade.series));
  checks::positive(name, "diameter", blade.diameter);
  checks::positive(name, "area ratio", blade.area_ratio);
  if (blade.blades < fewest_blades || blade.blades > most_blades) {
    throw GeometryError(fmt::format("{}: {} blades; the series has tables for {} to {}", name, blade.blades,
                                    fewest_blades, most_blades));
  }
  const bool has_four = blade.series == BladeSeries::wageningen_b && blade.blades == 4;
  if (blade.has_reduced_root_pitch && !has_four) {
    throw GeometryError(
        fmt::format("{}: the reduced root pitch belongs to Wageningen B screws of four blades; these are {} of {}",
                    name, name_of(blade.series), blade.blades));
  }
}

/// What the outline tables say of one radius.
struct Measures {
  double chord;
  double leading_edge;
  double max_thickness;
  /// From the leading edge.
  double max_thickness_place;
};

Measures kaplan_measures(const SeriesBlade& blade, std::size_t k) {
  using namespace series::kaplan;
  const double unit = chord_coefficient * blade.area_ratio / blade.blades * blade.diameter;
  return {chord[k] * unit, leading_edge[k] * unit, max_thickness[k] * blade.diameter,
          max_thickness_place[k] * chord[k] * unit};
}

Measures wageningen_measures(const SeriesBlade& blade, std::size_t k) {
  using namespace series::wageningen_b;
  const bool has_three = blade.blades == 3;
  const double factor = has_three ? three_blades_chord[k] : chord[k];
  const double length = factor * blade.diameter * blade.area_ratio / blade.blades;
  return {length, (has_three ? three_blades_leading_edge[k] : leading_edge[k]) * length,
          blade.diameter * (thickness_a[k] - thickness_b[k] * blade.blades),
          (has_three ? three_blades_max_thickness_place[k] : max_thickness_place[k]) * length};
}

/// The tables' columns rise from the trailing to the leading edge.
Points<2> table_outline(const Measures& measures, std::span<const double> stations, std::span<const double> face,
                        std::span<const double> back) {
  const auto last = static_cast<Eigen::Index>(stations.size()) - 1;
  Points<2> outline(2, 2 * last + 1);
  for (Eigen::Index i = 0; i <= last; ++i) {
    const auto column = static_cast<std::size_t>(i);
    const double s = stations[column];
    const double reach = s < 0.0 ? measures.chord - measures.max_thickness_place : measures.max_thickness_place;
    const double x = measures.leading_edge - measures.max_thickness_place + s * reach;
    const double lower = face[column] * measures.max_thickness;
    outline.col(2 * last - i) << x, lower;
    outline.col(i) << x, lower + back[column] * measures.max_thickness;
  }
  return outline;
}

BladeSection section_of(const Measures& measures, const BladeStation& station, std::span<const double> stations,
                        std::span<const double> face, std::span<const double> back) {
  return {station,
          measures.chord,
          measures.leading_edge,
          measures.max_thickness,
          table_outline(measures, stations, face, back),
          static_cast<Eigen::Index>(stations.size()) - 1};
}

BladeStation station_at(const SeriesBlade& blade, double radius_ratio) {
  BladeStation station;
  station.radius = 0.5 * blade.diameter * radius_ratio;
  station.pitch = blade.pitch_ratio(radius_ratio) * blade.diameter;
  station.skew = blade.skew(radius_ratio);
  station.rake = blade.rake(radius_ratio);
  return station;
}

std::vector<BladeSection> kaplan_sections(const SeriesBlade& blade) {
  using namespace series::kaplan;
  std::vector<BladeSection> sections;
  for (std::size_t k = 0; k < series::radii.size(); ++k)
    sections.push_back(
        section_of(kaplan_measures(blade, k), station_at(blade, series::radii[k]), stations, face[k], back[k]));
  return sections;
}

/// Beyond the last row with a chord: a rounded outline, and the thickness of the tables down to where it is rounded
/// off; the profile does not change any more.
std::vector<BladeSection> wageningen_tip(const SeriesBlade& blade) {
  using namespace series::wageningen_b;
  const std::size_t rows = series::radii.size() - 1;
  std::vector<OutlineEdges> edges;
  for (std::size_t k = 0; k < rows; ++k) {
    const Measures row = wageningen_measures(blade, k);
    edges.push_back({row.leading_edge, row.leading_edge - row.chord});
  }
  const RoundedOutline outline(std::span(series::radii).first(rows), edges);
  const double last = series::radii[rows - 1];
  const double last_thickness = wageningen_measures(blade, rows - 1).max_thickness;
  const double tip_thickness = wageningen_measures(blade, rows).max_thickness;
  std::vector<BladeSection> sections;
  for (const double ratio : tip_radii(last)) {
    const OutlineEdges place = outline(ratio);
    Measures measures;
    measures.leading_edge = place.leading;
    measures.chord = ratio < 1.0 ? place.leading - place.trailing : 0.0;
    measures.max_thickness = std::lerp(last_thickness, tip_thickness, (ratio - last) / (1.0 - last)) *
                             tip_thickness_factor(ratio, last, 2.0 * tip_thickness / blade.diameter);
    measures.max_thickness_place = 0.5 * measures.chord;
    sections.push_back(section_of(measures, station_at(blade, ratio), stations, face[rows], back[rows]));
  }
  return sections;
}

std::vector<BladeSection> wageningen_sections(const SeriesBlade& blade) {
  using namespace series::wageningen_b;
  std::vector<BladeSection> sections;
  for (std::size_t k = 0; k + 1 < series::radii.size(); ++k) {
    BladeStation station = station_at(blade, series::radii[k]);
    if (blade.has_reduced_root_pitch) station.pitch *= four_blades_pitch[k];
    sections.push_back(section_of(wageningen_measures(blade, k), station, stations, face[k], back[k]));
  }
  for (BladeSection& section : wageningen_tip(blade)) sections.push_back(std::move(section));
  return sections;
}

struct TestedRange {
  int fewest_blades;
  int most_blades;
  double least_area;
  double largest_area;
  double least_pitch;
  double largest_pitch;
};

TestedRange tested_range(BladeSeries series) {
  if (series == BladeSeries::kaplan) return {3, 5, 0.55, 0.75, 0.5, 1.8};
  return {2, 7, 0.30, 1.05, 0.5, 1.4};
}

}  // namespace

std::vector<BladeSection> series_sections(const SeriesBlade& blade) {
  check_blade(blade);
  return blade.series == BladeSeries::kaplan ? kaplan_sections(blade) : wageningen_sections(blade);
}

std::vector<std::string> outside_tested_range(const SeriesBlade& blade) {
  const TestedRange range = tested_range(blade.series);
  std::vector<std::string> notes;
  const auto note = [&](std::string_view quantity, auto value, auto least, auto largest) {
    if (value >= least && value <= largest) return;
    notes.push_back(fmt::format("the {} series was tested with {} from {} to {}; here it is {}", name_of(blade.series),
                                quantity, least, largest, value));
  };
  note("a number of blades", blade.blades, range.fewest_blades, range.most_blades);
  note("an area ratio", blade.area_ratio, range.least_area, range.largest_area);
  note("a pitch ratio at 0.7 R", blade.pitch_ratio(0.7), range.least_pitch, range.largest_pitch);
  return notes;
}

}  // namespace isorim::geometry
