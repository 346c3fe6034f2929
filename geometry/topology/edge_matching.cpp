#include "geometry/topology/edge_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/topology/duplicate_faces.h"
#include "geometry/topology/edge_curve.h"
#include "geometry/topology/edge_fan.h"
#include "geometry/topology/point_clusters.h"
#include "geometry/topology/point_tree.h"
#include "geometry/topology/shape_loops.h"
#include "geometry/topology/signed_components.h"

namespace isorim::geometry {
namespace {

std::string at(const Point3& point) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", point.x(), point.y(), point.z());
}

std::size_t slot(int index) {
  return static_cast<std::size_t>(index);
}

/// An edge with its curve, whose surface belongs to the loops of its patch.
struct Edge {
  SurfaceEdge data;
  EdgeCurve curve;
  double loop_length = 0.0;

  /// What limits how far vertices at it may move.
  double scale() const { return std::max(data.length, 0.02 * loop_length); }
};

struct Piece {
  EdgePiece data;
  /// The whole edge.
  bool whole = true;
  enum class State { open, joined, gone } state = State::open;
  /// The piece that it is joined to.
  int partner = -1;
};

/// Vertices that become one in the course of the matching.
class Vertices {
 public:
  int add(const Point3& point) {
    points_.push_back(point);
    parents_.push_back(static_cast<int>(parents_.size()));
    scales_.push_back(std::numeric_limits<double>::infinity());
    pieces_.emplace_back();
    return parents_.back();
  }
  int root(int vertex) const {
    while (parents_[slot(vertex)] != vertex) vertex = parents_[slot(vertex)];
    return vertex;
  }
  /// Of a root: its place, the shortest scale of its edges, the pieces that end there.
  const Point3& point(int root) const { return points_[slot(root)]; }
  double& scale(int root) { return scales_[slot(root)]; }
  std::vector<int>& pieces(int root) { return pieces_[slot(root)]; }

  void unite(int a, int b) {
    if (b < a) std::swap(a, b);
    parents_[slot(b)] = a;
    scale(a) = std::min(scale(a), scale(b));
    pieces(a).insert(pieces(a).end(), pieces(b).begin(), pieces(b).end());
    pieces(b).clear();
  }

 private:
  std::vector<Point3> points_;
  std::vector<int> parents_;
  std::vector<double> scales_;
  std::vector<std::vector<int>> pieces_;
};

void append_edges(const ShapeLoops& loops, int patch, double tolerance, std::vector<Edge>& edges) {
  for (int k = 0; k < static_cast<int>(loops.size()); ++k) {
    const std::size_t first = edges.size();
    double loop_length = 0.0;
    for (int c = 0; c < static_cast<int>(loops.loop(k).curves.size()); ++c) {
      EdgeCurve curve(loops.surface(k), loops.curve(k, c));
      if (curve.diagonal() <= tolerance) continue;
      const double length = curve.length();
      loop_length += length;
      edges.push_back({{patch, k, c, length}, std::move(curve), 0.0});
    }
    for (std::size_t e = first; e < edges.size(); ++e) edges[e].loop_length = loop_length;
  }
}

/// The matching in levels of a growing distance.
class Matcher {
 public:
  Matcher(const Boundary<3>& boundary, const MatchingOptions& options)
      : boundary_(boundary),
        options_(options),
        loops_(shape_loops(boundary)),
        finest_(finest_tolerance(loops_, options.tolerance)) {
    for (std::size_t i = 0; i < loops_.size(); ++i) append_edges(loops_[i], static_cast<int>(i), finest_, edges_);
  }

  EdgeMatching run() {
    if (edges_.empty()) return {};
    find_vertices();
    join_shared_edges();
    double tolerance = finest_;
    run_level(tolerance);
    while (tolerance < options_.tolerance && !open_pieces().empty()) {
      tolerance = std::min(10.0 * tolerance, options_.tolerance);
      run_level(tolerance);
    }
    resolve_fans();
    tolerance = options_.tolerance;
    while (tolerance < options_.largest_gap && !open_pieces().empty()) {
      tolerance = std::min(2.0 * tolerance, options_.largest_gap);
      run_level(tolerance);
    }
    return result();
  }

