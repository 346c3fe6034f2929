#include "geometry/shapes/fill.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/shapes/star_kernel.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {
namespace {

double cross(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A loop of the region in the direction in which it is run through, whole curves and monotone pieces of them.
struct FillLoop {
  std::vector<NurbsCurve<2>> curves;
  std::vector<PlanePiece> pieces;
  bool is_hole = false;
};

/// Moves the end of each piece onto the start of the next (rounding, or a gap within the tolerance), so that ends can
/// be compared exactly.
void close_gaps(std::vector<PlanePiece>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Point2 meeting = pieces[(i + 1) % pieces.size()].start();
    HomogeneousPoints<2> net = pieces[i].net;
    const double weight = net(2, net.cols() - 1);
    net.col(net.cols() - 1).head<2>() = weight * meeting;
    pieces[i] = PlanePiece(std::move(net));
  }
}

std::vector<FillLoop> loops_of(const OrientedBoundary<2>& oriented) {
  const double smallest = oriented.topology.tolerance;
  std::vector<FillLoop> loops;
  for (const Shell<2>& shell : oriented.topology.shells) {
    FillLoop loop;
    loop.is_hole = shell.is_void;
    Boundary<2> run;
    for (const int index : shell.patches) {
      const Patch<2>& patch = oriented.boundary.patches[static_cast<std::size_t>(index)];
      run.patches.push_back({patch.name, patch.orientation > 0 ? patch.shape : reverse(patch.shape)});
      loop.curves.push_back(run.patches.back().shape);
    }
    const ElementTable<2> table = bezier_elements(run);
    for (const BezierElement<2>& element : table.elements) {
      append_monotone_parts(PlanePiece(table.net_matrix(element)), smallest, loop.pieces);
    }
    close_gaps(loop.pieces);
    loops.push_back(std::move(loop));
  }
  return loops;
}

bool is_straight(const PlanePiece& piece) {
  const Vector2 chord = piece.end() - piece.start();
  for (Eigen::Index i = 1; i + 1 < piece.net.cols(); ++i) {
    if (std::abs(cross(chord, piece.control_point(i) - piece.start())) > 1e-14 * chord.squaredNorm()) return false;
  }
  return true;
}

PlanePiece straight(const Point2& from, const Point2& to) {
  HomogeneousPoints<2> net(3, 2);
  net << from.x(), to.x(), from.y(), to.y(), 1.0, 1.0;
  return PlanePiece(std::move(net));
}

std::vector<PlanePiece> halved(const std::vector<PlanePiece>& pieces) {
  std::vector<PlanePiece> result;
  for (const PlanePiece& piece : pieces) {
    if (is_straight(piece)) {
      result.push_back(piece);
      continue;
    }
    auto [first, second] = bisect(piece);
    result.push_back(std::move(first));
    result.push_back(std::move(second));
  }
  return result;
}

NurbsCurve<2> as_curve(const PlanePiece& piece) {
  return {KnotVector::bezier(static_cast<int>(piece.net.cols()) - 1), piece.net};
}

/// Directions in which a piece leaves its start and arrives at its end, past doubled control points.
Vector2 leaving(const PlanePiece& piece) {
  Eigen::Index i = 1;
  while (i + 1 < piece.net.cols() && piece.control_point(i) == piece.start()) ++i;
  return piece.control_point(i) - piece.start();
}
Vector2 arriving(const PlanePiece& piece) {
  Eigen::Index i = piece.net.cols() - 2;
  while (i > 0 && piece.control_point(i) == piece.end()) --i;
  return piece.end() - piece.control_point(i);
}

/// Whether `ray` lies strictly between `from` and `to`, counter-clockwise.
bool is_between(const Vector2& from, const Vector2& ray, const Vector2& to) {
  const bool convex = cross(from, to) > 0.0;
  const bool after = cross(from, ray) > 0.0;
  const bool before = cross(ray, to) > 0.0;
  return convex ? after && before : after || before;
}

/// A closed chain of pieces that grows by bridges and shrinks by ears; vertex i is where piece i starts.
class CurvedPolygon {
 public:
  CurvedPolygon(std::vector<PlanePiece> outer, std::vector<std::vector<PlanePiece>> holes)
      : sides_(std::move(outer)), holes_(std::move(holes)) {}

  /// The patches, or nothing if some hole cannot be bridged or no ear is left.
  std::optional<std::vector<NurbsSurface<2>>> triangulate() {
    while (!holes_.empty()) {
      if (!bridge_one_hole()) return std::nullopt;
    }
    std::vector<NurbsSurface<2>> patches;
    while (true) {
      if (const auto whole = fill_small(sides_)) {
        patches.insert(patches.end(), whole->begin(), whole->end());
        return patches;
      }
      if (sides_.size() <= 3 || !clip_best_ear(patches)) return std::nullopt;
    }
  }

