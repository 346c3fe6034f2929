#include "geometry/topology/edge_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/surface.h"
#include "geometry/topology/point_clusters.h"

namespace isorim::geometry {
namespace {

std::string at(const Point3& point) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", point.x(), point.y(), point.z());
}

/// Points in boxes, by a regular grid of about one cell a point.
class PointGrid {
 public:
  explicit PointGrid(const PointClusters<3>& points) : points_(points) {
    lower_ = upper_ = points[0];
    for (int i = 1; i < points.size(); ++i) {
      lower_ = lower_.cwiseMin(points[i]);
      upper_ = upper_.cwiseMax(points[i]);
    }
    const double longest = std::max((upper_ - lower_).maxCoeff(), 1e-300);
    // Points on a surface fill about n^2 of the n^3 cells.
    const double per_axis = std::clamp(std::sqrt(static_cast<double>(points.size())), 1.0, 64.0);
    size_ = longest / per_axis;
    for (int i = 0; i < 3; ++i) counts_[i] = cell(upper_, i, 1 << 20) + 1;
    cells_.resize(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2]);
    for (int i = 0; i < points.size(); ++i) {
      cells_[index(cell(points[i], 0, counts_[0] - 1), cell(points[i], 1, counts_[1] - 1),
                   cell(points[i], 2, counts_[2] - 1))]
          .push_back(i);
    }
  }

  template <typename Visit>
  void for_each_in_box(const Point3& lower, const Point3& upper, const Visit& visit) const {
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    for (int i = 0; i < 3; ++i) {
      low[i] = cell(lower, i, counts_[i] - 1);
      high[i] = cell(upper, i, counts_[i] - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          for (const int point : cells_[index(x, y, z)]) {
            const bool inside =
                (points_[point].array() >= lower.array()).all() && (points_[point].array() <= upper.array()).all();
            if (inside) visit(point);
          }
        }
      }
    }
  }

 private:
  int cell(const Point3& point, int axis, int last) const {
    return static_cast<int>(
        std::clamp(std::floor((point(axis) - lower_(axis)) / size_), 0.0, static_cast<double>(last)));
  }
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) + static_cast<std::size_t>(counts_[0]) * (y + counts_[1] * z);
  }

  const PointClusters<3>& points_;
  Point3 lower_;
  Point3 upper_;
  double size_ = 1.0;
  std::array<int, 3> counts_{};
  std::vector<std::vector<int>> cells_;
};

std::vector<SurfaceEdge> find_edges(const Boundary<3>& boundary, double tolerance) {
  // Counter-clockwise about the rectangle: along v = first, up u = last, back along v = last, down u = first.
  constexpr std::array<int, 4> direction{1, 1, -1, -1};
  std::vector<SurfaceEdge> edges;
  for (std::size_t i = 0; i < boundary.patches.size(); ++i) {
    std::array<NurbsCurve<3>, 4> curves = boundary_curves(surface_of(boundary.patches[i].shape));
    for (std::size_t side = 0; side < 4; ++side) {
      const Points<3> points = curves[side].control_points();
      const Point3 lower = points.rowwise().minCoeff();
      const Point3 upper = points.rowwise().maxCoeff();
      if ((upper - lower).norm() <= tolerance) continue;
      edges.push_back(
          {static_cast<int>(i), static_cast<int>(side), std::move(curves[side]), direction[side], lower, upper, 0, 0});
    }
  }
  return edges;
}

/// The part of the matching that knows the tolerance and the edges.
class Matcher {
 public:
  Matcher(const Boundary<3>& boundary, double tolerance)
      : boundary_(boundary), tolerance_(tolerance), vertices_(tolerance) {
    result_.edges = find_edges(boundary, tolerance);
  }

  EdgeMatching run() {
    if (result_.edges.empty()) return std::move(result_);
    for (SurfaceEdge& edge : result_.edges) {
      edge.from = vertices_.add(evaluate(edge.curve, edge.curve.domain().first));
      edge.to = vertices_.add(evaluate(edge.curve, edge.curve.domain().last));
    }
    result_.largest_gap = vertices_.largest_distance();
    const PointGrid grid(vertices_);
    for (std::size_t i = 0; i < result_.edges.size(); ++i) split_at_vertices(static_cast<int>(i), grid);
    join_pieces();
    return std::move(result_);
  }

 private:
  const SurfaceEdge& edge_of(const EdgePiece& piece) const {
    return result_.edges[static_cast<std::size_t>(piece.edge)];
  }
  const EdgePiece& piece(int index) const { return result_.pieces[static_cast<std::size_t>(index)]; }
  const std::string& patch_name(int index) const {
    return boundary_.patches[static_cast<std::size_t>(edge_of(piece(index)).patch)].name;
  }

