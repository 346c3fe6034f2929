#include <cstddef>
#include <cstdint>
#include <string_view>

#include "geometry/errors.h"
#include "io/iges/file.h"
#include "io/iges/parameters.h"
#include "io/iges/reader.h"

/// Whatever bytes a file holds, the reader returns or throws one of our errors: no crash, no hang, no memory beyond a
/// small multiple of the file (libFuzzer watches over time and memory).
namespace {

using isorim::io::iges::Entity;
using isorim::io::iges::File;
using isorim::io::iges::Parameters;

/// Reads every parameter of an entity in one way.
template <class Read>
void read_all(const File& file, const Entity& entity, Read read) {
  try {
    Parameters parameters(file, entity);
    while (parameters.remaining() > 0) read(parameters);
  } catch (const isorim::InputError&) {
  }
}

void read_values(const File& file) {
  for (const Entity& entity : file.entities) {
    read_all(file, entity, [](Parameters& parameters) { parameters.real(); });
    read_all(file, entity, [](Parameters& parameters) { parameters.integer(); });
    read_all(file, entity, [](Parameters& parameters) { parameters.text(); });
    read_all(file, entity, [](Parameters& parameters) { parameters.reals(parameters.count()); });
    read_all(file, entity, [](Parameters& parameters) { parameters.trailing_pointers(); });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const File file = isorim::io::iges::parse({reinterpret_cast<const char*>(data), size}, "fuzz.igs");
    read_values(file);
    static_cast<void>(isorim::io::read_iges(file));
  } catch (const isorim::Error&) {
    // What a file deserves that is not as it should be.
  }
  return 0;
}
