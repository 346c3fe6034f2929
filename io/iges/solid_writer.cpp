#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "io/iges/model_writer.h"

namespace isorim::io::iges {

using geometry::BoundaryEdge;
using geometry::EdgeUse;
using geometry::Interval;
using geometry::NurbsCurve;
using geometry::Topology;
using geometry::TrimLoop;

namespace {

constexpr int dependent = 1;
/// The form that all parts of solids have.
constexpr int solid_form = 1;

/// A stretch of a loop: along an edge, or a degenerate one at a vertex.
struct Stretch {
  /// In the parameter of its pcurve.
  Interval domain;
  int curve = 0;
  /// Index of the edge; -1 if it is degenerate.
  int edge = -1;
  bool forward = true;
};

/// The stretches of each loop of each patch, in the order in which the loops run.
class LoopStretches {
 public:
  explicit LoopStretches(const std::vector<BoundaryEdge>& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (const EdgeUse* use : {&edges[i].first, &edges[i].second}) {
        by_loop_[{use->patch, use->loop}].push_back({use->domain, use->curve, static_cast<int>(i), use->forward});
      }
    }
  }

  std::vector<Stretch> of(int patch, int loop, const TrimLoop& curves) const {
    std::vector<Stretch> stretches;
    if (const auto found = by_loop_.find({patch, loop}); found != by_loop_.end()) stretches = found->second;
    std::vector<bool> has_edge(curves.curves.size(), false);
    for (const Stretch& stretch : stretches) has_edge[static_cast<std::size_t>(stretch.curve)] = true;
    for (std::size_t i = 0; i < has_edge.size(); ++i) {
      if (!has_edge[i]) stretches.push_back({curves.curves[i].domain(), static_cast<int>(i), -1, true});
    }
    std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
      return std::pair(a.curve, a.domain.first) < std::pair(b.curve, b.domain.first);
    });
    return stretches;
  }

 private:
  std::map<std::pair<int, int>, std::vector<Stretch>> by_loop_;
};

bool comes_before(const EdgeUse& a, const EdgeUse& b) {
  return std::tie(a.patch, a.loop, a.curve, a.domain.first) < std::tie(b.patch, b.loop, b.curve, b.domain.first);
}

/// In an order and with directions that depend on the patches alone: the first use runs forward.
std::vector<BoundaryEdge> in_order(std::vector<BoundaryEdge> edges) {
  for (BoundaryEdge& edge : edges) {
    if (comes_before(edge.second, edge.first)) std::swap(edge.first, edge.second);
    if (edge.first.forward) continue;
    std::swap(edge.from, edge.to);
    edge.first.forward = true;
    edge.second.forward = !edge.second.forward;
  }
  std::sort(edges.begin(), edges.end(),
            [](const BoundaryEdge& a, const BoundaryEdge& b) { return comes_before(a.first, b.first); });
  return edges;
}

class SolidWriter {
 public:
  SolidWriter(ModelWriter& writer, const Topology<3>& topology)
      : writer_(writer), topology_(topology), all_edges_(in_order(topology.edges)), stretches_(all_edges_) {}

  int write(int outer, const std::vector<int>& voids) {
    std::vector<int> patches = topology_.shells[static_cast<std::size_t>(outer)].patches;
    for (const int shell : voids) {
      const auto& more = topology_.shells[static_cast<std::size_t>(shell)].patches;
      patches.insert(patches.end(), more.begin(), more.end());
    }
    number_edges(patches);
    vertex_list_ = add_vertex_list();
    edge_list_ = add_edge_list();
    Record record = EntityList::parameters(186);
    record.integer(add_shell(outer)).integer(1).integer(static_cast<long>(voids.size()));
    for (const int shell : voids) record.integer(add_shell(shell)).integer(1);
    writer_.entities().add(186, record);
    return faces_;
  }

 private:
  const BoundaryEdge& edge(int index) const { return all_edges_[static_cast<std::size_t>(index)]; }

  /// The edges and vertices of the solid, counted from 1.
  void number_edges(const std::vector<int>& patches) {
    const std::unordered_set<int> in_solid(patches.begin(), patches.end());
    for (std::size_t i = 0; i < all_edges_.size(); ++i) {
      const BoundaryEdge& e = all_edges_[i];
      if (!in_solid.contains(e.first.patch)) continue;
      edges_.push_back(static_cast<int>(i));
      edge_number_[static_cast<int>(i)] = static_cast<int>(edges_.size());
      for (const int vertex : {e.from, e.to}) {
        if (vertex_number_.try_emplace(vertex, static_cast<int>(vertices_.size()) + 1).second) {
          vertices_.push_back(vertex);
        }
      }
    }
  }

  int add_vertex_list() {
    Record record = EntityList::parameters(502);
    record.integer(static_cast<long>(vertices_.size()));
    for (const int vertex : vertices_) {
      for (const double x : topology_.vertices[static_cast<std::size_t>(vertex)]) record.real(x);
    }
    return writer_.entities().add(502, record, {.form = solid_form, .subordinate = dependent});
  }

