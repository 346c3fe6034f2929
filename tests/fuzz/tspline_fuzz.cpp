#include <cstddef>
#include <cstdint>
#include <string_view>

#include "geometry/errors.h"
#include "io/tspline/be.h"
#include "io/tspline/bext.h"
#include "io/tspline/iga.h"

/// Whatever bytes a file holds, the readers of T-splines return or throw one of our errors: no crash, no hang, no
/// memory beyond a small multiple of the file.
namespace {

template <class Read>
void attempt(Read read) {
  try {
    read();
  } catch (const isorim::Error&) {
    // What a file deserves that is not as it should be.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isorim::io;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  attempt([&] { static_cast<void>(tspline::model_of(tspline::parse_iga(text), "iga")); });
  attempt([&] { static_cast<void>(tspline::model_of(tspline::parse_be(text), "be")); });
  attempt([&] { static_cast<void>(tspline::parse_bext(text)); });
  return 0;
}
