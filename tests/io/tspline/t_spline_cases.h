#pragma once

#include <cstdlib>
#include <filesystem>

namespace isorim::io {

/// T-splines by other people's programs, which are not ours to keep here: the folder is that of the environment
/// variable ISORIM_T_SPLINE_CASES, or ../shared/cases/tspline beside the source tree. Tests skip where it is missing.
inline std::filesystem::path t_spline_cases() {
  const char* folder = std::getenv("ISORIM_T_SPLINE_CASES");
  return folder ? std::filesystem::path(folder)
                : std::filesystem::path(ISORIM_SOURCE_DIR).parent_path() / "shared/cases/tspline";
}

}  // namespace isorim::io
