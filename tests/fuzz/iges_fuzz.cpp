#include <cstddef>
#include <cstdint>
#include <string_view>

#include "geometry/errors.h"
#include "io/iges/file.h"
#include "io/iges/parameters.h"

namespace {

using isorim::io::iges::Entity;
using isorim::io::iges::File;
using isorim::io::iges::Parameters;

/// Reads every parameter of an entity in each way.
template <class Read>
void read_all(const File& file, const Entity& entity, Read read) {
  try {
    Parameters parameters(file, entity);
    while (parameters.remaining() > 0) read(parameters);
    static_cast<void>(parameters.trailing_pointers());
  } catch (const isorim::InputError&) {
    // What a file deserves that is no IGES.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const File file = isorim::io::iges::parse({reinterpret_cast<const char*>(data), size}, "fuzz.igs");
    for (const Entity& entity : file.entities) {
      read_all(file, entity, [](Parameters& parameters) { parameters.real(); });
      read_all(file, entity, [](Parameters& parameters) { parameters.integer(); });
      read_all(file, entity, [](Parameters& parameters) { parameters.text(); });
      read_all(file, entity, [](Parameters& parameters) { parameters.reals(parameters.count()); });
      read_all(file, entity, [](Parameters& parameters) { parameters.trailing_pointers(); });
    }
  } catch (const isorim::InputError&) {
    // The same.
  }
  return 0;
}
