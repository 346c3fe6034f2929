#include "geometry/hull/offset_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

/// Numbers of lines besides the waterlines (0, 1, ...).
constexpr int no_line = -1;
constexpr int keel_line = -2;
constexpr int deck_line = -3;
constexpr int first_knuckle_line = -10;

[[noreturn]] void refuse(const OffsetTable& table, const std::string& what) {
  throw GeometryError(fmt::format("hull \"{}\": {}", table.name, what));
}

void check_positive(const OffsetTable& table, const char* quantity, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    refuse(table, fmt::format("the {} is {}; expected a positive number", quantity, value));
}

void check_rising(const OffsetTable& table, const char* what, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) refuse(table, fmt::format("{} {} is {}, not a number", what, i + 1, values[i]));
    if (i > 0 && !(values[i - 1] < values[i])) {
      refuse(table,
             fmt::format("{} {} lies at {}, not beyond {} of the one before", what, i + 1, values[i], values[i - 1]));
    }
  }
}

void check_count(const OffsetTable& table, const std::string& what, Eigen::Index found, std::size_t expected) {
  if (std::cmp_not_equal(found, expected))
    refuse(table, fmt::format("{} for {} stations, found {}", what, expected, found));
}

/// Columns of half-breadth and height, NaN heights allowed where they may be missing.
void check_places(const OffsetTable& table, const std::string& what, const Points<2>& places, bool may_be_missing) {
  if (may_be_missing && places.cols() == 0) return;
  check_count(table, what, places.cols(), table.stations.size());
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    if ((may_be_missing || is_bulb_station(table, i)) && std::isnan(places(1, i))) continue;
    if (!places.col(i).allFinite() || places(0, i) < 0.0) {
      refuse(table, fmt::format("{} at station {}: half-breadth {}, height {}; expected numbers, the first not "
                                "negative",
                                what, table.station_names[std::size_t(i)], places(0, i), places(1, i)));
    }
  }
}

/// x of the last station that is no section of the bulb.
double last_full_station(const OffsetTable& table) {
  for (auto i = static_cast<Eigen::Index>(table.stations.size()); i-- > 0;)
    if (!is_bulb_station(table, i)) return table.stations[static_cast<std::size_t>(i)];
  refuse(table, fmt::format("all stations lie ahead of the stem, which begins at x = {}", table.stem(0, 0)));
}

/// Points ahead of (abaft) the station at `limit`.
void check_contour_points(const OffsetTable& table, const char* what, const Points<2>& contour, double limit,
                          bool is_ahead) {
  if (contour.cols() < 2) refuse(table, fmt::format("the {} has one point; expected at least two", what));
  if (!contour.allFinite()) refuse(table, fmt::format("the {} has a point that is not finite", what));
  for (Eigen::Index i = 0; i < contour.cols(); ++i) {
    const double x = contour(0, i);
    if (is_ahead ? x > limit : x < limit) continue;
    refuse(table, fmt::format("point {} of the {} lies at x = {}; expected it {} all stations ({}): leave out stations "
                              "that the contour crosses; where these are sections of a bulb, give its contour as "
                              "\"bulb\" and the stem from the notch above it upwards",
                              i + 1, what, x, is_ahead ? "ahead of" : "abaft", limit));
  }
}

void check_contour(const OffsetTable& table, const char* what, const Points<2>& contour,
                   const std::vector<int>& knuckles, bool is_ahead) {
  if (contour.cols() == 0) return;
  check_contour_points(table, what, contour, is_ahead ? last_full_station(table) : table.stations.front(), is_ahead);
  if (knuckles.size() != table.knuckles.size()) {
    refuse(table, fmt::format("the {} has {} points on knuckles; expected one for each of {}", what, knuckles.size(),
                              table.knuckles.size()));
  }
  for (const int column : knuckles) {
    if (column <= 0 || column + 1 >= contour.cols())
      refuse(table,
             fmt::format("a knuckle ends at point {} of the {}; expected one between its ends", column + 1, what));
  }
}

