#include "io/propeller/propeller_blade.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/propeller/radial_law.h"
#include "geometry/propeller/series.h"
#include "geometry/propeller/table_blade.h"
#include "io/case/curve_builder.h"
#include "io/file_bytes.h"
#include "io/fit/point_table.h"

namespace isorim::io {
namespace {

using geometry::RadialLaw;

constexpr double degree = std::numbers::pi / 180.0;

// --- Laws of the radius ---------------------------------------------------------------------------------------

/// Rows of r / R and a value, each value times `unit`.
RadialLaw law_of_rows(const NumberArray& rows, const char* quantity, double unit) {
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

RadialLaw pitch_ratio_law(const PropellerKeys& keys) {
  return is_number(keys.pitch_ratio) ? RadialLaw(keys.pitch_ratio.values.front())
                                     : law_of_rows(keys.pitch_ratio, "pitch_ratio", 1.0);
}

/// A straight generator line that leans aft by an angle.
RadialLaw rake_law(const PropellerKeys& keys) {
  if (keys.rake.values.empty()) return RadialLaw(0.0);
  if (!is_number(keys.rake)) return law_of_rows(keys.rake, "rake", 1.0);
  const double at_tip = 0.5 * keys.diameter * std::tan(keys.rake.values.front() * degree);
  return {"rake", {0.0, 1.0}, {0.0, at_tip}};
}

/// Growing from the hub with the square of the distance.
RadialLaw skew_law(const PropellerKeys& keys) {
  if (keys.skew.values.empty()) return RadialLaw(0.0);
  if (!is_number(keys.skew)) return law_of_rows(keys.skew, "skew", degree);
  std::vector<double> radii;
  std::vector<double> values;
  for (int k = 0; k <= 40; ++k) {
    radii.push_back(keys.hub_ratio + (1.0 - keys.hub_ratio) * k / 40.0);
    values.push_back(keys.skew.values.front() * degree * std::pow(k / 40.0, 2));
  }
  return {"skew", radii, values};
}

// --- Series ---------------------------------------------------------------------------------------------------

PropellerBlade series_blade(const PropellerKeys& keys) {
  geometry::SeriesBlade blade;
  blade.series =
      keys.series == BladeSource::kaplan ? geometry::BladeSeries::kaplan : geometry::BladeSeries::wageningen_b;
  blade.diameter = keys.diameter;
  blade.blades = keys.blades;
  blade.area_ratio = *keys.area_ratio;
  blade.pitch_ratio = pitch_ratio_law(keys);
  blade.rake = rake_law(keys);
  blade.skew = skew_law(keys);
  blade.has_reduced_root_pitch = keys.has_reduced_root_pitch;
  return {located(keys.where, [&] { return geometry::series_sections(blade); }), geometry::outside_tested_range(blade)};
}

// --- Tables ---------------------------------------------------------------------------------------------------

/// A column in lengths, and the columns that give the same in other measures.
struct Measure {
  const char* name;
  std::vector<double> BladeTableKeys::*lengths;
  std::vector<double> BladeTableKeys::*of_diameter;
  const char* name_of_diameter;
  std::vector<double> BladeTableKeys::*of_chord;
  const char* name_of_chord;
};
constexpr Measure chord_measure{"chord", &BladeTableKeys::chord, &BladeTableKeys::chord_ratio, "c/D", nullptr, ""};
constexpr Measure pitch_measure{"pitch", &BladeTableKeys::pitch, &BladeTableKeys::pitch_ratio, "P/D", nullptr, ""};
constexpr Measure rake_measure{"rake", &BladeTableKeys::rake, &BladeTableKeys::rake_ratio, "rake/D", nullptr, ""};
constexpr Measure thickness_measure{"thickness", &BladeTableKeys::thickness,          &BladeTableKeys::thickness_ratio,
                                    "t/D",       &BladeTableKeys::thickness_of_chord, "t/c"};
constexpr Measure camber_measure{"camber", &BladeTableKeys::camber,          &BladeTableKeys::camber_ratio,
                                 "f/D",    &BladeTableKeys::camber_of_chord, "f/c"};

/// The rows of a table, from its columns.
class TableRows {
 public:
  TableRows(const BladeTableKeys& table, const PropellerKeys& keys, std::string where)
      : table_(table), keys_(keys), where_(std::move(where)) {}

  std::vector<geometry::BladeTableRow> rows() const {
    check_lengths();
    const std::vector<double> chords = required(chord_measure, {});
    const std::vector<double> pitches = pitch();
    const std::vector<double> thicknesses = required(thickness_measure, chords);
    const std::optional<std::vector<double>> cambers = lengths(camber_measure, chords);
    const std::vector<double> rakes = either(lengths(rake_measure, chords), keys_.rake, "rake", rake_law(keys_));
    const std::vector<double> skews = either(skew(), keys_.skew, "skew", skew_law(keys_));
    std::vector<geometry::BladeTableRow> result;
    for (std::size_t k = 0; k < table_.radius_ratio.size(); ++k)
      result.push_back({table_.radius_ratio[k], chords[k], pitches[k], skews[k], rakes[k], thicknesses[k],
                        cambers ? (*cambers)[k] : 0.0});
    check_unit(result);
    return result;
  }

 private:
  [[noreturn]] void refuse(std::string_view message) const { throw InputError(fmt::format("{}: {}", where_, message)); }

  void check_lengths() const {
    for (const BladeColumn& column : blade_columns) {
      const std::vector<double>& values = table_.*column.values;
      if (!values.empty() && values.size() != table_.radius_ratio.size())
        refuse(fmt::format("found {} values of {} for {} of r/R; expected as many", values.size(), column.name,
                           table_.radius_ratio.size()));
    }
  }

  /// Ratios of what the diameter is, or of the other way round, are mistakes of the unit.
  void check_unit(const std::vector<geometry::BladeTableRow>& rows) const {
    for (const geometry::BladeTableRow& row : rows) {
      if (row.chord > 2.0 * keys_.diameter)
        refuse(
            fmt::format("the chord at r/R = {} is {:.6g} with a diameter of {:.6g}; expected lengths in the unit of "
                        "the diameter, or c/D",
                        row.radius_ratio, row.chord, keys_.diameter));
    }
  }

  /// Nothing if the table has no column for it.
  std::optional<std::vector<double>> lengths(const Measure& measure, const std::vector<double>& chords) const {
    std::vector<std::string> found;
    std::vector<double> result;
    const auto take = [&](std::vector<double> BladeTableKeys::*column, const char* name, const auto& unit) {
      if (!column || (table_.*column).empty()) return;
      found.emplace_back(name);
      result = table_.*column;
      for (std::size_t k = 0; k < result.size(); ++k) result[k] *= unit(k);
    };
    take(measure.lengths, measure.name, [](std::size_t) { return 1.0; });
    take(measure.of_diameter, measure.name_of_diameter, [&](std::size_t) { return keys_.diameter; });
    take(measure.of_chord, measure.name_of_chord, [&](std::size_t k) { return chords[k]; });
    if (found.size() > 1) refuse(fmt::format("found the columns {}; expected one of them", fmt::join(found, " and ")));
    if (found.empty()) return std::nullopt;
    return result;
  }

  std::vector<double> required(const Measure& measure, const std::vector<double>& chords) const {
    if (auto found = lengths(measure, chords)) return *found;
    refuse(fmt::format("the column {} is missing; expected \"{}\"{}", measure.name, measure.name,
                       measure.of_chord
                           ? fmt::format(", \"{}\" or \"{}\"", measure.name_of_diameter, measure.name_of_chord)
                           : fmt::format(" or \"{}\"", measure.name_of_diameter)));
  }

  std::vector<double> pitch() const {
    const std::optional<std::vector<double>> column = lengths(pitch_measure, {});
    if (!column && keys_.pitch_ratio.values.empty())
      refuse("the column pitch is missing; expected \"pitch\" or \"P/D\", or the key pitch_ratio");
    if (keys_.pitch_ratio.values.empty()) return *column;
    std::vector<double> values = either(column, keys_.pitch_ratio, "pitch_ratio", pitch_ratio_law(keys_));
    for (double& value : values) value *= keys_.diameter;
    return values;
  }

  std::optional<std::vector<double>> skew() const {
    if (table_.skew.empty()) return std::nullopt;
    std::vector<double> radians = table_.skew;
    for (double& angle : radians) angle *= degree;
    return radians;
  }

  /// A column, or a key beside the table, not both.
  std::vector<double> either(const std::optional<std::vector<double>>& column, const NumberArray& key, const char* name,
                             const RadialLaw& law) const {
    if (column && !key.values.empty()) refuse(fmt::format("found {} as a column and as a key; expected one", name));
    if (column) return *column;
    std::vector<double> values;
    for (const double radius : table_.radius_ratio) values.push_back(law(radius));
    return values;
  }

  const BladeTableKeys& table_;
  const PropellerKeys& keys_;
  std::string where_;
};

std::filesystem::path resolved(const PropellerKeys& keys, const std::string& file) {
  const std::filesystem::path path(file);
  return path.is_absolute() ? path : keys.folder / path;
}

PropellerBlade table_blade(const PropellerKeys& keys) {
  geometry::TableBlade blade;
  blade.diameter = keys.diameter;
  blade.thickness = keys.thickness_form;
  blade.camber = keys.mean_line;
  blade.points_a_side = keys.points_a_side;
  const KeyPlace& place = keys.table ? keys.table->where : keys.where;
  std::string where = fmt::format("{}: {}", place.place.describe(), place.path);
  if (keys.table) {
    blade.rows = TableRows(*keys.table, keys, where).rows();
  } else {
    where = resolved(keys, keys.table_file).string();
    blade.rows = TableRows(parse_blade_table(read_bytes(where), where), keys, where).rows();
  }
  try {
    return {geometry::table_sections(blade), {}};
  } catch (const GeometryError& error) {
    throw InputError(fmt::format("{}: {}", where, error.what()));
  }
}

// --- Points ---------------------------------------------------------------------------------------------------

PropellerBlade point_blade(const PropellerKeys& keys) {
  const RadialLaw pitch = pitch_ratio_law(keys);
  const RadialLaw rake = rake_law(keys);
  const RadialLaw skew = skew_law(keys);
  PropellerBlade blade;
  for (const BladeSectionKeys& section : keys.sections) {
    const double ratio = section.radius_ratio;
    const geometry::BladeStation station{0.5 * keys.diameter * ratio, pitch(ratio) * keys.diameter, skew(ratio),
                                         rake(ratio)};
    const PointTable table = read_points(resolved(keys, section.file));
    blade.sections.push_back(located(section.where, [&] {
      return geometry::point_section(station, geometry::Points<2>(table.points.topRows<2>()));
    }));
    const geometry::BladeSection& first = blade.sections.front();
    if (blade.sections.back().leading_edge_point != first.leading_edge_point)
      refuse(section.where,
             fmt::format("the leading edge is point {} of {}, and point {} of the first section; expected "
                         "as many points on the back and on the face of all",
                         blade.sections.back().leading_edge_point + 1, section.file, first.leading_edge_point + 1));
  }
  if (keys.sections.back().radius_ratio != 1.0)
    refuse(keys.sections.back().where,
           fmt::format("the last section has r/R = {}; expected the tip, 1", keys.sections.back().radius_ratio));
  return blade;
}

}  // namespace

PropellerBlade propeller_blade(const PropellerKeys& keys) {
  if (keys.series != BladeSource::own) return series_blade(keys);
  return keys.sections.empty() ? table_blade(keys) : point_blade(keys);
}

std::vector<geometry::BladeEdit> blade_edits(const PropellerKeys& keys,
                                             const std::vector<geometry::BladeSection>& sections) {
  using Kind = geometry::BladeEdit::Kind;
  std::vector<geometry::BladeEdit> edits;
  for (const BladeEditKeys& edit : keys.edits) {
    const auto ratio = [&](const geometry::BladeSection& section) {
      return 2.0 * section.station.radius / keys.diameter;
    };
    const auto found = std::ranges::find_if(
        sections, [&](const auto& section) { return std::abs(ratio(section) - edit.radius_ratio) <= 1e-6; });
    if (found == sections.end()) {
      std::vector<double> known;
      for (const geometry::BladeSection& section : sections) known.push_back(ratio(section));
      refuse(edit.where, fmt::format("found r/R = {}; the blade has sections at {:.6g}", edit.radius_ratio,
                                     fmt::join(known, ", ")));
    }
    edits.push_back({edit.smooth   ? Kind::smooth_at_knot
                     : edit.move_x ? Kind::move_along_shaft
                                   : Kind::move_on_cylinder,
                     static_cast<std::size_t>(found - sections.begin()), edit.point - 1,
                     edit.move_x.value_or(edit.move_y.value_or(0.0))});
  }
  return edits;
}

}  // namespace isorim::io