 private:
  static double finest_tolerance(const std::vector<ShapeLoops>& patches, double tolerance) {
    double farthest = 0.0;
    for (const ShapeLoops& loops : patches)
      for (const NurbsSurface<3>* surface : loops.surfaces())
        farthest = std::max(farthest, surface->control_points().cwiseAbs().maxCoeff());
    const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * farthest;
    return std::min(tolerance, std::max(1e-3 * tolerance, rounding));
  }

  // --- Pieces and vertices ----------------------------------------------------------------------------------------

  const Edge& edge_of(const Piece& piece) const { return edges_[slot(piece.data.edge)]; }
  int patch_of(int piece) const { return edge_of(pieces_[slot(piece)]).data.patch; }
  /// Its patch, or its element if the patch is an extracted surface.
  Patch<3> face_of(int piece) const {
    const SurfaceEdge& edge = edge_of(pieces_[slot(piece)]).data;
    const Patch<3>& patch = boundary_.patches[slot(edge.patch)];
    const auto* extracted = std::get_if<ExtractedSurface>(&patch.shape);
    if (!extracted) return {fmt::format("'{}'", patch.name), patch.shape};
    return {fmt::format("'{}' (element {})", patch.name, edge.loop), bezier_surface(*extracted, edge.loop)};
  }
  int from(const Piece& piece) const { return vertices_.root(piece.data.from); }
  int to(const Piece& piece) const { return vertices_.root(piece.data.to); }

  std::vector<int> open_pieces() const {
    std::vector<int> open;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (pieces_[i].state == Piece::State::open) open.push_back(static_cast<int>(i));
    return open;
  }

  int add_piece(const Piece& piece) {
    const int index = static_cast<int>(pieces_.size());
    pieces_.push_back(piece);
    for (const int vertex : {piece.data.from, piece.data.to}) vertices_.pieces(vertices_.root(vertex)).push_back(index);
    return index;
  }

  void find_vertices() {
    PointClusters<3> clusters(finest_);
    const auto vertex_at = [&](const Point3& point) {
      const int known = clusters.size();
      const int cluster = clusters.add(point);
      return cluster < known ? cluster : vertices_.add(point);
    };
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Interval domain = edges_[i].curve.domain();
      const int first = vertex_at(edges_[i].curve.at(domain.first));
      const int last = vertex_at(edges_[i].curve.at(domain.last));
      for (const int vertex : {first, last})
        vertices_.scale(vertex) = std::min(vertices_.scale(vertex), edges_[i].scale());
      add_piece({{static_cast<int>(i), domain, first, last, edges_[i].data.length}});
    }
  }

  /// The roots at which the pieces end.
  std::vector<int> end_vertices(const std::vector<int>& pieces) const {
    std::vector<int> roots;
    for (const int piece : pieces) {
      roots.push_back(from(pieces_[slot(piece)]));
      roots.push_back(to(pieces_[slot(piece)]));
    }
    std::ranges::sort(roots);
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    return roots;
  }

  PointTree tree_of(const std::vector<int>& roots) const {
    std::vector<Point3> points;
    for (const int root : roots) points.push_back(vertices_.point(root));
    return PointTree(std::move(points));
  }

  /// How far a level may move things whose smallest extent is `scale`.
  double bounded(double tolerance, double scale) const { return std::max(finest_, std::min(tolerance, 0.25 * scale)); }

  // --- One level --------------------------------------------------------------------------------------------------

  void run_level(double tolerance) {
    tolerance_ = tolerance;
    if (tolerance > finest_) merge_vertices();
    split_pieces();
    drop_collapsed();
    for (const Group& group : coincident_groups()) {
      if (group.pieces.size() == 2) join(group.pieces[0], group.pieces[1], *group.found);
    }
  }

