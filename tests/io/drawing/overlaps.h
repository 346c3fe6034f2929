#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/drawing/drawing.h"

namespace isorim::io::drawing {

inline bool overlap(const Rectangle& a, const Rectangle& b) {
  return (a.lower.array() < b.upper.array()).all() && (b.lower.array() < a.upper.array()).all();
}

/// "text / text" for each pair of texts that lie over each other, on whatever layers.
inline std::vector<std::string> overlapping_texts(const Drawing& drawing) {
  std::vector<Text> texts;
  for (std::size_t layer = 0; layer < drawing.layers().size(); ++layer) {
    for (const Entity& entity : drawing.entities(layer))
      if (const auto* text = std::get_if<Text>(&entity)) texts.push_back(*text);
  }
  std::vector<std::string> result;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (overlap(extent(Entity(texts[i])), extent(Entity(texts[k]))))
        result.push_back(fmt::format("{} / {}", texts[k].text, texts[i].text));
    }
  }
  return result;
}

/// Nothing leaves the page.
inline bool is_on_page(const Sheet& sheet) {
  const Rectangle drawn = extent(sheet.drawing);
  return (sheet.page.lower.array() <= drawn.lower.array()).all() &&
         (drawn.upper.array() <= sheet.page.upper.array()).all();
}

}  // namespace isorim::io::drawing
