// orient() in space: shells of patches joined along edges, consistent normals, voids.

#include <algorithm>
#include <optional>
#include <queue>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/topology/coincidence.h"
#include "geometry/topology/duplicate_faces.h"
#include "geometry/topology/edge_matching.h"
#include "geometry/topology/enclosed_volume.h"
#include "geometry/topology/free_edges.h"
#include "geometry/topology/orientation.h"
#include "geometry/topology/shape_loops.h"
#include "geometry/trimming/lifted_curve.h"

namespace isorim::geometry {
namespace {

std::string at(const Point3& point) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", point.x(), point.y(), point.z());
}

Point3 place_on(const Boundary<3>& boundary, const SurfaceEdge& edge, double t) {
  const ShapeLoops loops(boundary.patches[static_cast<std::size_t>(edge.patch)].shape);
  return lifted_point(loops.surface(edge.loop), loops.curve(edge.loop, edge.curve), t);
}

/// A neighbour across an edge; relation +1 if both natural normals agree there.
struct Neighbour {
  int patch = 0;
  int relation = 1;
  int joint = 0;
};

class ShellFinder {
 public:
  ShellFinder(const Boundary<3>& boundary, const EdgeMatching& matching) : boundary_(boundary), matching_(matching) {
    neighbours_.resize(boundary.patches.size());
    for (std::size_t i = 0; i < matching.joints.size(); ++i) add_joint(static_cast<int>(i));
    has_free_edge_.resize(boundary.patches.size(), false);
    for (const int piece : matching.free_pieces) has_free_edge_[static_cast<std::size_t>(edge_of(piece).patch)] = true;
  }

  /// Shells in the order of their first patches; `signs` are consistent within each.
  std::vector<Shell<3>> find(std::vector<int>& signs) const {
    signs.assign(boundary_.patches.size(), 0);
    std::vector<Shell<3>> shells;
    for (std::size_t i = 0; i < signs.size(); ++i) {
      if (signs[i] == 0) shells.push_back(spread_from(static_cast<int>(i), signs));
    }
    return shells;
  }

 private:
  const SurfaceEdge& edge_of(int piece) const {
    return matching_.edges[static_cast<std::size_t>(matching_.pieces[static_cast<std::size_t>(piece)].edge)];
  }
  const std::string& name(int patch) const { return boundary_.patches[static_cast<std::size_t>(patch)].name; }

  void add_joint(int index) {
    const EdgeJoint& joint = matching_.joints[static_cast<std::size_t>(index)];
    const SurfaceEdge& a = edge_of(joint.first);
    const SurfaceEdge& b = edge_of(joint.second);
    // The loops of consistent neighbours run through their common edge in opposite directions.
    const int relation = joint.same_direction ? -1 : 1;
    neighbours_[static_cast<std::size_t>(a.patch)].push_back({b.patch, relation, index});
    neighbours_[static_cast<std::size_t>(b.patch)].push_back({a.patch, relation, index});
  }

  Shell<3> spread_from(int first, std::vector<int>& signs) const {
    Shell<3> shell;
    shell.closed = true;
    std::queue<int> waiting;
    signs[static_cast<std::size_t>(first)] = 1;
    waiting.push(first);
    while (!waiting.empty()) {
      const int patch = waiting.front();
      waiting.pop();
      shell.patches.push_back(patch);
      shell.closed = shell.closed && !has_free_edge_[static_cast<std::size_t>(patch)];
      for (const Neighbour& next : neighbours_[static_cast<std::size_t>(patch)]) {
        int& sign = signs[static_cast<std::size_t>(next.patch)];
        const int wanted = signs[static_cast<std::size_t>(patch)] * next.relation;
        if (sign == 0) waiting.push(next.patch);
        if (sign == -wanted) refuse_one_sided(patch, next);
        sign = wanted;
      }
    }
    std::ranges::sort(shell.patches);
    return shell;
  }

