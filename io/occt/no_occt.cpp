// What io/occt/occt_reader.h declares in a build without OpenCASCADE.

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/occt/occt_reader.h"

namespace isorim::io {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const char* what) {
  throw InputError(
      fmt::format("{}: {} needs OpenCASCADE, which this program was built without; install "
                  "libocct-data-exchange-dev and build again",
                  path.string(), what));
}

}  // namespace

bool has_occt() {
  return false;
}

std::string occt_version() {
  return {};
}

CadModel read_step(const std::filesystem::path& path) {
  refuse(path, "reading STEP");
}

CadModel read_iges_repaired(const std::filesystem::path& path, double /*sewing_tolerance*/) {
  refuse(path, "repairing IGES");
}

}  // namespace isorim::io
