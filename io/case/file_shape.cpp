#include "io/case/file_shape.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/cad/assemble.h"
#include "io/cad/read_cad.h"
#include "io/case/curve_builder.h"
#include "io/case/face_builder.h"

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

/// Cuts the solids of a file; what is known of the patches stays with those that are left.
geometry::Boundary<3> clipped_file(const geometry::Boundary<3>& solid, const FileKeys& keys, CadFacts& facts) {
  geometry::OrientationOptions orientation;
  orientation.largest_relative_gap = geometry::OrientationOptions::file_gap;
  std::map<std::string, PatchOrigin> origins;
  for (std::size_t i = 0; i < solid.patches.size(); ++i) {
    PatchOrigin& origin = facts.patches[i];
    orientation.shared_edges.push_back(origin.edges);
    // Loops that are cut have other curves.
    origin.edges.clear();
    origins.emplace(solid.patches[i].name, std::move(origin));
  }
  geometry::Boundary<3> left = clipped(solid, keys.clip, keys.where, orientation);
  facts.patches.clear();
  for (const geometry::Patch<3>& patch : left.patches) {
    const auto found = origins.find(patch.name);
    facts.patches.push_back(found == origins.end() ? PatchOrigin{} : found->second);
  }
  return left;
}

/// Moved, cut and named.
template <int Dim>
geometry::Boundary<Dim> finished_file(geometry::Boundary<Dim> boundary, const FileKeys& keys, CadFacts& facts) {
  if (keys.clip.items.empty()) return finished<Dim>(std::move(boundary), keys);
  if constexpr (Dim == 2) {
    refuse(keys.where, "found \"clip\"; a shape of the plane cannot be clipped");
  } else {
    ShapeKeys moving;
    moving.transform = keys.transform;
    ShapeKeys naming;
    naming.name = keys.name;
    return finished<3>(clipped_file(finished<3>(std::move(boundary), moving), keys, facts), naming);
  }
}

}  // namespace

FileShape build_file_shape(const FileKeys& keys, const FileShapeOptions& options) {
  AssembledModel assembled = load_located(keys, options);
  AnyBoundary boundary = std::visit(
      [&]<int Dim>(geometry::Boundary<Dim>& patches) -> AnyBoundary {
        return BuiltBoundary<Dim>{
            located(keys.where, [&] { return finished_file<Dim>(std::move(patches), keys, assembled.facts); }), {}};
      },
      assembled.boundary);
  return {std::move(boundary), std::move(assembled.facts)};
}

}  // namespace isorim::io