  [[noreturn]] void refuse_one_sided(int patch, const Neighbour& next) const {
    const EdgeJoint& joint = matching_.joints[static_cast<std::size_t>(next.joint)];
    const int piece = joint.first;
    const Point3 place =
        place_on(boundary_, edge_of(piece), matching_.pieces[static_cast<std::size_t>(piece)].domain.middle());
    const bool elements =
        std::holds_alternative<ExtractedSurface>(boundary_.patches[static_cast<std::size_t>(patch)].shape);
    if (patch == next.patch && elements)
      throw GeometryError(fmt::format(
          "elements {} and {} of patch '{}' look to different sides: they run through their common edge at {} the same "
          "way; expected normals S_s x S_t that agree",
          edge_of(joint.first).loop, edge_of(joint.second).loop, name(patch), at(place)));
    throw GeometryError(
        patch == next.patch
            ? fmt::format("patch '{}' meets itself at {} with its normal reversed: the shell has one side only "
                          "(a Moebius strip)",
                          name(patch), at(place))
            : fmt::format("the shell cannot be oriented: going round it, the normals of patches '{}' and '{}' disagree "
                          "at their common edge at {} (a Moebius strip)",
                          name(patch), name(next.patch), at(place)));
  }

  const Boundary<3>& boundary_;
  const EdgeMatching& matching_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<bool> has_free_edge_;
};

/// A closed shell as Bézier pieces with consistent orientations.
struct ClosedShell {
  std::size_t index = 0;
  std::vector<SurfacePiece> pieces;
  Point3 lower;
  Point3 upper;
};

std::vector<ClosedShell> closed_shells(const ElementTable<3>& table, const std::vector<Shell<3>>& shells,
                                       const std::vector<int>& signs) {
  std::vector<int> slot_of_patch(signs.size(), -1);
  std::vector<ClosedShell> closed;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (!shells[i].closed) continue;
    for (const int patch : shells[i].patches) {
      slot_of_patch[static_cast<std::size_t>(patch)] = static_cast<int>(closed.size());
    }
    closed.push_back({i, {}, Point3::Zero(), Point3::Zero()});
  }
  for (const BezierElement<3>& element : table.elements) {
    const std::size_t patch = static_cast<std::size_t>(element.patch);
    if (slot_of_patch[patch] < 0) continue;
    // Orientations as given play no part.
    closed[static_cast<std::size_t>(slot_of_patch[patch])].pieces.push_back(
        surface_piece(table, element, signs[patch] * element.orientation));
  }
  for (ClosedShell& shell : closed) {
    shell.lower = shell.pieces.front().lower;
    shell.upper = shell.pieces.front().upper;
    for (const SurfacePiece& piece : shell.pieces) {
      shell.lower = shell.lower.cwiseMin(piece.lower);
      shell.upper = shell.upper.cwiseMax(piece.upper);
    }
  }
  return closed;
}

bool box_holds(const ClosedShell& outer, const ClosedShell& inner, double tolerance) {
  return (inner.lower.array() >= outer.lower.array() - tolerance).all() &&
         (inner.upper.array() <= outer.upper.array() + tolerance).all();
}

bool boxes_overlap(const ClosedShell& a, const ClosedShell& b, double tolerance) {
  return (a.lower.array() < b.upper.array() - tolerance).all() && (a.upper.array() > b.lower.array() + tolerance).all();
}

/// Whether `inner` lies inside `outer`: a few of its points, away from `outer`, decide. Shells may not cross, so they
/// have to agree.
bool is_inside(const ClosedShell& inner, const ClosedShell& outer, double tolerance) {
  if (!boxes_overlap(inner, outer, tolerance)) return false;
  const bool box_inside = box_holds(outer, inner, tolerance);
  // Whether the two cross shows when they are asked about the other way round.
  if (!box_inside && box_holds(inner, outer, tolerance)) return false;
  const std::size_t wanted = box_inside ? 4 : 8;
  constexpr std::size_t most = 64;
  const std::size_t count = inner.pieces.size();
  const std::size_t stride = count <= wanted ? 1 : count / wanted + 1;
  std::size_t inside = 0;
  std::size_t decided = 0;
  for (std::size_t i = 0; i < std::min(most, count) && decided < wanted; ++i) {
    const Point3 point = probe_point(inner.pieces[(i * stride) % count]);
    const std::optional<int> turns = winding_number(outer.pieces, point, tolerance);
    if (!turns) continue;
    ++decided;
    if (*turns != 0) ++inside;
    if (inside > 0 && inside < decided) throw GeometryError(fmt::format("two shells cross near {}", at(point)));
  }
  if (decided == 0)
    throw GeometryError(fmt::format("two shells coincide near {}", at(probe_point(inner.pieces.front()))));
  return inside > 0;
}

