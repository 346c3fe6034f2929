#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/intersection/plane_section.h"
#include "io/case/schema.h"

/// [[section]]: families of parallel planes that cut a solid.
namespace isorim::io {

struct PlaneSectionKeys {
  std::string name;
  std::optional<Coordinates> point;
  Coordinates normal;
  /// Distances from the point along the normal.
  std::vector<double> offsets;
  std::optional<double> from;
  std::optional<double> to;
  std::optional<double> step;
  std::optional<int> count;
  double fit_tolerance = 1e-8;
  KeyPlace where;
};

/// The distances of the planes from the point: as listed, or from, from + step, ... up to `to` (met exactly if a whole
/// number of steps leads there), or `count` equally spaced ones, or 0 alone.
std::vector<double> section_offsets(const PlaneSectionKeys& keys);

/// The planes, in the order of the offsets.
std::vector<geometry::PlaneFrame> section_planes(const PlaneSectionKeys& keys);

/// Of each family, [expect] may name these, as "NAME.area", ...: one value a plane, in the order of the offsets.
const std::vector<std::string>& section_quantity_names();

}  // namespace isorim::io