  void split_at_vertices(int index, const PointGrid& grid) {
    const SurfaceEdge& edge = result_.edges[static_cast<std::size_t>(index)];
    const Interval domain = edge.curve.domain();
    std::vector<std::pair<double, int>> stops{{domain.first, edge.from}, {domain.last, edge.to}};
    const Vector3 margin = Vector3::Constant(tolerance_);
    grid.for_each_in_box(edge.lower - margin, edge.upper + margin, [&](int vertex) {
      if (vertex == edge.from || vertex == edge.to) return;
      const ClosestCurvePoint<3> foot = closest_point(edge.curve, vertices_[vertex]);
      if (foot.distance > tolerance_) return;
      result_.largest_gap = std::max(result_.largest_gap, foot.distance);
      stops.emplace_back(foot.u, vertex);
    });
    std::ranges::sort(stops);
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      result_.pieces.push_back({index, {stops[i].first, stops[i + 1].first}, stops[i].second, stops[i + 1].second});
    }
  }

  Point3 point_at(const EdgePiece& piece, double fraction) const {
    return evaluate(edge_of(piece).curve, piece.domain.first + fraction * piece.domain.length());
  }

  /// Where the point lies on the piece, as a fraction, if it does.
  std::optional<double> fraction_on(const EdgePiece& piece, const Point3& point, double& gap) const {
    const ClosestCurvePoint<3> foot = closest_point(edge_of(piece).curve, point);
    if (foot.distance > tolerance_) return std::nullopt;
    const double fraction = (foot.u - piece.domain.first) / piece.domain.length();
    // A neighbouring piece of the same edge may touch at the shared vertex only.
    if (fraction < -1e-6 || fraction > 1.0 + 1e-6) return std::nullopt;
    gap = std::max(gap, foot.distance);
    return fraction;
  }

  /// How far apart the pieces are at equal (or mirrored) fractions.
  double distance_at_fractions(const EdgePiece& a, const EdgePiece& b, bool mirrored) const {
    double distance = 0.0;
    for (const double f : {0.25, 0.5, 0.75}) {
      distance = std::max(distance, (point_at(a, f) - point_at(b, mirrored ? 1.0 - f : f)).norm());
    }
    return distance;
  }

  struct Coincidence {
    bool same_direction = false;
    double gap = 0.0;
  };
  /// Whether two pieces between the same vertices run along each other.
  std::optional<Coincidence> coincide(const EdgePiece& a, const EdgePiece& b) const {
    const bool distinct_ends = a.from != a.to;
    for (const bool same : {true, false}) {
      if (distinct_ends && same != (a.from == b.from)) continue;
      const double distance = distance_at_fractions(a, b, !same);
      if (distance <= tolerance_) return Coincidence{same, distance};
    }
    // The same curve may be run through at another pace.
    Coincidence result;
    std::array<double, 3> fractions{};
    std::size_t next = 0;
    for (const double f : {0.25, 0.5, 0.75}) {
      const std::optional<double> fraction = fraction_on(b, point_at(a, f), result.gap);
      if (!fraction) return std::nullopt;
      fractions[next++] = *fraction;
    }
    result.same_direction = distinct_ends ? a.from == b.from : fractions[0] < fractions[2];
    return result;
  }

  void join_pieces() {
    std::map<std::pair<int, int>, std::vector<int>> by_ends;
    for (std::size_t i = 0; i < result_.pieces.size(); ++i) {
      const EdgePiece& own = result_.pieces[i];
      by_ends[std::minmax(own.from, own.to)].push_back(static_cast<int>(i));
    }
    std::vector<int> partner(result_.pieces.size(), -1);
    for (const auto& [ends, candidates] : by_ends) {
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        for (std::size_t k = i + 1; k < candidates.size(); ++k) join(candidates[i], candidates[k], partner);
      }
    }
    for (std::size_t i = 0; i < partner.size(); ++i) {
      if (partner[i] < 0) result_.free_pieces.push_back(static_cast<int>(i));
    }
  }

  void join(int a, int b, std::vector<int>& partner) {
    const std::optional<Coincidence> found = coincide(piece(a), piece(b));
    if (!found) return;
    for (const int own : {a, b}) {
      const int other = partner[static_cast<std::size_t>(own)];
      if (other < 0) continue;
      const int third = own == a ? b : a;
      throw GeometryError(
          fmt::format("patches '{}', '{}' and '{}' share the edge from {} to {}: an edge joins two patches at most",
                      patch_name(own), patch_name(other), patch_name(third), at(vertices_[piece(own).from]),
                      at(vertices_[piece(own).to])));
    }
    partner[static_cast<std::size_t>(a)] = b;
    partner[static_cast<std::size_t>(b)] = a;
    result_.joints.push_back({a, b, found->same_direction});
    result_.largest_gap = std::max(result_.largest_gap, found->gap);
  }

  const Boundary<3>& boundary_;
  double tolerance_;
  PointClusters<3> vertices_;
  EdgeMatching result_;
};

}  // namespace

EdgeMatching match_edges(const Boundary<3>& boundary, double tolerance) {
  return Matcher(boundary, tolerance).run();
}

}  // namespace isorim::geometry
