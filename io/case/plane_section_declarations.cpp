#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "io/case/case_file.h"
#include "io/case/plane_section_keys.h"
#include "io/excerpt.h"

namespace isorim::io {
namespace {

constexpr int most_planes = 100000;
/// Of a step: what rounding may add to a whole number of them.
constexpr double whole_step = 1e-9;

int step_count(const PlaneSectionKeys& keys) {
  return static_cast<int>(std::floor((*keys.to - *keys.from) / *keys.step + whole_step));
}

bool is_plain(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  });
}

void check_coordinates(const Coordinates& coordinates, Complaints& complaints) {
  if (coordinates.values.empty() || coordinates.values.size() == 3) return;
  complaints.add(coordinates.where, fmt::format("found {} coordinates; expected 3", coordinates.values.size()));
}

void check_range(const PlaneSectionKeys& keys, const KeyPlace& where, Complaints& complaints) {
  const bool has_range = keys.from || keys.to || keys.step || keys.count;
  if (!keys.offsets.empty() && has_range) {
    complaints.add(where, "found both \"offsets\" and a range; expected one of them");
    return;
  }
  if (!has_range) return;
  if (!keys.from || !keys.to || keys.step.has_value() == keys.count.has_value()) {
    complaints.add(where, "expected \"from\", \"to\" and either \"step\" or \"count\"");
    return;
  }
  if (keys.count) {
    if (*keys.count == 1 && *keys.from != *keys.to)
      complaints.add(where.key("count", where.place), "found 1 plane between two different ends; expected 2 or more");
    return;
  }
  if (*keys.from > *keys.to) {
    complaints.add(where, fmt::format("found from = {} above to = {}", *keys.from, *keys.to));
  } else if ((*keys.to - *keys.from) / *keys.step > most_planes) {
    complaints.add(where.key("step", where.place), fmt::format("more than {} planes", most_planes));
  }
}

}  // namespace

template <>
const Schema<PlaneSectionKeys>& schema<PlaneSectionKeys>() {
  static const auto declared =
      Schema<PlaneSectionKeys>("section",
                               "Plane sections of a solid: a plane, or a family of parallel ones. Loops, open curves "
                               "and points of contact with areas, perimeters and centroids in results.json; "
                               "section_NAME.svg, .vtu, .csv and .igs.")
          .key("name", &PlaneSectionKeys::name, {.text = "Its name in the results.", .presence = Presence::required})
          .key("normal", &PlaneSectionKeys::normal,
               {.text = "Of the planes; of any length. Sections are seen against it.", .presence = Presence::required})
          .key("point", &PlaneSectionKeys::point,
               {.text = "A point of the plane at offset 0; the origin if absent.", .unit = "length"})
          .key("offsets", &PlaneSectionKeys::offsets,
               {.text = "Distances of the planes from the point, along the normal; 0 alone if absent.",
                .unit = "length"})
          .key("from", &PlaneSectionKeys::from, {.text = "Instead of offsets: the first.", .unit = "length"})
          .key("to", &PlaneSectionKeys::to,
               {.text = "The last, if a whole number of steps leads to it.", .unit = "length"})
          .key("step", &PlaneSectionKeys::step,
               {.text = "Distance from plane to plane.", .unit = "length", .range = Range::above(0)})
          .key("count", &PlaneSectionKeys::count,
               {.text = "Instead of a step: the number of planes, equally spaced, both ends among them.",
                .range = Range::between(1, most_planes)})
          .key("fit_tolerance", &PlaneSectionKeys::fit_tolerance,
               {.text = "How far the B-splines of the sections may lie from them, relative to the size of the shape.",
                .range = Range::between(1e-13, 0.1)})
          .check([](const PlaneSectionKeys& keys, const KeyPlace& where, Complaints& complaints) {
            if (!is_plain(keys.name))
              complaints.add(where.key("name", where.place),
                             fmt::format("found \"{}\"; expected letters, digits, _ and -", excerpt(keys.name)));
            check_coordinates(keys.normal, complaints);
            if (keys.point) check_coordinates(*keys.point, complaints);
            if (std::ranges::all_of(keys.normal.values, [](double x) { return x == 0.0; }))
              complaints.add(where.key("normal", where.place), "the normal is zero");
            check_range(keys, where, complaints);
          });
  return declared;
}

std::vector<double> section_offsets(const PlaneSectionKeys& keys) {
  if (!keys.offsets.empty()) return keys.offsets;
  // Keys that contradict each other have been complained of.
  if (!keys.from || !keys.to || (!keys.count && !(keys.step.value_or(0.0) > 0.0))) return {0.0};
  std::vector<double> offsets;
  if (keys.count) {
    for (int k = 0; k < *keys.count; ++k) {
      const double s = *keys.count > 1 ? static_cast<double>(k) / (*keys.count - 1) : 0.0;
      offsets.push_back(k + 1 == *keys.count && k > 0 ? *keys.to : *keys.from + s * (*keys.to - *keys.from));
    }
    return offsets;
  }
  const int steps = step_count(keys);
  for (int k = 0; k <= steps; ++k) offsets.push_back(*keys.from + k * *keys.step);
  if (std::abs(offsets.back() - *keys.to) <= whole_step * *keys.step) offsets.back() = *keys.to;
  return offsets;
}

std::vector<geometry::PlaneFrame> section_planes(const PlaneSectionKeys& keys) {
  const geometry::Vector3 normal(keys.normal.values[0], keys.normal.values[1], keys.normal.values[2]);
  geometry::Point3 point = geometry::Point3::Zero();
  if (keys.point) point << keys.point->values[0], keys.point->values[1], keys.point->values[2];
  std::vector<geometry::PlaneFrame> planes;
  for (const double offset : section_offsets(keys)) {
    const geometry::PlaneFrame frame = geometry::plane_frame(point, normal);
    planes.push_back(geometry::plane_frame(point + offset * frame.normal, normal));
  }
  return planes;
}

const std::vector<std::string>& section_quantity_names() {
  static const std::vector<std::string> names{"area",     "perimeter", "loops",        "chains",
                                              "touching", "isolated",  "double_points"};
  return names;
}

}  // namespace isorim::io
