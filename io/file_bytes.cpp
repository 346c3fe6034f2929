#include "io/file_bytes.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io {

std::string read_bytes(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::error_code ignored;
  if (!stream || std::filesystem::is_directory(path, ignored)) {
    throw InputError(fmt::format("cannot open '{}': {}", path.string(),
                                 stream ? "it is a folder" : std::strerror(errno != 0 ? errno : ENOENT)));
  }
  std::string bytes;
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored) bytes.reserve(size);
  constexpr std::size_t block = 1U << 20U;
  while (stream) {
    const std::size_t before = bytes.size();
    bytes.resize(before + block);
    stream.read(bytes.data() + before, static_cast<std::streamsize>(block));
    bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw InputError(fmt::format("cannot read '{}': {}", path.string(), std::strerror(errno)));
  return bytes;
}

}  // namespace isorim::io
