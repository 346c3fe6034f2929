// orient() in the plane: chains of curves, loops that may not cross, nesting.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/intersection/loop_contacts.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/topology/coincidence.h"
#include "geometry/topology/orientation.h"
#include "geometry/topology/point_clusters.h"

namespace isorim::geometry {
namespace {

std::string at(const Point2& point) {
  return fmt::format("({:.9g}, {:.9g})", point.x(), point.y());
}

/// The Bézier pieces of every patch, in the direction of its parameter.
std::vector<std::vector<PlanePiece>> pieces_of_patches(const Boundary<2>& boundary, const ElementTable<2>& table) {
  std::vector<std::vector<PlanePiece>> pieces(boundary.patches.size());
  for (const BezierElement<2>& element : table.elements) {
    pieces[static_cast<std::size_t>(element.patch)].emplace_back(table.net_matrix(element));
  }
  return pieces;
}

void check_continuity(const Patch<2>& patch, const std::vector<PlanePiece>& pieces, double tolerance) {
  double extent = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    extent = std::max(extent, (pieces[i].upper - pieces[0].lower).cwiseAbs().maxCoeff());
    extent = std::max(extent, (pieces[i].lower - pieces[0].upper).cwiseAbs().maxCoeff());
    if (i == 0) continue;
    const double jump = (pieces[i].start() - pieces[i - 1].end()).norm();
    if (jump > tolerance) {
      throw GeometryError(fmt::format("patch '{}': the curve jumps by {:.3g} from {} to {}", patch.name, jump,
                                      at(pieces[i - 1].end()), at(pieces[i].start())));
    }
  }
  if (extent <= tolerance) {
    throw GeometryError(fmt::format("patch '{}': the whole curve lies at {}, within the closure tolerance {:.2g}",
                                    patch.name, at(pieces[0].start()), tolerance));
  }
}

/// One end of a patch: 0 start, 1 end.
struct End {
  int patch = 0;
  int side = 0;
};
int slot(const End& end) {
  return 2 * end.patch + end.side;
}

/// The point of the curve where it has run `distance` away from the given end, along the chord (or its far end).
Point2 point_near_end(const std::vector<PlanePiece>& pieces, const End& end, double distance) {
  const Point2 origin = end.side == 0 ? pieces.front().start() : pieces.back().end();
  constexpr int samples = 16;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const PlanePiece& piece = end.side == 0 ? pieces[k] : pieces[pieces.size() - 1 - k];
    for (int i = 1; i <= samples; ++i) {
      const double s = static_cast<double>(i) / samples;
      const Point2 point = evaluate(piece, end.side == 0 ? s : 1.0 - s);
      if ((point - origin).norm() >= distance) return point;
    }
  }
  return end.side == 0 ? pieces.back().end() : pieces.front().start();
}