void check_bulb(const OffsetTable& table) {
  if (table.bulb.cols() == 0) return;
  if (table.stem.cols() == 0)
    refuse(table, "there is a bulb but no stem; expected the stem's contour from the notch above the bulb upwards");
  check_contour_points(table, "bulb", table.bulb, table.stations.back(), true);
  for (const KnuckleLine& line : table.knuckles) {
    for (Eigen::Index i = 0; i < line.places.cols(); ++i) {
      if (!is_bulb_station(table, i) || std::isnan(line.places(1, i))) continue;
      refuse(table, fmt::format("knuckle \"{}\" has a place at station {}, which lies in the bulb; expected none there",
                                line.name, table.station_names[std::size_t(i)]));
    }
  }
}

void check_half_breadths(const OffsetTable& table) {
  const auto stations = static_cast<Eigen::Index>(table.stations.size());
  const auto waterlines = static_cast<Eigen::Index>(table.waterlines.size());
  if (table.half_breadths.rows() != waterlines || table.half_breadths.cols() != stations) {
    refuse(table, fmt::format("{} x {} half-breadths for {} waterlines and {} stations", table.half_breadths.rows(),
                              table.half_breadths.cols(), waterlines, stations));
  }
  for (Eigen::Index i = 0; i < stations; ++i) {
    for (Eigen::Index j = 0; j < waterlines; ++j) {
      const double y = table.half_breadths(j, i);
      if (std::isnan(y) || (std::isfinite(y) && y >= 0.0)) continue;
      refuse(table, fmt::format("the half-breadth at station {}, height {} is {}; expected a number that is not "
                                "negative",
                                table.station_names[std::size_t(i)], table.waterlines[std::size_t(j)], y));
    }
  }
}

struct SectionPoint {
  double y;
  double z;
  int line;
};

/// The knuckles put between the points of a section by their heights; one that coincides with a point replaces it.
void add_knuckles(const OffsetTable& table, Eigen::Index station, std::vector<SectionPoint>& points) {
  if (is_bulb_station(table, station)) return;
  for (std::size_t k = 0; k < table.knuckles.size(); ++k) {
    const SectionPoint knuckle{table.knuckles[k].places(0, station), table.knuckles[k].places(1, station),
                               first_knuckle_line - static_cast<int>(k)};
    const auto above = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.z >= knuckle.z; });
    if (above == points.begin() || above == points.end()) {
      refuse(table, fmt::format("station {}: knuckle \"{}\" at height {} does not lie between the keel and the deck, "
                                "{} and {}",
                                table.station_names[std::size_t(station)], table.knuckles[k].name, knuckle.z,
                                points.front().z, points.back().z));
    }
    if (above->z > knuckle.z) {
      points.insert(above, knuckle);
    } else if (above->y == knuckle.y && above + 1 != points.end()) {
      *above = knuckle;
    } else {
      refuse(table, fmt::format("station {}: knuckle \"{}\" lies at the height {} of a point with half-breadth {}, its "
                                "own is {}; leave that half-breadth out",
                                table.station_names[std::size_t(station)], table.knuckles[k].name, knuckle.z, above->y,
                                knuckle.y));
    }
  }
}

std::optional<SectionPoint> end_point(const Points<2>& edge, Eigen::Index station, int line) {
  if (edge.cols() == 0 || std::isnan(edge(1, station))) return std::nullopt;
  return SectionPoint{edge(0, station), edge(1, station), line};
}

HullSection assembled(const OffsetTable& table, std::string name, std::span<const SectionPoint> points,
                      const std::vector<double>& x) {
  HullSection section;
  section.name = std::move(name);
  section.points.resize(3, static_cast<Eigen::Index>(points.size()));
  section.ends.push_back(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    section.points.col(static_cast<Eigen::Index>(i)) << x[i], points[i].y, points[i].z;
    section.lines.push_back(points[i].line);
    if (points[i].line <= first_knuckle_line) section.ends.push_back(static_cast<int>(i));
  }
  section.ends.push_back(static_cast<int>(points.size()) - 1);
  if (points.size() < 2)
    refuse(table, fmt::format("{} has {} point(s); expected at least two", section.name, points.size()));
  return section;
}