[[noreturn]] void refuse_empty(const Boundary<3>& boundary, const Shell<3>& shell, double tolerance,
                               const Point3& place) {
  const auto patch = [&](std::size_t i) -> const Patch<3>& {
    return boundary.patches[static_cast<std::size_t>(shell.patches[i])];
  };
  const std::size_t count = shell.patches.size();
  if (count == 2 && is_same_face(patch(0), patch(1), tolerance)) {
    throw GeometryError(
        fmt::format("patches '{}' and '{}' are the same face, given twice", patch(0).name, patch(1).name));
  }
  throw GeometryError(fmt::format("the closed shell of patch '{}'{} encloses no volume (at {})", patch(0).name,
                                  count > 1 ? fmt::format(" and {} more", count - 1) : "", at(place)));
}

/// Turns the signs of every closed shell so that its normals point out of the material; odd depth is a void.
void turn_outward(const Boundary<3>& boundary, const ElementTable<3>& table, Topology<3>& topology,
                  std::vector<int>& signs) {
  const std::vector<ClosedShell> closed = closed_shells(table, topology.shells, signs);
  for (const ClosedShell& shell : closed) {
    Shell<3>& own = topology.shells[shell.index];
    const std::optional<int> sign = volume_sign(shell.pieces);
    if (!sign) refuse_empty(boundary, own, topology.tolerance, probe_point(shell.pieces.front()));
    const auto contains = [&](const ClosedShell& other) {
      return &other != &shell && is_inside(shell, other, topology.tolerance);
    };
    own.is_void = std::ranges::count_if(closed, contains) % 2 != 0;
    const int turn = own.is_void ? -*sign : *sign;
    for (const int patch : own.patches) signs[static_cast<std::size_t>(patch)] *= turn;
  }
}

EdgeUse use_of(const EdgeMatching& matching, int index, int from) {
  const EdgePiece& piece = matching.pieces[static_cast<std::size_t>(index)];
  const SurfaceEdge& edge = matching.edges[static_cast<std::size_t>(piece.edge)];
  return {edge.patch, edge.loop, edge.curve, piece.domain, piece.from == from};
}

std::vector<BoundaryEdge> shared_edges(const EdgeMatching& matching) {
  std::vector<BoundaryEdge> edges;
  for (const EdgeJoint& joint : matching.joints) {
    const EdgePiece& piece = matching.pieces[static_cast<std::size_t>(joint.first)];
    BoundaryEdge edge{piece.from, piece.to, use_of(matching, joint.first, piece.from),
                      use_of(matching, joint.second, piece.from), joint.gap};
    edge.second.forward = joint.same_direction;
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace

template <>
OrientedBoundary<3> orient<3>(const Boundary<3>& boundary, const OrientationOptions& options) {
  if (boundary.patches.empty()) throw GeometryError("the boundary has no patches");
  const ElementTable<3> table = bezier_elements(boundary);
  const BoundingBox<3> box = bounding_box(table);
  OrientedBoundary<3> result{boundary, {}};
  Topology<3>& topology = result.topology;
  topology.tolerance = coincidence_tolerance(box, options.tolerance);

  const MatchingOptions how{topology.tolerance, options.largest_relative_gap * box.diagonal(), options.shared_edges,
                            options.solids};
  EdgeMatching matching = match_edges(boundary, how);
  topology.largest_gap = matching.largest_gap;
  topology.largest_gap_place = matching.largest_gap_place;
  topology.largest_tolerance = std::max(topology.tolerance, matching.largest_tolerance);
  topology.edges = shared_edges(matching);
  topology.free_edges = free_edges(boundary, matching);
  std::vector<int> signs;
  topology.shells = ShellFinder(boundary, matching).find(signs);
  topology.vertices = std::move(matching.vertices);
  turn_outward(boundary, table, topology, signs);
  topology.closed = std::ranges::all_of(topology.shells, [](const Shell<3>& shell) { return shell.closed; });
  for (std::size_t i = 0; i < signs.size(); ++i) result.boundary.patches[i].orientation = signs[i];
  return result;
}

}  // namespace isorim::geometry
