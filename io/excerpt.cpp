#include "io/excerpt.h"

#include <fmt/format.h>

namespace isorim::io {
namespace {

/// Whether a byte goes on with the character of UTF-8 that another has begun.
bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

std::string excerpt(std::string_view text, std::size_t most) {
  std::size_t end = text.size();
  if (end > most) {
    end = most;
    while (end > 0 && continues(text[end])) --end;
  }
  std::string result;
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_control = byte < 0x20U || byte == 0x7FU;
    result += is_control ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return end < text.size() ? result + "..." : result;
}

}  // namespace isorim::io
