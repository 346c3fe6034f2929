#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "io/case/shape_keys.h"

/// What the declarations of shapes share; for the .cpp files that declare them.
namespace isorim::io {

inline constexpr auto required = Presence::required;

/// A schema with the keys that every shape has; those of the shape itself come first.
template <class T>
Schema<T> with_common_keys(Schema<T> own) {
  own.key("name", &ShapeKeys::name,
          {.text = "Name of the patch, or the beginning of the names of the patches, in results and messages; made "
                   "from the type if absent."})
      .key("transform", &ShapeKeys::transform, {.text = "Moves the shape; a list is applied in its order."});
  if constexpr (std::is_base_of_v<SolidKeys, T>) {
    own.key(
        "clip", &SolidKeys::clip,
        {.text = "Cuts the closed solid, after the transform: { point, normal } takes away what lies on the side to "
                 "which the normal points; tools of other types keep what is inside or outside. What is cut is closed "
                 "by patches named \"cap\". A list is applied in its order."});
  } else {
    own.later({"clip"});
  }
  if constexpr (std::is_base_of_v<FaceKeys, T>) {
    own.key(
        "trims", &FaceKeys::trims,
        {.text = "Loops in the surface's parameters (u, v) that bound what is kept: outer loops, holes in them, and "
                 "so on by nesting. Holes that lie in no loop (role = \"hole\") are cut out of the whole surface."});
  }
  return own;
}

inline void complain_few(std::size_t found, std::size_t least, std::string_view what, const KeyPlace& where,
                         Complaints& complaints) {
  if (found < least) complaints.add(where, fmt::format("found {} {}; expected at least {}", found, what, least));
}

inline void check_dimensions(const std::vector<Coordinates>& points, std::size_t least, std::size_t most,
                             Complaints& complaints) {
  for (const Coordinates& point : points) {
    const std::size_t count = point.values.size();
    if (count < least || count > most || count != points.front().values.size()) {
      complaints.add(point.where,
                     fmt::format("found {} numbers; expected {}", count,
                                 least == most ? fmt::format("{}", least)
                                               : fmt::format("{} or {}, the same for every point", least, most)));
    }
  }
}

/// Exactly one of points, with weights or without, and homogeneous points.
inline void check_control_points(bool has_points, bool has_homogeneous, bool has_weights, const KeyPlace& where,
                                 Complaints& complaints) {
  if (has_points == has_homogeneous) {
    complaints.add(where, fmt::format("found {}; expected exactly one of \"points\" and \"homogeneous\"",
                                      has_points ? "both" : "neither"));
  }
  if (has_homogeneous && has_weights) {
    complaints.add(where, "found \"weights\" beside \"homogeneous\", whose last coordinates are the weights");
  }
}

}  // namespace isorim::io
