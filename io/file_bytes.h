#pragma once

#include <filesystem>
#include <string>

namespace isorim::io {

/// The whole file. Throws InputError with the path and the system's reason if it cannot be read, or is a folder.
std::string read_bytes(const std::filesystem::path& path);

}  // namespace isorim::io