/// Which end continues which: partner[slot(end)] is the slot of the other end, -1 if free.
class EndPairing {
 public:
  EndPairing(const Boundary<2>& boundary, const std::vector<std::vector<PlanePiece>>& pieces, double tolerance)
      : boundary_(boundary), pieces_(pieces), clusters_(tolerance), partner_(2 * pieces.size(), -1) {
    std::vector<std::vector<End>> ends_at;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (const int side : {0, 1}) {
        const std::size_t vertex =
            static_cast<std::size_t>(clusters_.add(side == 0 ? pieces[i].front().start() : pieces[i].back().end()));
        ends_at.resize(std::max(ends_at.size(), vertex + 1));
        ends_at[vertex].push_back({static_cast<int>(i), side});
      }
    }
    for (std::vector<End>& ends : ends_at) pair_at_vertex(ends);
  }

  int partner(const End& end) const { return partner_[static_cast<std::size_t>(slot(end))]; }
  double largest_gap() const { return clusters_.largest_distance(); }

 private:
  void join(const End& a, const End& b) {
    partner_[static_cast<std::size_t>(slot(a))] = slot(b);
    partner_[static_cast<std::size_t>(slot(b))] = slot(a);
  }

  void pair_at_vertex(std::vector<End>& ends) {
    // A curve that closes by itself is a loop of its own, whatever else touches its end.
    for (std::size_t i = 0; i + 1 < ends.size();) {
      if (ends[i].patch == ends[i + 1].patch) {
        join(ends[i], ends[i + 1]);
        ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(i), ends.begin() + static_cast<std::ptrdiff_t>(i) + 2);
      } else {
        ++i;
      }
    }
    if (ends.size() < 2) return;
    if (ends.size() == 2) {
      join(ends[0], ends[1]);
      return;
    }
    if (ends.size() % 2 != 0) refuse_branching(ends);
    pair_by_angle(ends);
  }

  [[noreturn]] void refuse_branching(const std::vector<End>& ends) const {
    std::string names;
    for (const End& end : ends) {
      names +=
          fmt::format("{}'{}'", names.empty() ? "" : ", ", boundary_.patches[static_cast<std::size_t>(end.patch)].name);
    }
    const std::vector<PlanePiece>& pieces = pieces_[static_cast<std::size_t>(ends[0].patch)];
    throw GeometryError(fmt::format("{} curve ends meet at {} ({}): a loop passes through a point in pairs of ends",
                                    ends.size(), at(ends[0].side == 0 ? pieces.front().start() : pieces.back().end()),
                                    names));
  }

  /// Neighbours in angle are joined, the narrowest wedge first, so strands touch and never cross.
  void pair_by_angle(const std::vector<End>& ends) {
    double reach = std::numeric_limits<double>::infinity();
    for (const End& end : ends) {
      const std::vector<PlanePiece>& pieces = pieces_[static_cast<std::size_t>(end.patch)];
      reach = std::min(reach, 0.1 * (pieces.front().start() - pieces.back().end()).norm());
    }
    std::vector<std::pair<double, End>> by_angle;
    for (const End& end : ends) {
      const std::vector<PlanePiece>& pieces = pieces_[static_cast<std::size_t>(end.patch)];
      const Point2 origin = end.side == 0 ? pieces.front().start() : pieces.back().end();
      const Vector2 ray = point_near_end(pieces, end, reach) - origin;
      by_angle.push_back({std::atan2(ray.y(), ray.x()), end});
    }
    std::ranges::sort(by_angle, {}, [](const auto& item) { return item.first; });
    const std::size_t count = by_angle.size();
    std::size_t narrowest = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      const double next = by_angle[(i + 1) % count].first + (i + 1 == count ? 2.0 * std::numbers::pi : 0.0);
      if (next - by_angle[i].first < smallest) {
        smallest = next - by_angle[i].first;
        narrowest = i;
      }
    }
    for (std::size_t i = 0; i < count; i += 2) {
      join(by_angle[(narrowest + i) % count].second, by_angle[(narrowest + i + 1) % count].second);
    }
  }

  const Boundary<2>& boundary_;
  const std::vector<std::vector<PlanePiece>>& pieces_;
  PointClusters<2> clusters_;
  std::vector<int> partner_;
};

/// A patch in a chain and whether it is run through forwards (+1) or backwards (-1).
struct Link {
  int patch = 0;
  int direction = 1;
};
struct Chain {
  std::vector<Link> links;
  bool closed = false;
};

/// Follows the chain from `start`, leaving its first patch at its end if direction is +1.
Chain follow(const EndPairing& pairing, Link start, std::vector<bool>& used) {
  Chain chain;
  Link link = start;
  while (!used[static_cast<std::size_t>(link.patch)]) {
    used[static_cast<std::size_t>(link.patch)] = true;
    chain.links.push_back(link);
    const int next = pairing.partner({link.patch, link.direction > 0 ? 1 : 0});
    if (next < 0) return chain;
    link = {next / 2, next % 2 == 0 ? 1 : -1};
  }
  chain.closed = true;
  return chain;
}

std::vector<Chain> find_chains(const EndPairing& pairing, std::size_t count) {
  std::vector<bool> used(count, false);
  std::vector<Chain> chains;
  // Open chains first, each from one of its free ends.
  for (const bool open : {true, false}) {
    for (std::size_t i = 0; i < count; ++i) {
      const int patch = static_cast<int>(i);
      const bool free_start = pairing.partner({patch, 0}) < 0;
      const bool free_end = pairing.partner({patch, 1}) < 0;
      if (used[i] || (open && !free_start && !free_end)) continue;
      chains.push_back(follow(pairing, {patch, open && !free_start ? -1 : 1}, used));
    }
  }
  return chains;
}

/// The pieces of a closed chain in the order in which they are run through, and the patch that each belongs to.
struct LoopPieces {
  std::vector<PlanePiece> pieces;
  std::vector<int> patches;
};

LoopPieces run_through(const Chain& chain, const std::vector<std::vector<PlanePiece>>& pieces, double smallest) {
  LoopPieces loop;
  for (const Link& link : chain.links) {
    std::vector<PlanePiece> own = pieces[static_cast<std::size_t>(link.patch)];
    if (link.direction < 0) {
      std::ranges::reverse(own);
      for (PlanePiece& piece : own) piece = reverse(piece);
    }
    for (const PlanePiece& piece : own) append_monotone_parts(piece, smallest, loop.pieces);
    loop.patches.resize(loop.pieces.size(), link.patch);
  }
  return loop;
}