  static NurbsCurve<2> piece_of(const TrimLoop& loop, const Stretch& stretch) {
    const NurbsCurve<2>& curve = loop.curves[static_cast<std::size_t>(stretch.curve)];
    const Interval domain = curve.domain();
    const bool whole = stretch.domain.first == domain.first && stretch.domain.last == domain.last;
    return whole ? curve : restrict_to(curve, stretch.domain);
  }

  /// In space, from the edge's first vertex to its last.
  NurbsCurve<3> curve_of(const BoundaryEdge& e) const {
    const EdgeUse& use = e.first;
    const TrimLoop& loop = writer_.loops(use.patch)[static_cast<std::size_t>(use.loop)];
    return writer_.lifted(use.patch, piece_of(loop, {use.domain, use.curve, 0, true}));
  }

  int add_edge_list() {
    Record record = EntityList::parameters(504);
    record.integer(static_cast<long>(edges_.size()));
    for (const int index : edges_) {
      const BoundaryEdge& e = edge(index);
      record.integer(writer_.add_curve(curve_of(e)));
      for (const int vertex : {e.from, e.to}) record.integer(vertex_list_).integer(vertex_number_.at(vertex));
    }
    return writer_.entities().add(504, record, {.form = solid_form, .subordinate = dependent});
  }

  /// The vertex at which a degenerate stretch stands: where the one before it, or the one after it, ends.
  int vertex_at(const std::vector<Stretch>& stretches, std::size_t i) const {
    for (std::size_t k = 1; k <= stretches.size(); ++k) {
      const Stretch& before = stretches[(i + stretches.size() - k) % stretches.size()];
      if (before.edge >= 0) return vertex_number_.at(before.forward ? edge(before.edge).to : edge(before.edge).from);
    }
    return 1;
  }

  int add_loop(int patch, int index, const TrimLoop& loop) {
    const std::vector<Stretch> stretches = stretches_.of(patch, index, loop);
    Record record = EntityList::parameters(508);
    record.integer(static_cast<long>(stretches.size()));
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      const Stretch& stretch = stretches[i];
      if (stretch.edge >= 0) {
        record.integer(0).integer(edge_list_).integer(edge_number_.at(stretch.edge)).integer(stretch.forward ? 1 : 0);
      } else {
        record.integer(1).integer(vertex_list_).integer(vertex_at(stretches, i)).integer(1);
      }
      // One parameter curve, of which nothing is said.
      record.integer(1).integer(0).integer(writer_.add_pcurve(piece_of(loop, stretch)));
    }
    return writer_.entities().add(508, record, {.form = solid_form, .subordinate = dependent});
  }

  /// The faces of a patch; there are several if its kept part falls into pieces.
  std::vector<int> add_faces(int patch) {
    const std::vector<TrimLoop>& loops = writer_.loops(patch);
    const int surface = writer_.add_surface(patch, false);
    std::vector<int> faces;
    for (const FaceLoops& piece : connected_faces(loops)) {
      Record record = EntityList::parameters(510);
      record.integer(surface).integer(static_cast<long>(piece.holes.size()) + 1).integer(1);
      record.integer(add_loop(patch, piece.outer, loops[static_cast<std::size_t>(piece.outer)]));
      for (const int hole : piece.holes) {
        record.integer(add_loop(patch, hole, loops[static_cast<std::size_t>(hole)]));
      }
      faces.push_back(writer_.add_named(510, record, {.form = solid_form, .subordinate = dependent}, patch));
    }
    faces_ += static_cast<int>(faces.size());
    return faces;
  }

  int add_shell(int shell) {
    std::vector<std::pair<int, int>> faces;
    for (const int patch : topology_.shells[static_cast<std::size_t>(shell)].patches) {
      const int outward = writer_.patch(patch).orientation > 0 ? 1 : 0;
      for (const int face : add_faces(patch)) faces.emplace_back(face, outward);
    }
    Record record = EntityList::parameters(514);
    record.integer(static_cast<long>(faces.size()));
    for (const auto& [face, outward] : faces) record.integer(face).integer(outward);
    return writer_.entities().add(514, record, {.form = solid_form, .subordinate = dependent});
  }

  ModelWriter& writer_;
  const Topology<3>& topology_;
  std::vector<BoundaryEdge> all_edges_;
  LoopStretches stretches_;
  /// Indices of the solid's edges and vertices, in the order of its lists.
  std::vector<int> edges_;
  std::vector<int> vertices_;
  std::unordered_map<int, int> edge_number_;
  std::unordered_map<int, int> vertex_number_;
  int vertex_list_ = 0;
  int edge_list_ = 0;
  int faces_ = 0;
};

}  // namespace

int add_solid(ModelWriter& writer, const Topology<3>& topology, int outer, const std::vector<int>& voids) {
  return SolidWriter(writer, topology).write(outer, voids);
}

}  // namespace isorim::io::iges
