#include "io/case/file_shape.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/cad/assemble.h"
#include "io/cad/read_cad.h"
#include "io/case/curve_builder.h"

namespace isorim::io {
namespace {

/// Every refused face in one message, but no more than a screen holds.
void require_all_faces(const CadFacts& facts) {
  if (facts.refused.empty()) return;
  constexpr std::size_t most = 10;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(most, facts.refused.size()); ++i) {
    const RefusedEntity& refused = facts.refused[i];
    texts.push_back(fmt::format("{} ({}): {}", refused.name, refused.entity, refused.reason));
  }
  if (facts.refused.size() > most) {
    texts.push_back(fmt::format("and {} more; isorim check lists them all", facts.refused.size() - most));
  }
  throw InputError(
      fmt::format("{} of {} faces cannot be taken: {}", facts.refused.size(), facts.faces, fmt::join(texts, "; ")));
}

AssembledModel load(const FileKeys& keys, const std::filesystem::path& path, const FileShapeOptions& options) {
  const bool refuse_bad = options.refused_faces == RefusedFaces::refuse;
  const CadModel model = read_cad(path, {.blanked = keys.blanked,
                                         .bad_entities = refuse_bad ? BadEntities::refuse : BadEntities::skip,
                                         .repair = keys.repair});
  try {
    AssembledModel assembled = assemble(model, {.unit = keys.units,
                                                .dimension = keys.dimension,
                                                .names = keys.names,
                                                .levels = keys.levels,
                                                .threads = options.threads});
    if (refuse_bad) require_all_faces(assembled.facts);
    return assembled;
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
}

/// As load(); messages begin with the place in the case.
AssembledModel load_located(const FileKeys& keys, const FileShapeOptions& options) {
  const std::filesystem::path path(keys.path);
  try {
    return load(keys, path.is_absolute() ? path : keys.folder / path, options);
  } catch (InputError& error) {
    // A CAD file that is run by itself has no line of a case to be named.
    if (keys.where.place.line > 0) {
      error.add_context(fmt::format("{}: {}", keys.where.place.describe(), keys.where.path));
    }
    throw;
  }
}

}  // namespace

FileShape build_file_shape(const FileKeys& keys, const FileShapeOptions& options) {
  AssembledModel assembled = load_located(keys, options);
  AnyBoundary boundary = std::visit(
      [&]<int Dim>(geometry::Boundary<Dim>& patches) -> AnyBoundary {
        return BuiltBoundary<Dim>{located(keys.where, [&] { return finished<Dim>(std::move(patches), keys); }), {}};
      },
      assembled.boundary);
  return {std::move(boundary), std::move(assembled.facts)};
}

}  // namespace isorim::io