HullSection station_section(const OffsetTable& table, Eigen::Index station) {
  const std::optional<SectionPoint> keel = end_point(table.keel, station, keel_line);
  const std::optional<SectionPoint> deck = end_point(table.deck, station, deck_line);
  std::vector<SectionPoint> points;
  if (keel) points.push_back(*keel);
  for (std::size_t j = 0; j < table.waterlines.size(); ++j) {
    const double y = table.half_breadths(static_cast<Eigen::Index>(j), station);
    const double z = table.waterlines[j];
    if (std::isnan(y) || (keel && z <= keel->z) || (deck && z >= deck->z)) continue;
    points.push_back({y, z, static_cast<int>(j)});
  }
  if (deck) points.push_back(*deck);
  add_knuckles(table, station, points);
  const auto i = static_cast<std::size_t>(station);
  HullSection section = assembled(table, fmt::format("station {}", table.station_names[i]), points,
                                  std::vector<double>(points.size(), table.stations[i]));
  section.is_level_at_keel = table.has_tangent_bottom && keel && keel->y > 0.0;
  section.is_in_bulb = is_bulb_station(table, station);
  return section;
}

/// A section of the bulb begins and ends in the centre plane.
void check_bulb_section(const OffsetTable& table, const HullSection& section) {
  for (const Eigen::Index end : {Eigen::Index{0}, section.points.cols() - 1}) {
    if (section.points(1, end) == 0.0) continue;
    refuse(table, fmt::format("{} lies ahead of the stem (x = {}), in the bulb, and {} with the half-breadth {} at "
                              "height {}; expected it in the centre plane there, by \"keel\" and \"deck\" with the "
                              "half-breadth 0",
                              section.name, table.stem(0, 0), end == 0 ? "begins" : "ends", section.points(1, end),
                              section.points(2, end)));
  }
}

/// Between the ends of the hull a section may touch the centre plane at its keel and deck only.
void check_thickness(const OffsetTable& table, const HullSection& section) {
  for (Eigen::Index i = 0; i + 1 < section.points.cols(); ++i) {
    if (section.points(1, i) > 0.0 || section.points(1, i + 1) > 0.0) continue;
    refuse(table, fmt::format("{} has no thickness between the heights {} and {}; leave the half-breadths of such "
                              "waterlines empty",
                              section.name, section.points(2, i), section.points(2, i + 1)));
  }
}

int line_at(const OffsetTable& table, double z) {
  const auto found = std::find(table.waterlines.begin(), table.waterlines.end(), z);
  return found == table.waterlines.end() ? no_line : static_cast<int>(found - table.waterlines.begin());
}

HullSection contour_section(const OffsetTable& table, const char* name, const Points<2>& contour,
                            const std::vector<int>& knuckles) {
  std::vector<SectionPoint> points;
  std::vector<double> x;
  for (Eigen::Index i = 0; i < contour.cols(); ++i) {
    points.push_back({0.0, contour(1, i), line_at(table, contour(1, i))});
    x.push_back(contour(0, i));
  }
  if (table.keel.cols() > 0) points.front().line = keel_line;
  if (table.deck.cols() > 0) points.back().line = deck_line;
  for (std::size_t k = 0; k < knuckles.size(); ++k)
    points[static_cast<std::size_t>(knuckles[k])].line = first_knuckle_line - static_cast<int>(k);
  HullSection section = assembled(table, name, points, x);
  section.is_contour = true;
  return section;
}

void check_knuckle_order(const OffsetTable& table, const std::vector<HullSection>& sections) {
  const auto order = [](const HullSection& section) {
    std::vector<int> lines;
    for (std::size_t k = 1; k + 1 < section.ends.size(); ++k)
      lines.push_back(section.lines[static_cast<std::size_t>(section.ends[k])]);
    return lines;
  };
  for (const HullSection& section : sections) {
    if (section.is_in_bulb) continue;
    if (order(section) == order(sections.front())) continue;
    refuse(table, fmt::format("{} meets the knuckles in another order than {}", section.name, sections.front().name));
  }
}

}  // namespace