  void merge_vertices() {
    const std::vector<int> roots = end_vertices(open_pieces());
    const PointTree tree = tree_of(roots);
    std::vector<std::tuple<double, int, int>> pairs;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const double reach = bounded(tolerance_, vertices_.scale(roots[i]));
      const Vector3 margin = Vector3::Constant(reach);
      const Point3& point = tree[static_cast<int>(i)];
      tree.for_each_in_box(point - margin, point + margin, [&](int k) {
        if (static_cast<std::size_t>(k) <= i) return;
        const double distance = (tree[k] - point).norm();
        if (distance <= std::min(reach, bounded(tolerance_, vertices_.scale(roots[slot(k)]))))
          pairs.emplace_back(distance, roots[i], roots[slot(k)]);
      });
    }
    std::ranges::sort(pairs);
    for (const auto& [distance, a, b] : pairs) {
      const int first = vertices_.root(a);
      const int second = vertices_.root(b);
      if (first == second || (vertices_.point(first) - vertices_.point(second)).norm() > tolerance_) continue;
      if (!would_collapse(first, second, distance)) vertices_.unite(first, second);
    }
  }

  /// Whether a piece between the two vertices is a feature that must not vanish: an edge of which at least one side is
  /// whole, joined or longer than a bridge. Slivers of longer edges on both sides are none.
  bool would_collapse(int first, int second, double distance) {
    if (vertices_.pieces(second).size() < vertices_.pieces(first).size()) std::swap(first, second);
    return std::ranges::any_of(vertices_.pieces(first), [&](int index) {
      const Piece& piece = pieces_[slot(index)];
      const bool between =
          (from(piece) == first && to(piece) == second) || (from(piece) == second && to(piece) == first);
      if (!between || piece.state == Piece::State::gone || piece.data.length > 8.0 * distance) return false;
      return is_whole(piece) && (piece.state == Piece::State::joined || piece.data.length > tolerance_);
    });
  }

  bool is_whole(const Piece& piece) const {
    return piece.whole || (piece.partner >= 0 && pieces_[slot(piece.partner)].whole);
  }

  void split_pieces() {
    const std::vector<int> open = open_pieces();
    const std::vector<int> roots = end_vertices(open);
    const PointTree tree = tree_of(roots);
    std::vector<int> near;
    for (const int index : open) {
      const Piece& piece = pieces_[slot(index)];
      const Edge& edge = edge_of(piece);
      const double reach = bounded(tolerance_, edge.data.length);
      near.clear();
      for (const EdgeCurve::Box& box : edge.curve.boxes(piece.data.domain)) {
        const Vector3 margin = Vector3::Constant(reach);
        tree.for_each_in_box(box.lower - margin, box.upper + margin, [&](int k) { near.push_back(roots[slot(k)]); });
      }
      std::ranges::sort(near);
      near.erase(std::unique(near.begin(), near.end()), near.end());
      split(index, near, reach);
    }
  }

  /// Cuts a piece where it passes the vertices, except beside its own ends (whose turn it is to become one with them).
  void split(int index, const std::vector<int>& near, double reach) {
    const EdgePiece whole = pieces_[slot(index)].data;
    const EdgeCurve& curve = edge_of(pieces_[slot(index)]).curve;
    const std::array<Point3, 2> ends{curve.at(whole.domain.first), curve.at(whole.domain.last)};
    std::vector<std::pair<double, int>> stops;
    for (const int vertex : near) {
      const double limit = std::min(reach, bounded(tolerance_, vertices_.scale(vertex)));
      // Most vertices near an edge are its own ends.
      if ((vertex == from(pieces_[slot(index)]) || vertex == to(pieces_[slot(index)])) && passes_once(curve, whole))
        continue;
      for (const EdgeCurve::Foot& foot : curve.feet(vertices_.point(vertex), whole.domain, limit)) {
        const Point3 place = curve.at(foot.t);
        if ((place - ends[0]).norm() > limit && (place - ends[1]).norm() > limit) stops.emplace_back(foot.t, vertex);
      }
    }
    if (stops.empty()) return;
    std::ranges::sort(stops);
    cut_at(index, stops);
  }

  /// A straight edge cannot come back to its ends.
  static bool passes_once(const EdgeCurve& curve, const EdgePiece& piece) { return curve.leg_count(piece.domain) == 1; }

  void cut_at(int index, const std::vector<std::pair<double, int>>& stops) {
    const EdgePiece whole = pieces_[slot(index)].data;
    const EdgeCurve& curve = edge_of(pieces_[slot(index)]).curve;
    pieces_[slot(index)].state = Piece::State::gone;
    EdgePiece rest = whole;
    Point3 previous = curve.at(whole.domain.first);
    for (const auto& [t, vertex] : stops) {
      const Point3 place = curve.at(t);
      // Vertices on two sides of the edge: the next level's.
      if ((place - previous).norm() <= 0.5 * finest_) continue;
      EdgePiece part = rest;
      part.domain.last = t;
      part.to = vertex;
      part.length = curve.length(part.domain);
      add_piece({part, false});
      rest.domain.first = t;
      rest.from = vertex;
      previous = place;
    }
    rest.length = curve.length(rest.domain);
    add_piece({rest, false});
  }

  /// Bridges of gaps and slivers beside T-junctions, once their ends are one vertex.
  void drop_collapsed() {
    for (Piece& piece : pieces_) {
      if (piece.state == Piece::State::gone || from(piece) != to(piece)) continue;
      if (piece.state == Piece::State::joined && is_whole(piece)) continue;
      const bool fills_loop = piece.data.length > 0.5 * edge_of(piece).loop_length;
      if (piece.data.length > 4.0 * tolerance_ || fills_loop) continue;
      piece.state = Piece::State::gone;
      record_gap(piece.data.length, edge_of(piece).curve.at(piece.data.domain.middle()));
    }
  }

  void record_gap(double gap, const Point3& place) {
    if (gap <= largest_gap_) return;
    largest_gap_ = gap;
    largest_gap_place_ = place;
  }

  // --- Coincidence ------------------------------------------------------------------------------------------------

  struct Coincidence {
    bool same_direction = false;
    double gap = 0.0;
    Point3 place = Point3::Zero();
  };

  /// The largest distance of `steps` + 1 points of `a` from `b`; false if one is farther than the tolerance (twice that
  /// at the ends, which may lie on both sides of their vertex).
  bool runs_along(const Piece& a, const Piece& b, int steps, double tolerance, Coincidence& found) const {
    const EdgeCurve& curve = edge_of(a).curve;
    const EdgeCurve& other = edge_of(b).curve;
    const Interval domain = a.data.domain;
    for (int i = 0; i <= steps; ++i) {
      const double t = i == steps ? domain.last : domain.first + domain.length() * i / steps;
      const Point3 point = curve.at(t);
      const double limit = i == 0 || i == steps ? 2.0 * tolerance : tolerance;
      const std::optional<EdgeCurve::Foot> foot = other.nearest(point, b.data.domain, limit);
      if (!foot) return false;
      if (foot->distance < found.gap) continue;
      found.gap = foot->distance;
      found.place = point;
    }
    return true;
  }

  /// Whether two pieces run along each other, whatever their ends.
  std::optional<Coincidence> coincide(const Piece& a, const Piece& b, double tolerance) const {
    int same_way = 0;
    for (const double fraction : {0.25, 0.5, 0.75}) {
      const double t = a.data.domain.first + fraction * a.data.domain.length();
      const std::optional<EdgeCurve::Foot> foot =
          edge_of(b).curve.nearest(edge_of(a).curve.at(t), b.data.domain, tolerance);
      if (!foot) return std::nullopt;
      const double cosine = edge_of(a).curve.jet(t).tangent.dot(edge_of(b).curve.jet(foot->t).tangent);
      same_way += cosine > 0.0 ? 1 : -1;
    }
    Coincidence found;
    found.same_direction = same_way > 0;
    const int steps = steps_along(a, b);
    if (!runs_along(a, b, steps, tolerance, found) || !runs_along(b, a, (steps + 1) / 2, tolerance, found))
      return std::nullopt;
    return found;
  }

  /// Two straight lines are farthest apart at their ends.
  int steps_along(const Piece& a, const Piece& b) const {
    const int first = edge_of(a).curve.leg_count(a.data.domain);
    const int second = edge_of(b).curve.leg_count(b.data.domain);
    const bool straight = edge_of(a).curve.has_straight_legs() && edge_of(b).curve.has_straight_legs();
    if (first == 1 && second == 1 && straight) return 1;
    return std::clamp(std::max(first, second), 4, 24);
  }

  double reach_of(const Piece& a, const Piece& b) const {
    return std::max(finest_, std::min(tolerance_, 0.25 * std::min(a.data.length, b.data.length)));
  }

  /// Pieces that coincide; if they are two, how.
  struct Group {
    std::vector<int> pieces;
    std::optional<Coincidence> found;
  };

  /// Open pieces that coincide at this level, in groups of two and more.
  std::vector<Group> coincident_groups() const {
    // Between which vertices, of which solid.
    using Key = std::tuple<int, int, int>;
    std::vector<std::pair<Key, int>> by_ends;
    for (const int index : open_pieces()) {
      const auto [low, high] = std::minmax({from(pieces_[slot(index)]), to(pieces_[slot(index)])});
      by_ends.emplace_back(Key(low, high, solid_of(patch_of(index))), index);
    }
    std::ranges::sort(by_ends);
    std::vector<Group> groups;
    std::vector<int> candidates;
    for (std::size_t i = 0; i < by_ends.size(); ++i) {
      candidates.push_back(by_ends[i].second);
      if (i + 1 < by_ends.size() && by_ends[i + 1].first == by_ends[i].first) continue;
      append_groups(candidates, groups);
      candidates.clear();
    }
    return groups;
  }

  int solid_of(int patch) const { return slot(patch) < options_.solids.size() ? options_.solids[slot(patch)] : -1; }

  /// Splits pieces between the same vertices into those that run along each other.
  void append_groups(std::vector<int> candidates, std::vector<Group>& groups) const {
    while (candidates.size() > 1) {
      Group group{{candidates.front()}, std::nullopt};
      candidates.erase(candidates.begin());
      for (std::size_t next = 0; next < group.pieces.size(); ++next) {
        const Piece& own = pieces_[slot(group.pieces[next])];
        const auto apart = [&](int other) {
          const Piece& piece = pieces_[slot(other)];
          const std::optional<Coincidence> found = coincide(own, piece, reach_of(own, piece));
          if (found) group.found = found;
          return !found;
        };
        const auto joined = std::stable_partition(candidates.begin(), candidates.end(), apart);
        group.pieces.insert(group.pieces.end(), joined, candidates.end());
        candidates.erase(joined, candidates.end());
      }
      if (group.pieces.size() > 1) groups.push_back(std::move(group));
    }
  }

  void join(int a, int b) {
    Piece& first = pieces_[slot(a)];
    Piece& second = pieces_[slot(b)];
    const std::optional<Coincidence> found = coincide(first, second, reach_of(first, second));
    if (!found) return;  // both run along a third
    join(a, b, *found);
  }

  void join(int a, int b, const Coincidence& found) {
    pieces_[slot(a)].state = pieces_[slot(b)].state = Piece::State::joined;
    pieces_[slot(a)].partner = b;
    pieces_[slot(b)].partner = a;
    joints_.push_back({a, b, found.same_direction, found.gap});
    record_gap(found.gap, found.place);
    largest_tolerance_ = std::max(largest_tolerance_, tolerance_);
  }

  // --- What the file says -----------------------------------------------------------------------------------------

  int shared_edge(const SurfaceEdge& edge) const {
    const SharedEdges& shared = options_.shared_edges;
    if (slot(edge.patch) >= shared.size()) return -1;
    const auto& loops = shared[slot(edge.patch)];
    if (slot(edge.loop) >= loops.size() || slot(edge.curve) >= loops[slot(edge.loop)].size()) return -1;
    return loops[slot(edge.loop)][slot(edge.curve)];
  }

  void join_shared_edges() {
    std::map<int, std::vector<int>> uses;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const int shared = shared_edge(edges_[i].data);
      if (shared >= 0) uses[shared].push_back(static_cast<int>(i));
    }
    for (const auto& [shared, pieces] : uses) {
      if (pieces.size() == 2) join_shared(pieces[0], pieces[1]);
    }
  }

  /// Pieces are whole edges still.
  void join_shared(int a, int b) {
    const Piece& first = pieces_[slot(a)];
    const Piece& second = pieces_[slot(b)];
    const double tolerance = 0.1 * std::min(first.data.length, second.data.length);
    const std::optional<Coincidence> found = coincide(first, second, tolerance);
    if (!found) return;
    const bool same = found->same_direction;
    const std::array<std::pair<int, int>, 2> ends{std::pair{first.data.from, same ? second.data.from : second.data.to},
                                                  std::pair{first.data.to, same ? second.data.to : second.data.from}};
    for (const auto& [x, y] : ends) {
      if ((vertices_.point(vertices_.root(x)) - vertices_.point(vertices_.root(y))).norm() > 2.0 * tolerance) return;
    }
    for (const auto& [x, y] : ends) {
      if (vertices_.root(x) != vertices_.root(y)) vertices_.unite(vertices_.root(x), vertices_.root(y));
    }
    join(a, b, *found);
  }

  // --- Edges of more than two patches -----------------------------------------------------------------------------

  void resolve_fans() {
    std::vector<std::vector<int>> fans;
    for (Group& group : coincident_groups()) {
      if (group.pieces.size() > 2 && !is_sliver(group.pieces)) fans.push_back(std::move(group.pieces));
    }
    while (!fans.empty()) {
      const SignedComponents components = patch_components();
      const std::size_t resolved = std::erase_if(
          fans, [&](const std::vector<int>& fan) { return join_pairs(fan, pair_fan(leaves_of(fan, components))); });
      if (resolved > 0) continue;
      // One choice at a time: the others follow from it.
      const auto touching = std::ranges::find_if(fans, [&](const std::vector<int>& fan) {
        return join_pairs(fan, pair_touching_faces(leaves_of(fan, components)));
      });
      if (touching == fans.end()) refuse(fans.front());
      fans.erase(touching);
    }
  }

  /// Ends of longer edges that gaps keep apart from their vertices, no edge of its own: coarser levels drop them.
  bool is_sliver(const std::vector<int>& fan) const {
    return std::ranges::any_of(fan, [&](int index) {
      const Piece& piece = pieces_[slot(index)];
      return !piece.whole && piece.data.length <= 16.0 * tolerance_;
    });
  }

  /// Patches joined so far.
  SignedComponents patch_components() const {
    SignedComponents components(static_cast<int>(boundary_.patches.size()));
    for (const EdgeJoint& joint : joints_)
      components.unite(patch_of(joint.first), patch_of(joint.second), joint.same_direction ? -1 : 1);
    return components;
  }

  bool join_pairs(const std::vector<int>& fan, const std::optional<std::vector<std::pair<int, int>>>& pairs) {
    if (!pairs) return false;
    for (const auto& [a, b] : *pairs) join(fan[slot(a)], fan[slot(b)]);
    return true;
  }

  std::vector<FanLeaf> leaves_of(const std::vector<int>& fan, const SignedComponents& components) const {
    const Piece& first = pieces_[slot(fan.front())];
    // Off the middle, where a symmetric surface may have a pole.
    const Point3 place = edge_of(first).curve.at(first.data.domain.first + 0.4142 * first.data.domain.length());
    std::vector<FanLeaf> leaves;
    for (const int index : fan) {
      const Piece& piece = pieces_[slot(index)];
      const EdgeCurve& curve = edge_of(piece).curve;
      const auto foot = curve.nearest(place, piece.data.domain, std::numeric_limits<double>::infinity());
      const LiftedJet jet = curve.jet(foot->t);
      const SignedComponents::Member member = components.find(patch_of(index));
      leaves.push_back(
          {member.component, member.sign, jet.tangent.normalized(), jet.normal.cross(jet.tangent).normalized()});
    }
    return leaves;
  }

  [[noreturn]] void refuse(const std::vector<int>& fan) const {
    std::vector<Patch<3>> faces;
    for (const int piece : fan) faces.push_back(face_of(piece));
    for (std::size_t i = 0; i < fan.size(); ++i) {
      for (std::size_t k = i + 1; k < fan.size(); ++k) {
        if (faces[i].name != faces[k].name && is_same_face(faces[i], faces[k], options_.tolerance))
          throw GeometryError(
              fmt::format("patches {} and {} are the same face, given twice", faces[i].name, faces[k].name));
      }
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < fan.size(); ++i)
      names.push_back(fmt::format("{}{}", i == 0 ? "" : i + 1 == fan.size() ? " and " : ", ", faces[i].name));
    std::string list;
    for (const std::string& name : names) list += name;
    const Piece& piece = pieces_[slot(fan.front())];
    throw GeometryError(fmt::format(
        "patches {} share the edge from {} to {}: an edge joins two patches at most, unless solids touch there", list,
        at(vertices_.point(from(piece))), at(vertices_.point(to(piece)))));
  }

  // --- The result -------------------------------------------------------------------------------------------------

  EdgeMatching result() {
    EdgeMatching matching;
    std::map<int, int> vertex_numbers;
    const auto vertex_number = [&](int root) {
      const auto [entry, is_new] = vertex_numbers.try_emplace(root, static_cast<int>(matching.vertices.size()));
      if (is_new) matching.vertices.push_back(vertices_.point(root));
      return entry->second;
    };
    for (const Edge& edge : edges_) matching.edges.push_back(edge.data);
    std::vector<int> numbers(pieces_.size(), -1);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].state == Piece::State::gone) continue;
      numbers[i] = static_cast<int>(matching.pieces.size());
      if (pieces_[i].state == Piece::State::open) matching.free_pieces.push_back(numbers[i]);
      EdgePiece piece = pieces_[i].data;
      piece.from = vertex_number(from(pieces_[i]));
      piece.to = vertex_number(to(pieces_[i]));
      matching.pieces.push_back(piece);
    }
    for (const EdgeJoint& joint : joints_) {
      const std::array<int, 2> sides{numbers[slot(joint.first)], numbers[slot(joint.second)]};
      if (sides[0] >= 0 && sides[1] >= 0)
        matching.joints.push_back({sides[0], sides[1], joint.same_direction, joint.gap});
    }
    matching.largest_gap = largest_gap_;
    matching.largest_gap_place = largest_gap_place_;
    matching.largest_tolerance = largest_tolerance_;
    return matching;
  }

  const Boundary<3>& boundary_;
  const MatchingOptions& options_;
  std::vector<ShapeLoops> loops_;
  double finest_;
  /// Of the present level.
  double tolerance_ = 0.0;
  std::vector<Edge> edges_;
  Vertices vertices_;
  std::vector<Piece> pieces_;
  std::vector<EdgeJoint> joints_;
  double largest_gap_ = 0.0;
  Point3 largest_gap_place_ = Point3::Zero();
  double largest_tolerance_ = 0.0;
};

}  // namespace

EdgeMatching match_edges(const Boundary<3>& boundary, const MatchingOptions& options) {
  return Matcher(boundary, options).run();
}

}  // namespace isorim::geometry
