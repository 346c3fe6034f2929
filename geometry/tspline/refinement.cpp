#include "geometry/tspline/refinement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/tspline/local_bspline.h"

namespace isorim::geometry {
namespace {

/// Unit edges by their line and cell.
class EdgeSet {
 public:
  explicit EdgeSet(const IndexMesh& mesh) {
    for (const Direction d : {Direction::u, Direction::v}) {
      length_[index(d)] = mesh.line_count(other(d));
      there_[index(d)].resize(static_cast<std::size_t>(mesh.line_count(d) * length_[index(d)]));
    }
  }

  void insert(Direction d, int line, int cell) { there_[index(d)][place(d, line, cell)] = 1; }
  bool contains(Direction d, int line, int cell) const { return there_[index(d)][place(d, line, cell)] != 0; }

 private:
  std::size_t place(Direction d, int line, int cell) const {
    return static_cast<std::size_t>(line * length_[index(d)] + cell);
  }

  std::array<int, 2> length_{};
  std::array<std::vector<char>, 2> there_;
};

/// Calls use(cell) for the cells of the face extension, from the junction on; ends when use returns false.
template <class Use>
void walk_ahead(const Extension& extension, Use&& use) {
  const TJunction& junction = extension.junction;
  for (int at = junction.at[index(junction.along)]; at != extension.ahead; at += junction.sense)
    if (!use(junction.sense > 0 ? at : at - 1)) return;
}

Direction line_direction(const TJunction& junction) {
  return other(junction.along);
}

int line_of(const TJunction& junction) {
  return junction.at[index(line_direction(junction))];
}

/// The cell that the missing edge would cross, along it.
int cell_ahead(const TJunction& junction) {
  const int at = junction.at[index(junction.along)];
  return junction.sense > 0 ? at : at - 1;
}

/// Adds edges to a T-mesh until it is fit for use and its space holds that of a coarser one. Every step adds at least
/// one edge between existing lines, so it ends; at the latest with a tensor product.
class Closure {
 public:
  Closure(const IndexMesh& coarse, IndexMesh fine) : fine_(std::move(fine)) {
    for (const TJunction& junction : coarse.t_junctions()) coarse_extensions_.push_back(coarse.extension(junction));
  }

  IndexMesh close() {
    while (join() || nest() || separate()) {
    }
    return std::move(fine_);
  }

 private:
  /// Divides the face that the line of `d` would have to cross in this cell.
  void split_at(Direction d, int line, int cell) {
    fine_.split(d == Direction::u ? fine_.face_at(line, cell) : fine_.face_at(cell, line), d, line);
  }

  /// A line on which T-junctions face each other across this face.
  std::optional<std::pair<Direction, int>> joinable_line(std::size_t face) const {
    const IndexBox& box = fine_.faces()[face];
    for (const Direction d : {Direction::u, Direction::v}) {
      const std::size_t along = index(other(d));
      for (int line = box.first[index(d)] + 1; line < box.last[index(d)]; ++line)
        if (fine_.has_edge(d, line, box.first[along] - 1) && fine_.has_edge(d, line, box.last[along]))
          return std::pair(d, line);
    }
    return std::nullopt;
  }

  bool join() {
    bool changed = false;
    for (std::size_t face = 0; face < fine_.faces().size(); ++face) {
      while (const auto line = joinable_line(face)) {
        fine_.split(static_cast<int>(face), line->first, line->second);
        changed = true;
      }
    }
    return changed;
  }

  /// Lets lines of the coarse mesh run on where the extensions of the fine mesh fall short of the coarse ones.
  bool nest() {
    EdgeSet extended(fine_);
    for (const TJunction& junction : fine_.t_junctions()) {
      walk_ahead(fine_.extension(junction), [&](int cell) {
        extended.insert(line_direction(junction), line_of(junction), cell);
        return true;
      });
    }
    bool changed = false;
    for (const Extension& extension : coarse_extensions_) {
      const Direction d = line_direction(extension.junction);
      const int line = line_of(extension.junction);
      bool short_of = false;
      walk_ahead(extension, [&](int cell) {
        short_of = !fine_.has_edge(d, line, cell) && !extended.contains(d, line, cell);
        return !short_of;
      });
      if (!short_of) continue;
      walk_ahead(extension, [&](int cell) {
        if (fine_.has_edge(d, line, cell)) return true;
        split_at(d, line, cell);
        return false;
      });
      changed = true;
    }
    return changed;
  }

