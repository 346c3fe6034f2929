#pragma once

#include <cstdlib>
#include <filesystem>

namespace isorim::io {

/// Files by other people's CAD, which are not ours to keep here: the folder is that of the environment variable
/// ISORIM_REAL_CASES, or ../shared/cases/real beside the source tree. Tests skip where it is missing.
inline std::filesystem::path real_cases() {
  const char* folder = std::getenv("ISORIM_REAL_CASES");
  return folder ? std::filesystem::path(folder)
                : std::filesystem::path(ISORIM_SOURCE_DIR).parent_path() / "shared/cases/real";
}

}  // namespace isorim::io
