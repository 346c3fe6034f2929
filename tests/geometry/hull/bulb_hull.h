#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/hull/offset_table.h"

namespace isorim::geometry {

/// A hull with a bulbous bow by formulas, x = 0 at the after end, z = 0 at the keel, deck at z = 9. With
/// q(x) = 1 - ((x - 82) / 24)^2 forward of x = 82 and 1 abaft of it the keel and the top of the bulb are
///   zb = 3 - 3 sqrt(q),   zt = 3 + 2.2 sqrt(q),
/// so the bulb ends at x = 106; the stem is the line x_s(z) = 98 + 0.4 (z - zt(98)), which meets the bulb's top at the
/// notch. Half-breadths are y = sqrt(M^2 + E^2) of the hull proper and the bulb, an ellipse in every section:
///   M = 32 s (1 - s) (1 - (1 - t)^4) for s < 1, else 0,   s = x / x_s(z),   t = (z - zb) / (9 - zb),
///   E^2 = 2.4^2 b 4 (z - zb)(zt - z) / (zt - zb)^2 for z < zt, else 0,
///   b = q forward of x = 82, (1 - ((82 - x) / 50)^2)^2 for 32 < x < 82, else 0.
struct BulbHull {
  static constexpr double start = 82.0;
  static constexpr double reach = 24.0;
  static constexpr double notch_x = 98.0;
  static constexpr double deck = 9.0;

  static double shrinking(double x) { return x < start ? 1.0 : 1.0 - (x - start) * (x - start) / (reach * reach); }
  static double keel(double x) { return 3.0 - 3.0 * std::sqrt(shrinking(x)); }
  static double top(double x) { return 3.0 + 2.2 * std::sqrt(shrinking(x)); }
  static double notch_z() { return top(notch_x); }
  static double stem(double z) { return notch_x + 0.4 * (z - notch_z()); }

  static double half_breadth(double x, double z) {
    const double low = keel(x);
    const double s = x / stem(z);
    const double above = 1.0 - (z - low) / (deck - low);
    const double hull = s < 1.0 ? 32.0 * s * (1.0 - s) * (1.0 - std::pow(above, 4)) : 0.0;
    const double aft = (start - x) / 50.0;
    const double fullness = x > start ? shrinking(x) : aft < 1.0 ? std::pow(1.0 - aft * aft, 2) : 0.0;
    const double high = top(x);
    const double bulb =
        z < high ? 2.4 * 2.4 * fullness * 4.0 * (z - low) * (high - z) / ((high - low) * (high - low)) : 0.0;
    return std::sqrt(hull * hull + bulb);
  }
};

/// Its offsets, the more the larger `parts` is: in steps of 5 / parts in x (half of that in the fore body and again in
/// the bulb) and 0.5 / parts in z (twice that above z = 6, less next to the keel, where sections are round).
inline OffsetTable bulb_table(int parts) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  OffsetTable table;
  table.name = "Bulbous bow";
  table.source = "y^2 = M^2 + E^2 evaluated";
  table.length = 98.0;
  table.beam = 16.0;
  table.draught = 6.0;
  const double step = 5.0 / parts;
  const auto add_stations = [&](double from, double to, double by) {
    for (int i = 0; from + i * by < to - 1e-9; ++i) table.stations.push_back(from + i * by);
  };
  add_stations(0.0, 70.0, step);
  add_stations(70.0, 97.5, 0.5 * step);
  add_stations(98.0 + 0.25 * step, 105.0, 0.25 * step);
  for (std::size_t i = 0; i < table.stations.size(); ++i) table.station_names.push_back(std::to_string(i));
  for (const double z : {0.05, 0.15, 0.3}) table.waterlines.push_back(z / parts);
  for (int j = 1; j <= 12 * parts; ++j) table.waterlines.push_back(0.5 / parts * j);
  for (int j = 1; j < 3 * parts; ++j) table.waterlines.push_back(6.0 + 1.0 / parts * j);
  const auto stations = static_cast<Eigen::Index>(table.stations.size());
  const auto waterlines = static_cast<Eigen::Index>(table.waterlines.size());
  table.half_breadths = Eigen::MatrixXd::Constant(waterlines, stations, none);
  table.keel = Points<2>::Zero(2, stations);
  table.deck = Points<2>::Zero(2, stations);
  for (Eigen::Index i = 0; i < stations; ++i) {
    const double x = table.stations[static_cast<std::size_t>(i)];
    const double low = BulbHull::keel(x);
    const double high = x > BulbHull::notch_x ? BulbHull::top(x) : BulbHull::deck;
    table.keel.col(i) << 0.0, low;
    table.deck.col(i) << (x > BulbHull::notch_x ? 0.0 : BulbHull::half_breadth(x, high)), high;
    for (Eigen::Index j = 0; j < waterlines; ++j) {
      const double z = table.waterlines[static_cast<std::size_t>(j)];
      // Too near to the ends of the section to say anything.
      const double margin = 0.04 / parts;
      if (z > low + margin && z < high - margin) table.half_breadths(j, i) = BulbHull::half_breadth(x, z);
    }
  }
  const int stem_points = 4 + 4 * parts;
  table.stem.resize(2, stem_points + 1);
  for (int k = 0; k <= stem_points; ++k) {
    const double z = BulbHull::notch_z() + (BulbHull::deck - BulbHull::notch_z()) * k / stem_points;
    table.stem.col(k) << BulbHull::stem(z), z;
  }
  // From the last station on, in steps of the angle.
  const int nose_points = 8 * parts;
  const double before = table.stations.back() + 0.25 * (106.0 - table.stations.back());
  const double end = std::acos((before - BulbHull::start) / BulbHull::reach);
  table.bulb.resize(2, nose_points + 1);
  for (int k = 0; k <= nose_points; ++k) {
    const double angle = end * (2.0 * k / nose_points - 1.0);
    table.bulb.col(k) << BulbHull::start + BulbHull::reach * std::cos(angle),
        3.0 + (angle < 0.0 ? 3.0 : 2.2) * std::sin(angle);
  }
  return table;
}

}  // namespace isorim::geometry