  /// Moves on one of two T-junctions whose extensions meet: the one that more others meet, each at most once.
  bool separate() {
    const std::vector<ExtensionConflict> conflicts = extension_conflicts(fine_);
    std::map<std::array<int, 2>, int> meetings;
    for (const ExtensionConflict& conflict : conflicts) {
      ++meetings[conflict.in_u.at];
      ++meetings[conflict.in_v.at];
    }
    std::set<std::array<int, 2>> moved;
    for (const ExtensionConflict& conflict : conflicts) {
      if (moved.contains(conflict.in_u.at) || moved.contains(conflict.in_v.at)) continue;
      const bool first = meetings[conflict.in_u.at] >= meetings[conflict.in_v.at];
      const TJunction& junction = first ? conflict.in_u : conflict.in_v;
      moved.insert(junction.at);
      // The line of another junction may have joined this one meanwhile.
      if (!fine_.has_edge(line_direction(junction), line_of(junction), cell_ahead(junction)))
        split_at(line_direction(junction), line_of(junction), cell_ahead(junction));
    }
    return !conflicts.empty();
  }

  std::vector<Extension> coarse_extensions_;
  IndexMesh fine_;
};

void require_analysis_suitable(const TMesh& mesh) {
  const std::vector<ExtensionConflict> conflicts = extension_conflicts(mesh.index_mesh());
  if (conflicts.empty()) return;
  const auto place = [&](const TJunction& junction) {
    return fmt::format("({}, {})", mesh.knots(Direction::u)[junction.at[0]], mesh.knots(Direction::v)[junction.at[1]]);
  };
  throw GeometryError(
      fmt::format("T-mesh: it is not analysis-suitable, so it cannot be refined exactly: the extensions of the "
                  "T-junctions at (u, v) = {} and {} meet",
                  place(conflicts.front().in_u), place(conflicts.front().in_v)));
}

void require_inside(const TMesh& mesh, const FaceCut& cut) {
  const int count = static_cast<int>(mesh.index_mesh().faces().size());
  if (cut.face < 0 || cut.face >= count)
    throw GeometryError(fmt::format("T-mesh: face {} is to be cut; there are faces 0 to {}", cut.face, count - 1));
  const Interval range = mesh.face_domain(cut.face)[index(cut.direction)];
  if (!(range.first < cut.knot && cut.knot < range.last))
    throw GeometryError(fmt::format("T-mesh: face {} is to be cut at {} = {}; expected a value between {} and {}",
                                    cut.face, "uv"[index(cut.direction)], cut.knot, range.first, range.last));
}

/// Values of the cuts of one direction that are no knots yet.
std::vector<double> new_knots(const TMesh& mesh, std::span<const FaceCut> cuts, Direction d) {
  const std::span<const double> knots = mesh.knots(d).knots();
  std::set<double> values;
  for (const FaceCut& cut : cuts)
    if (cut.direction == d && !std::binary_search(knots.begin(), knots.end(), cut.knot)) values.insert(cut.knot);
  return {values.begin(), values.end()};
}

/// Gives each of `values` a line, which divides no face, and returns the knots with them.
KnotVector insert_lines(const KnotVector& knots, std::span<const double> values, Direction d, IndexMesh& mesh) {
  std::vector<int> cells;
  for (const double value : values) cells.push_back(knots.find_span(value));
  mesh.insert_lines(d, cells);
  std::vector<double> all(knots.knots().begin(), knots.knots().end());
  all.insert(all.end(), values.begin(), values.end());
  std::sort(all.begin(), all.end());
  return {knots.degree(), std::move(all)};
}

/// Divides what the box holds along a line of direction d from side to side.
void cut_box(IndexMesh& mesh, const IndexBox& box, Direction d, int line) {
  for (int cell = box.first[index(other(d))]; cell < box.last[index(other(d))]; ++cell)
    if (!mesh.has_edge(d, line, cell))
      mesh.split(d == Direction::u ? mesh.face_at(line, cell) : mesh.face_at(cell, line), d, line);
}

/// What the dual functional of the function on the knots `fine` gives for the one on the knots `coarse`: the polar
/// form, at the inner fine knots, of the piece where the fine function's support begins. Not negative, and found
/// without cancellation, where the coarse knots on the fine function's support are among the fine ones.
double discrete_bspline(std::span<const double> coarse, std::span<const double> fine) {
  const int piece = piece_at(coarse, fine.front(), Limit::from_right);
  if (piece < 0) return 0.0;
  return blossom(coarse, piece, fine.subspan(1, fine.size() - 2));
}

/// Numbers of the functions that may not be zero right above (u, v), increasing.
std::vector<int> functions_above(const TMesh& mesh, double u, double v) {
  const std::array<Interval, 2> domain = mesh.domain();
  if (domain[0].first <= u && u < domain[0].last && domain[1].first <= v && v < domain[1].last) {
    const int face =
        mesh.index_mesh().face_at(mesh.knots(Direction::u).find_span(u), mesh.knots(Direction::v).find_span(v));
    return mesh.functions_on_faces()[static_cast<std::size_t>(face)];
  }
  // Supports that begin outside the domain, as they do where knots are not clamped.
  std::vector<int> all(static_cast<std::size_t>(mesh.function_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Eigen::Vector4d represented_point(const TSpline& surface, const TMesh& fine, int function) {
  const TMesh& coarse = surface.mesh();
  const std::span<const double> knots_u = fine.local_knots(function, Direction::u);
  const std::span<const double> knots_v = fine.local_knots(function, Direction::v);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const int k : functions_above(coarse, knots_u.front(), knots_v.front()))
    sum += discrete_bspline(coarse.local_knots(k, Direction::u), knots_u) *
           discrete_bspline(coarse.local_knots(k, Direction::v), knots_v) * surface.homogeneous().col(k);
  return sum;
}

/// The same surface over a T-mesh whose space holds that of the surface's own.
TSpline represented(const TSpline& surface, const TMesh& fine) {
  HomogeneousPoints<3> net(4, fine.function_count());
  for (int k = 0; k < fine.function_count(); ++k) net.col(k) = represented_point(surface, fine, k);
  const auto weights = surface.homogeneous().row(3).array();
  if ((weights == weights[0]).all()) net.row(3).setConstant(weights[0]);
  return {fine, std::move(net)};
}

}  // namespace

TMesh refine(const TMesh& mesh, std::span<const FaceCut> cuts) {
  require_analysis_suitable(mesh);
  for (const FaceCut& cut : cuts) require_inside(mesh, cut);
  IndexMesh coarse = mesh.index_mesh();
  const auto with_lines = [&](Direction d) { return insert_lines(mesh.knots(d), new_knots(mesh, cuts, d), d, coarse); };
  const KnotVector knots_u = with_lines(Direction::u);
  const KnotVector knots_v = with_lines(Direction::v);
  IndexMesh fine = coarse;
  for (const FaceCut& cut : cuts) {
    const std::span<const double> knots = (cut.direction == Direction::u ? knots_u : knots_v).knots();
    const auto line = std::lower_bound(knots.begin(), knots.end(), cut.knot) - knots.begin();
    cut_box(fine, coarse.faces()[static_cast<std::size_t>(cut.face)], cut.direction, static_cast<int>(line));
  }
  return {knots_u, knots_v, Closure(coarse, std::move(fine)).close()};
}

TSpline refine(const TSpline& surface, std::span<const FaceCut> cuts) {
  return represented(surface, refine(surface.mesh(), cuts));
}

std::vector<FaceCut> bisections(const TMesh& mesh, std::span<const int> faces, Bisection how) {
  std::vector<FaceCut> cuts;
  for (const int face : faces) {
    for (const Direction d : {Direction::u, Direction::v}) {
      if (how == (d == Direction::u ? Bisection::v : Bisection::u)) continue;
      const Interval range = mesh.face_domain(face)[index(d)];
      if (range.length() == 0.0) continue;
      const double middle = range.middle();
      if (!(range.first < middle && middle < range.last))
        throw GeometryError(fmt::format("T-mesh: there is no number between {} = {} and {} to divide face {} at",
                                        "uv"[index(d)], range.first, range.last, face));
      cuts.push_back({face, d, middle});
    }
  }
  return cuts;
}

std::vector<int> faces_where(const TSpline& surface,
                             const std::function<bool(const Point3& x, const Point2& uv)>& inside) {
  constexpr int points = 5;
  const auto holds = [&](const BezierCell& cell) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) {
        const Point2 uv{cell.domain[0].first + cell.domain[0].length() * (i + 0.5) / points,
                        cell.domain[1].first + cell.domain[1].length() * (j + 0.5) / points};
        if (inside(evaluate(surface, uv), uv)) return true;
      }
    }
    return false;
  };
  std::vector<int> faces;
  for (const BezierCell& cell : bezier_mesh(surface.mesh()))
    if ((faces.empty() || faces.back() != cell.face) && holds(cell)) faces.push_back(cell.face);
  return faces;
}

}  // namespace isorim::geometry