class LoopOrienter {
 public:
  LoopOrienter(const Boundary<2>& boundary, std::vector<LoopPieces> loops, double tolerance)
      : boundary_(boundary), patches_of_(), tolerance_(tolerance) {
    for (LoopPieces& loop : loops) {
      patches_of_.push_back(std::move(loop.patches));
      loops_.emplace_back(std::move(loop.pieces));
    }
  }

  struct Verdict {
    /// +1 if the loop runs counter-clockwise as it was followed.
    int sign = 1;
    int depth = 0;
  };

  /// Throws for loops without area or with conflicts.
  std::vector<Verdict> judge() const {
    std::vector<Verdict> verdicts(loops_.size());
    std::optional<std::size_t> flat;
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      const std::optional<int> sign = turning_sign(loops_[i]);
      if (sign) verdicts[i].sign = *sign;
      if (!sign && !flat) flat = i;
    }
    const std::optional<LoopConflict> conflict = find_loop_conflict(loops_, tolerance_);
    if (conflict && (!flat || conflict->kind == ContactKind::crossing)) refuse(*conflict);
    if (flat) {
      throw GeometryError(fmt::format("the loop of {} encloses no area (at {})", names(*flat),
                                      at(loops_[*flat].pieces.front().start())));
    }
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      for (std::size_t k = 0; k < loops_.size(); ++k) {
        if (i != k && is_inside(loops_[i], loops_[k])) ++verdicts[i].depth;
      }
    }
    return verdicts;
  }

 private:
  /// Empty if the loop is nowhere wider than the tolerance, in the mean: area against length.
  std::optional<int> turning_sign(const PlaneLoop& loop) const {
    double length = 0.0;
    for (const PlanePiece& piece : loop.pieces) length += (piece.end() - piece.start()).norm();
    const double least = tolerance_ * length;
    const AreaEstimate area = doubled_signed_area(loop.pieces, 0.1 * least);
    if (std::abs(area.value) <= least + area.bound) return std::nullopt;
    return area.value > 0.0 ? 1 : -1;
  }

  /// Loops do not cross, so any point of `inner` away from `outer` decides.
  bool is_inside(const PlaneLoop& inner, const PlaneLoop& outer) const {
    const bool box_inside = (inner.lower.array() >= outer.lower.array() - tolerance_).all() &&
                            (inner.upper.array() <= outer.upper.array() + tolerance_).all();
    if (!box_inside) return false;
    for (const double s : {0.5, 0.25, 0.75, 0.125, 0.875}) {
      for (const PlanePiece& piece : inner.pieces) {
        const Point2 point = evaluate(piece, s);
        if (is_near(outer, point)) continue;
        if (const std::optional<int> turns = winding_number(outer.pieces, point, 1e-3 * tolerance_)) {
          return *turns != 0;
        }
      }
    }
    throw GeometryError(fmt::format("two loops coincide near {}", at(inner.pieces.front().start())));
  }

  bool is_near(const PlaneLoop& loop, const Point2& point) const {
    return std::ranges::any_of(loop.pieces, [&](const PlanePiece& piece) { return is_near(piece, point); });
  }
  bool is_near(const PlanePiece& piece, const Point2& point) const {
    const bool outside_box =
        ((piece.lower - point).array() > tolerance_).any() || ((point - piece.upper).array() > tolerance_).any();
    if (outside_box) return false;
    if (piece.diagonal() <= tolerance_) return true;
    const auto [first, second] = bisect(piece);
    return is_near(first, point) || is_near(second, point);
  }

  const std::string& name(int patch) const { return boundary_.patches[static_cast<std::size_t>(patch)].name; }

  std::string names(std::size_t loop) const {
    std::vector<int> patches = patches_of_[loop];
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    std::string text;
    for (std::size_t i = 0; i < patches.size() && i < 4; ++i) {
      text += fmt::format("{}'{}'", i == 0 ? "" : ", ", name(patches[i]));
    }
    if (patches.size() > 4) text += fmt::format(" and {} more", patches.size() - 4);
    return text;
  }

  [[noreturn]] void refuse(const LoopConflict& conflict) const {
    const auto patch = [&](int loop, int piece) {
      return patches_of_[static_cast<std::size_t>(loop)][static_cast<std::size_t>(piece)];
    };
    const auto [a, b] = std::minmax(
        {patch(conflict.first_loop, conflict.first_piece), patch(conflict.second_loop, conflict.second_piece)});
    const std::string place = at(conflict.place);
    if (conflict.kind == ContactKind::overlap) {
      throw GeometryError(
          a == b ? fmt::format("patch '{}' runs along itself at {}", name(a), place)
                 : fmt::format("patches '{}' and '{}' run along each other at {}", name(a), name(b), place));
    }
    if (conflict.first_loop != conflict.second_loop) {
      throw GeometryError(fmt::format("two loops cross: patches '{}' and '{}' at {}", name(a), name(b), place));
    }
    throw GeometryError(
        a == b ? fmt::format("a loop crosses itself: patch '{}' at {}", name(a), place)
               : fmt::format("a loop crosses itself: patches '{}' and '{}' at {}", name(a), name(b), place));
  }

  const Boundary<2>& boundary_;
  std::vector<std::vector<int>> patches_of_;
  std::vector<PlaneLoop> loops_;
  double tolerance_;
};