bool is_bulb_station(const OffsetTable& table, Eigen::Index station) {
  return table.bulb.cols() > 0 && table.stem.cols() > 0 &&
         table.stations[static_cast<std::size_t>(station)] > table.stem(0, 0);
}

void check(const OffsetTable& table) {
  check_positive(table, "length", table.length);
  check_positive(table, "beam", table.beam);
  check_positive(table, "draught", table.draught);
  if (table.stations.size() < 2)
    refuse(table, fmt::format("{} station(s); expected at least two", table.stations.size()));
  check_count(table, "names", static_cast<Eigen::Index>(table.station_names.size()), table.stations.size());
  check_rising(table, "station", table.stations);
  check_rising(table, "waterline", table.waterlines);
  check_half_breadths(table);
  check_places(table, "keel", table.keel, true);
  check_places(table, "deck", table.deck, true);
  for (const KnuckleLine& line : table.knuckles)
    check_places(table, fmt::format("knuckle \"{}\"", line.name), line.places, false);
  check_contour(table, "stem", table.stem, table.stem_knuckles, true);
  check_contour(table, "stern", table.stern, table.stern_knuckles, false);
  check_bulb(table);
  if (!table.area_ratios.empty())
    check_count(table, "areas", static_cast<Eigen::Index>(table.area_ratios.size()), table.stations.size());
}

std::vector<HullSection> hull_sections(const OffsetTable& table) {
  check(table);
  std::vector<HullSection> sections;
  if (table.stern.cols() > 0) sections.push_back(contour_section(table, "stern", table.stern, table.stern_knuckles));
  const auto add_stem = [&] {
    if (table.stem.cols() > 0) sections.push_back(contour_section(table, "stem", table.stem, table.stem_knuckles));
  };
  bool has_stem = false;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(table.stations.size()); ++i) {
    if (is_bulb_station(table, i) && !std::exchange(has_stem, true)) add_stem();
    sections.push_back(station_section(table, i));
  }
  if (!has_stem) add_stem();
  if (table.bulb.cols() > 0) {
    sections.push_back(contour_section(table, "bulb", table.bulb, {}));
    sections.back().is_in_bulb = true;
    sections.back().lines.back() = no_line;
  }
  for (std::size_t i = 1; i + 1 < sections.size(); ++i) {
    if (!sections[i].is_contour) check_thickness(table, sections[i]);
    if (sections[i].is_in_bulb) check_bulb_section(table, sections[i]);
  }
  check_knuckle_order(table, sections);
  return sections;
}

OffsetTable scaled(const OffsetTable& table, const Vector3& factors) {
  OffsetTable result = table;
  const auto along = [&](double x) { return factors.x() * x; };
  const auto up = [&](double z) { return factors.z() * z; };
  result.after_perpendicular = along(table.after_perpendicular);
  result.baseline = up(table.baseline);
  result.length *= factors.x();
  result.beam *= factors.y();
  result.draught *= factors.z();
  for (double& x : result.stations) x = along(x);
  for (double& z : result.waterlines) z = up(z);
  result.half_breadths *= factors.y();
  const auto scale_places = [&](Points<2>& places) {
    for (Eigen::Index i = 0; i < places.cols(); ++i) places.col(i) << factors.y() * places(0, i), up(places(1, i));
  };
  scale_places(result.keel);
  scale_places(result.deck);
  for (KnuckleLine& line : result.knuckles) scale_places(line.places);
  for (Points<2>* contour : {&result.stem, &result.stern, &result.bulb}) {
    for (Eigen::Index i = 0; i < contour->cols(); ++i) contour->col(i) << along((*contour)(0, i)), up((*contour)(1, i));
  }
  return result;
}

}  // namespace isorim::geometry