 private:
  std::size_t next(std::size_t i) const { return (i + 1) % sides_.size(); }
  std::size_t previous(std::size_t i) const { return (i + sides_.size() - 1) % sides_.size(); }

  /// Does the diagonal from a to b leave the chain's vertex `i` into its interior?
  static bool enters(const std::vector<PlanePiece>& chain, std::size_t i, const Vector2& ray) {
    const PlanePiece& before = chain[(i + chain.size() - 1) % chain.size()];
    return is_between(leaving(chain[i]), ray, -arriving(before));
  }

  /// Certain if true: the diagonal meets the piece at shared ends alone.
  static bool is_clear(const PlanePiece& diagonal, const PlanePiece& piece) {
    const Point2 a = diagonal.start();
    const Point2 b = diagonal.end();
    const bool at_start = piece.start() == a || piece.start() == b;
    const bool at_end = piece.end() == a || piece.end() == b;
    if (!at_start && !at_end) return are_separated(diagonal, piece, 0.0);
    const Point2 shared = at_start ? piece.start() : piece.end();
    const Vector2 ray = shared == a ? Vector2(b - a) : Vector2(a - b);
    bool left = true;
    bool right = true;
    bool behind = true;
    for (Eigen::Index i = 0; i < piece.net.cols(); ++i) {
      const Vector2 arm = piece.control_point(i) - shared;
      if (arm.isZero(0.0)) continue;
      const bool is_other_end = at_start && at_end && piece.control_point(i) == (shared == a ? b : a);
      left = left && (is_other_end || cross(ray, arm) > 0.0);
      right = right && (is_other_end || cross(ray, arm) < 0.0);
      behind = behind && ray.dot(arm) <= 0.0;
    }
    return left || right || behind;
  }

  bool is_clear_of_all(const PlanePiece& diagonal) const {
    const auto clear = [&](const PlanePiece& piece) { return is_clear(diagonal, piece); };
    if (!std::ranges::all_of(sides_, clear)) return false;
    return std::ranges::all_of(holes_, [&](const auto& hole) { return std::ranges::all_of(hole, clear); });
  }

  /// Joins the hole with the shortest bridge to the chain.
  bool bridge_one_hole() {
    double shortest = std::numeric_limits<double>::infinity();
    std::size_t best_hole = 0;
    std::size_t best_inner = 0;
    std::size_t best_outer = 0;
    for (std::size_t h = 0; h < holes_.size(); ++h) {
      for (std::size_t k = 0; k < holes_[h].size(); ++k) {
        for (std::size_t i = 0; i < sides_.size(); ++i) {
          const Vector2 bridge = holes_[h][k].start() - sides_[i].start();
          if (bridge.norm() >= shortest || bridge.isZero(0.0)) continue;
          if (!enters(sides_, i, bridge) || !enters(holes_[h], k, -bridge)) continue;
          if (!is_clear_of_all(straight(sides_[i].start(), holes_[h][k].start()))) continue;
          shortest = bridge.norm();
          best_hole = h;
          best_inner = k;
          best_outer = i;
        }
      }
    }
    if (shortest == std::numeric_limits<double>::infinity()) return false;
    std::vector<PlanePiece> hole = std::move(holes_[best_hole]);
    holes_.erase(holes_.begin() + static_cast<std::ptrdiff_t>(best_hole));
    std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(best_inner), hole.end());
    const Point2 outer = sides_[best_outer].start();
    const Point2 inner = hole.front().start();
    hole.insert(hole.begin(), straight(outer, inner));
    hole.push_back(straight(inner, outer));
    sides_.insert(sides_.begin() + static_cast<std::ptrdiff_t>(best_outer), hole.begin(), hole.end());
    return true;
  }

  /// A loop of at most three sides, or one that is star-shaped, as fans; straight sides in line with the apex vanish.
  static std::optional<std::vector<NurbsSurface<2>>> fill_small(const std::vector<PlanePiece>& loop) {
    if (loop.size() == 3) {
      for (std::size_t i = 0; i < 3; ++i) {
        const bool others_straight = is_straight(loop[(i + 1) % 3]) && is_straight(loop[(i + 2) % 3]);
        const Point2 apex = loop[(i + 2) % 3].start();
        if (others_straight && cross(loop[i].start() - apex, loop[i].end() - apex) > 0.0 &&
            is_visible_from(loop[i], apex)) {
          return std::vector{fan<2>(as_curve(loop[i]), apex)};
        }
      }
    }
    const std::optional<Point2> apex = kernel_point(loop);
    if (!apex) return std::nullopt;
    std::vector<NurbsSurface<2>> patches;
    for (const PlanePiece& side : loop) patches.push_back(fan<2>(as_curve(side), *apex));
    return patches;
  }

