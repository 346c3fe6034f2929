#include "io/hull/hull_shape.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/hull/fairing.h"
#include "geometry/hull/hull.h"
#include "geometry/hull/sectional_areas.h"
#include "io/case/face_builder.h"
#include "io/hull/hull_library.h"
#include "io/hull/offset_file.h"

namespace isorim::io {
namespace {

using geometry::OffsetTable;
using geometry::Vector3;

/// Length 1, beam 1/10 and draught 1/16 of it, unless scaled: the proportions of the hull that is mostly tested.
OffsetTable unit_wigley() {
  return geometry::wigley_offsets(1.0, 0.1, 0.0625);
}

bool is_wigley(const HullKeys& keys) {
  return keys.library.empty() && keys.offsets == "wigley";
}

OffsetTable offsets_of(const HullKeys& keys) {
  const auto found = [&](const std::filesystem::path& path) { return path.is_absolute() ? path : keys.folder / path; };
  if (!keys.library.empty()) return read_hull(found(keys.library), keys.offsets);
  if (is_wigley(keys)) return unit_wigley();
  const std::filesystem::path path = keys.offsets;
  if (path.extension() == ".csv") return read_offsets(found(path));
  throw InputError(
      fmt::format("found offsets = \"{}\"; expected a file (.csv), \"wigley\", or a name together with "
                  "\"library\"",
                  keys.offsets));
}

/// What is absent follows the length.
Vector3 scale_factors(const OffsetTable& table, const HullScaleKeys& scale) {
  const double along = scale.length ? *scale.length / table.length : 1.0;
  return {along, scale.beam ? *scale.beam / table.beam : along, scale.draught ? *scale.draught / table.draught : along};
}

geometry::Boundary<3> finished_hull(geometry::Boundary<3> solid, const HullKeys& keys) {
  ShapeKeys moving;
  moving.transform = keys.transform;
  ShapeKeys naming;
  naming.name = keys.name;
  solid = finished<3>(std::move(solid), moving);
  if (!keys.clip.items.empty()) solid = clipped(solid, keys.clip, keys.where);
  return finished<3>(std::move(solid), naming);
}

HullFairing make_fair(OffsetTable& table, double tolerance, const geometry::HullSurfaceOptions& options) {
  geometry::FairedOffsets faired = fair_offsets(table, tolerance);
  HullFairing fairing{tolerance, faired.moved, faired.largest_move, faired.roughness_before, faired.roughness, {}};
  fairing.before = measure_fairness(table, hull_surface(hull_sections(table), options));
  table = std::move(faired.table);
  return fairing;
}

HullShape build(const HullKeys& keys) {
  const geometry::HullSurfaceOptions options{keys.parameters};
  HullShape shape;
  HullFacts& facts = shape.facts;
  facts.table = offsets_of(keys);
  if (keys.scale) facts.table = scaled(facts.table, scale_factors(facts.table, *keys.scale));
  const Eigen::MatrixXd given = facts.table.half_breadths;
  if (keys.fair) facts.fairing = make_fair(facts.table, *keys.fair, options);
  geometry::SectionalAreas areas = sectional_areas(facts.table, options);
  if (keys.shift) {
    const geometry::SectionShift target{
        keys.shift->prismatic.value_or(prismatic_coefficient(areas, facts.table)),
        keys.shift->lcb ? 0.01 * *keys.shift->lcb : buoyancy_centre(areas, facts.table)};
    facts.table = shift_sections(facts.table, target, options);
    areas = sectional_areas(facts.table, options);
  }
  facts.prismatic = prismatic_coefficient(areas, facts.table);
  facts.buoyancy_centre = buoyancy_centre(areas, facts.table);
  if (is_wigley(keys) && !keys.shift) {
    facts.port = {geometry::wigley_surface(facts.table.length, facts.table.beam, facts.table.draught)};
  } else {
    facts.port = hull_surface(hull_sections(facts.table), options);
  }
  OffsetTable as_given = facts.table;
  as_given.half_breadths = given;
  facts.offset_distance = largest_offset_distance(hull_sections(as_given), facts.port);
  facts.fairness = measure_fairness(facts.table, facts.port);
  shape.boundary.boundary = finished_hull(geometry::close_hull(facts.port), keys);
  return shape;
}

}  // namespace

HullShape build_hull_shape(const HullKeys& keys) {
  const std::string where = fmt::format("{}: {}", keys.where.place.describe(), keys.where.path);
  try {
    return build(keys);
  } catch (const GeometryError& error) {
    throw InputError(fmt::format("{}: {}", where, error.what()));
  } catch (InputError& error) {
    // What is refused by place has it already.
    if (!std::string_view(error.what()).starts_with(keys.where.place.describe())) error.add_context(where);
    throw;
  }
}

}  // namespace isorim::io
