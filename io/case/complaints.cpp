#include "io/case/complaints.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/excerpt.h"

namespace isorim::io {

KeyPlace KeyPlace::key(std::string_view name, const Place& value_place) const {
  return {value_place, path.empty() ? std::string(name) : fmt::format("{}.{}", path, name)};
}

KeyPlace KeyPlace::item(std::size_t index, const Place& value_place) const {
  return {value_place, fmt::format("{}[{}]", path, index + 1)};
}

void Complaints::add(const KeyPlace& where, std::string_view message) {
  std::string text = where.place.describe();
  if (!where.path.empty()) text += (text.empty() ? "" : ": ") + excerpt(where.path, 200);
  entries_.push_back({where.place.line, where.path, fmt::format("{}: {}", text, message)});
}

void Complaints::add(std::string message) {
  entries_.push_back({0, "", std::move(message)});
}

bool Complaints::concern(std::string_view path) const {
  return std::ranges::any_of(entries_, [&](const Entry& entry) { return entry.path.starts_with(path); });
}

void Complaints::throw_if_any() const {
  if (entries_.empty()) return;
  std::vector<Entry> sorted = entries_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) { return a.line < b.line; });
  std::vector<std::string> lines;
  for (const Entry& entry : sorted) lines.push_back(entry.text);
  throw InputError(fmt::format("{}", fmt::join(lines, "\n")));
}

namespace {

/// Optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, current);
  }
  return last[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  std::size_t best = std::max<std::size_t>(2, word.size() / 3) + 1;
  const std::string* nearest = nullptr;
  for (const std::string& candidate : candidates) {
    // A name must not be guessed from nothing: at least one letter has to agree.
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best && distance < std::max(word.size(), candidate.size())) {
      best = distance;
      nearest = &candidate;
    }
  }
  return nearest ? fmt::format(" (did you mean \"{}\"?)", *nearest) : "";
}

}  // namespace isorim::io
