#pragma once

#include <string>

#include "geometry/hull/offset_table.h"

namespace isorim::geometry {

/// Offsets of Wigley's hull, z = 0 at the keel, x = 0 amidships.
inline OffsetTable wigley_table(int stations, int waterlines, double length = 10.0, double beam = 1.0,
                                double draught = 0.625) {
  OffsetTable table;
  table.name = "Wigley";
  table.length = length;
  table.beam = beam;
  table.draught = draught;
  table.after_perpendicular = -0.5 * length;
  table.half_breadths.resize(waterlines, stations);
  for (int j = 0; j < waterlines; ++j) table.waterlines.push_back(draught * j / (waterlines - 1));
  for (int i = 0; i < stations; ++i) {
    const double x = -1.0 + 2.0 * i / (stations - 1);
    table.stations.push_back(0.5 * length * x);
    table.station_names.push_back(std::to_string(i));
    for (int j = 0; j < waterlines; ++j) {
      const double z = 1.0 * j / (waterlines - 1) - 1.0;
      table.half_breadths(j, i) = 0.5 * beam * (1.0 - x * x) * (1.0 - z * z);
    }
  }
  return table;
}

}  // namespace isorim::geometry
