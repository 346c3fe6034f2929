#pragma once

#include <algorithm>
#include <vector>

#include "geometry/errors.h"
#include "geometry/tspline/refinement.h"
#include "geometry/tspline/tmesh.h"
#include "tests/geometry/random_splines.h"

/// Random T-meshes from fixed seeds.
namespace isorim::geometry::testing {

/// Merges random boxes of cells, as far as they do not overlap, into faces; keeps a face only if `keep` likes the mesh.
template <class Keep>
TMesh random_merges(Random& random, const KnotVector& u, const KnotVector& v, int attempts, Keep&& keep) {
  const IndexBox domain = TMesh(u, v).index_mesh().domain();
  std::vector<IndexBox> boxes;
  TMesh mesh(u, v);
  for (int attempt = 0; attempt < attempts; ++attempt) {
    IndexBox box;
    for (std::size_t d = 0; d < 2; ++d) {
      box.first[d] = random.integer(domain.first[d], domain.last[d] - 1);
      box.last[d] = random.integer(box.first[d] + 1, std::min(box.first[d] + 3, domain.last[d]));
    }
    boxes.push_back(box);
    try {
      const TMesh merged(u, v,
                         IndexMesh({u.degree(), v.degree()},
                                   {static_cast<int>(u.knots().size()), static_cast<int>(v.knots().size())}, boxes));
      if (keep(merged)) {
        mesh = merged;
        continue;
      }
    } catch (const GeometryError&) {
      // Overlaps or has T-junctions to be joined.
    }
    boxes.pop_back();
  }
  return mesh;
}

/// Any mesh, analysis-suitable or not.
inline TMesh random_tmesh(Random& random, const KnotVector& u, const KnotVector& v) {
  return random_merges(random, u, v, 12, [](const TMesh&) { return true; });
}

/// Analysis-suitable by rejection, so independent of refinement.
inline TMesh random_suitable_tmesh(Random& random, const KnotVector& u, const KnotVector& v) {
  return random_merges(random, u, v, 25, [](const TMesh& mesh) { return is_analysis_suitable(mesh); });
}

inline std::vector<FaceCut> random_cuts(Random& random, const TMesh& mesh, int count) {
  std::vector<FaceCut> cuts;
  const int faces = static_cast<int>(mesh.index_mesh().faces().size());
  for (int k = 0; k < count; ++k) {
    FaceCut cut{random.integer(0, faces - 1), static_cast<Direction>(random.integer(0, 1)), 0.0};
    const Interval range = mesh.face_domain(cut.face)[index(cut.direction)];
    if (range.length() == 0.0) continue;
    cut.knot = random.integer(0, 1) == 0 ? range.middle() : range.first + range.length() * random.real(0.2, 0.8);
    cuts.push_back(cut);
  }
  return cuts;
}

inline TSpline random_tspline(Random& random, const TMesh& mesh) {
  return {mesh, random_net<3>(random, mesh.function_count())};
}

inline Point2 random_parameters(Random& random, const TMesh& mesh) {
  return {random.inside(mesh.domain()[0]), random.inside(mesh.domain()[1])};
}

}  // namespace isorim::geometry::testing
