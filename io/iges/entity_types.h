#pragma once

#include <string_view>
#include <vector>

#include "io/iges/file.h"

namespace isorim::io::iges {

/// What becomes of an entity that stands for itself.
enum class Role {
  solid,     // 186, 430
  shell,     // 514
  face,      // 143, 144, 510
  surface,   // a face if nothing uses it
  curve,     // 100, 102, ...
  point,     // 116, 106 forms 1 to 3
  instance,  // 408
  part,      // is read by what refers to it
  note,      // annotation, views and the like: no geometry
  unknown,   // not read by this program
};

Role role_of(const Entity& entity);

/// "trimmed parametric surface"; empty for numbers that the standard does not have.
std::string_view description_of(int type);

/// The entities that an entity is made of, as D numbers; groups and notes are none of it. Nothing is thrown for a
/// record that is not as it should be: what was found up to there counts.
std::vector<int> parts_of(const File& file, const Entity& entity);

}  // namespace isorim::io::iges