Shell<2> shell_of(const Chain& chain) {
  Shell<2> shell;
  for (const Link& link : chain.links) shell.patches.push_back(link.patch);
  shell.closed = chain.closed;
  return shell;
}

/// Turns a chain round: the patches in the opposite order.
void reverse_order(Shell<2>& shell) {
  std::ranges::reverse(shell.patches);
}

void append_free_ends(const Chain& chain, const std::vector<std::vector<PlanePiece>>& pieces, Topology<2>& topology) {
  if (chain.closed) return;
  const Link& first = chain.links.front();
  const Link& last = chain.links.back();
  for (const End& end : {End{first.patch, first.direction > 0 ? 0 : 1}, End{last.patch, last.direction > 0 ? 1 : 0}}) {
    const std::vector<PlanePiece>& own = pieces[static_cast<std::size_t>(end.patch)];
    const Point2 place = end.side == 0 ? own.front().start() : own.back().end();
    topology.free_edges.push_back({end.patch, end.side, place, place});
  }
}

/// Orientation +1 is counter-clockwise about the material; a loop at odd depth bounds a hole.
void orient_closed(const std::vector<Chain>& chains, const std::vector<std::vector<PlanePiece>>& pieces,
                   OrientedBoundary<2>& result) {
  const double tolerance = result.topology.tolerance;
  std::vector<std::size_t> closed;
  std::vector<LoopPieces> loops;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    if (!chains[i].closed) continue;
    closed.push_back(i);
    loops.push_back(run_through(chains[i], pieces, 0.25 * tolerance));
  }
  if (closed.empty()) return;
  const LoopOrienter orienter(result.boundary, std::move(loops), tolerance);
  const std::vector<LoopOrienter::Verdict> verdicts = orienter.judge();
  for (std::size_t k = 0; k < closed.size(); ++k) {
    const bool is_hole = verdicts[k].depth % 2 != 0;
    const int turn = is_hole ? -verdicts[k].sign : verdicts[k].sign;
    for (const Link& link : chains[closed[k]].links) {
      result.boundary.patches[static_cast<std::size_t>(link.patch)].orientation = turn * link.direction;
    }
    Shell<2>& shell = result.topology.shells[closed[k]];
    shell.is_void = is_hole;
    if (turn < 0) reverse_order(shell);
  }
}

}  // namespace

template <>
OrientedBoundary<2> orient<2>(const Boundary<2>& boundary, const OrientationOptions& options) {
  if (boundary.patches.empty()) throw GeometryError("the boundary has no patches");
  const ElementTable<2> table = bezier_elements(boundary);
  OrientedBoundary<2> result{boundary, {}};
  const double tolerance = coincidence_tolerance(bounding_box(table), options.tolerance);
  result.topology.tolerance = tolerance;

  const std::vector<std::vector<PlanePiece>> pieces = pieces_of_patches(boundary, table);
  for (std::size_t i = 0; i < pieces.size(); ++i) check_continuity(boundary.patches[i], pieces[i], tolerance);
  const EndPairing pairing(boundary, pieces, tolerance);
  result.topology.largest_gap = pairing.largest_gap();

  const std::vector<Chain> chains = find_chains(pairing, pieces.size());
  for (const Chain& chain : chains) {
    result.topology.shells.push_back(shell_of(chain));
    append_free_ends(chain, pieces, result.topology);
    for (const Link& link : chain.links) {
      result.boundary.patches[static_cast<std::size_t>(link.patch)].orientation = link.direction;
    }
  }
  orient_closed(chains, pieces, result);
  result.topology.closed = result.topology.free_edges.empty();
  return result;
}

}  // namespace isorim::geometry