  /// Clips the ear with the shortest diagonal.
  bool clip_best_ear(std::vector<NurbsSurface<2>>& patches) {
    std::vector<std::pair<double, std::size_t>> by_length;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      by_length.emplace_back((sides_[next(i)].end() - sides_[i].start()).norm(), i);
    }
    std::ranges::sort(by_length);
    for (const auto& [length, i] : by_length) {
      const std::size_t k = next(i);
      const PlanePiece diagonal = straight(sides_[i].start(), sides_[k].end());
      const Vector2 ray = diagonal.end() - diagonal.start();
      if (length == 0.0 || !enters(sides_, i, ray) || !enters(sides_, next(k), -ray)) continue;
      if (!is_clear_of_all(diagonal)) continue;
      const auto ear = fill_small({sides_[i], sides_[k], reverse(diagonal)});
      if (!ear) continue;
      patches.insert(patches.end(), ear->begin(), ear->end());
      sides_[i] = diagonal;
      sides_.erase(sides_.begin() + static_cast<std::ptrdiff_t>(k));
      return true;
    }
    return false;
  }

  std::vector<PlanePiece> sides_;
  std::vector<std::vector<PlanePiece>> holes_;
};

/// The smallest outer loop that holds the hole.
std::size_t owner_of(const FillLoop& hole, const std::vector<FillLoop>& loops, double tolerance) {
  std::size_t owner = loops.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].is_hole) continue;
    const double area = doubled_signed_area(loops[i].pieces, 0.0).value;
    if (area >= least) continue;
    for (const PlanePiece& piece : hole.pieces) {
      const std::optional<int> turns = winding_number(loops[i].pieces, evaluate(piece, 0.5), tolerance);
      if (!turns) continue;
      if (*turns != 0) {
        owner = i;
        least = area;
      }
      break;
    }
  }
  return owner;
}

/// One fan a curve if the loop is star-shaped.
std::optional<std::vector<NurbsSurface<2>>> fill_star(const FillLoop& loop) {
  std::optional<Point2> apex = kernel_point(loop.pieces);
  if (!apex) apex = kernel_point(halved(loop.pieces));
  if (!apex) return std::nullopt;
  std::vector<NurbsSurface<2>> patches;
  for (const NurbsCurve<2>& curve : loop.curves) patches.push_back(fan<2>(curve, *apex));
  return patches;
}

std::vector<NurbsSurface<2>> fill_group(const FillLoop& outer, const std::vector<const FillLoop*>& holes) {
  if (holes.empty()) {
    if (auto patches = fill_star(outer)) return *patches;
  }
  constexpr int most_halvings = 7;
  std::vector<PlanePiece> pieces = outer.pieces;
  std::vector<std::vector<PlanePiece>> inner;
  for (const FillLoop* hole : holes) inner.push_back(hole->pieces);
  for (int i = 0; i <= most_halvings; ++i) {
    if (auto patches = CurvedPolygon(pieces, inner).triangulate()) return *patches;
    pieces = halved(pieces);
    for (std::vector<PlanePiece>& hole : inner) hole = halved(hole);
  }
  const Point2 place = outer.pieces.front().start();
  throw GeometryError(fmt::format(
      "the plane region whose outer loop starts at ({:.9g}, {:.9g}) could not be cut into patches: loops that touch or "
      "run very close to each other are not supported here; move them apart, or give the cap as patches of your own",
      place.x(), place.y()));
}

}  // namespace

std::vector<NurbsSurface<2>> fill(const Boundary<2>& region) {
  const OrientedBoundary<2> oriented = orient(region);
  require_closed(oriented);
  const std::vector<FillLoop> loops = loops_of(oriented);
  std::vector<std::vector<const FillLoop*>> holes(loops.size() + 1);
  for (const FillLoop& loop : loops) {
    if (loop.is_hole) holes[owner_of(loop, loops, oriented.topology.tolerance)].push_back(&loop);
  }
  std::vector<NurbsSurface<2>> patches;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].is_hole) continue;
    const std::vector<NurbsSurface<2>> own = fill_group(loops[i], holes[i]);
    patches.insert(patches.end(), own.begin(), own.end());
  }
  return patches;
}

}  // namespace isorim::geometry
