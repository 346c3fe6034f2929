#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/case/value.h"

/// Everything that is wrong with a case file, gathered so that one run names it all.
namespace isorim::io {

/// A key of a case file: where its value was written and how the key is called from the root,
/// "geometry.loops[2].radius" (lists count from 1 in messages).
struct KeyPlace {
  Place place;
  std::string path;

  /// The key `name` of the table that stands here, itself written at `value_place`.
  KeyPlace key(std::string_view name, const Place& value_place) const;
  /// Item `index` (from 0) of the list that stands here.
  KeyPlace item(std::size_t index, const Place& value_place) const;
};

class Complaints {
 public:
  /// "case.toml:12: geometry.radius: message".
  void add(const KeyPlace& where, std::string_view message);
  /// A message that already says where.
  void add(std::string message);
  bool empty() const { return entries_.empty(); }
  std::size_t count() const { return entries_.size(); }
  /// Whether something was said of a key whose path begins like this: what follows from it needs no saying.
  bool concern(std::string_view path) const;
  /// Throws InputError with every complaint, one a line, in the order of the file.
  void throw_if_any() const;

 private:
  struct Entry {
    int line = 0;
    std::string path;
    std::string text;
  };
  std::vector<Entry> entries_;
};

/// The candidate nearest to `word` by edit distance (insertions, deletions, substitutions, swaps of neighbours),
/// as ` (did you mean "radius"?)`; empty if none is near enough to be meant (a third of the word's length, at
/// least 2).
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace isorim::io
