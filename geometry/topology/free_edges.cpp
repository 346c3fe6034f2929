#include "geometry/topology/free_edges.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>

#include "geometry/topology/edge_curve.h"
#include "geometry/topology/point_tree.h"
#include "geometry/topology/shape_loops.h"

namespace isorim::geometry {
namespace {

const SurfaceEdge& edge_of(const EdgeMatching& matching, int piece) {
  return matching.edges[static_cast<std::size_t>(matching.pieces[static_cast<std::size_t>(piece)].edge)];
}

/// The free pieces in the order of patch, loop, curve and parameter.
std::vector<int> in_order(const EdgeMatching& matching) {
  std::vector<int> pieces = matching.free_pieces;
  std::ranges::sort(pieces, {}, [&](int piece) {
    const SurfaceEdge& edge = edge_of(matching, piece);
    return std::tuple(edge.patch, edge.loop, edge.curve, matching.pieces[static_cast<std::size_t>(piece)].domain.first);
  });
  return pieces;
}

/// A free edge with its curve.
struct Stretch {
  FreeEdge<3> edge;
  EdgeCurve curve;
};

std::vector<Stretch> stretches(const std::vector<ShapeLoops>& patches, const EdgeMatching& matching) {
  std::vector<Stretch> result;
  int last_edge = -1;
  for (const int index : in_order(matching)) {
    const EdgePiece& piece = matching.pieces[static_cast<std::size_t>(index)];
    if (piece.edge == last_edge && result.back().edge.domain.last == piece.domain.first) {
      result.back().edge.domain.last = piece.domain.last;
      continue;
    }
    last_edge = piece.edge;
    const SurfaceEdge& edge = edge_of(matching, index);
    const ShapeLoops& loops = patches[static_cast<std::size_t>(edge.patch)];
    FreeEdge<3> free;
    free.patch = edge.patch;
    free.loop = edge.loop;
    free.curve = edge.curve;
    free.domain = piece.domain;
    result.push_back({free, EdgeCurve(loops.surface(edge.loop), loops.curve(edge.loop, edge.curve))});
  }
  for (Stretch& stretch : result) {
    stretch.edge.from = stretch.curve.at(stretch.edge.domain.first);
    stretch.edge.to = stretch.curve.at(stretch.edge.domain.last);
    stretch.edge.length = stretch.curve.length(stretch.edge.domain);
  }
  return result;
}

/// Points on all stretches, not farther apart along them than about a step.
class StretchPoints {
 public:
  explicit StretchPoints(const std::vector<Stretch>& all) : all_(all), tree_(sample()) {}

  /// The nearest other stretch from the middle of one.
  void find_nearest(std::size_t own, FreeEdge<3>& edge) const {
    if (all_.size() < 2) return;
    const Point3 middle = all_[own].curve.at(edge.domain.middle());
    edge.gap = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> near;
    for (double reach = 2.0 * step_; edge.gap + step_ > reach; reach *= 2.0) {
      near.clear();
      const Vector3 margin = Vector3::Constant(reach);
      tree_.for_each_in_box(middle - margin, middle + margin, [&](int point) {
        if (owners_[static_cast<std::size_t>(point)] != own) near.push_back(owners_[static_cast<std::size_t>(point)]);
      });
      std::ranges::sort(near);
      near.erase(std::unique(near.begin(), near.end()), near.end());
      for (const std::size_t other : near) ask(other, middle, edge);
    }
  }

 private:
  std::vector<Point3> sample() {
    constexpr double per_stretch = 8.0;
    double length = 0.0;
    for (const Stretch& stretch : all_) length += stretch.edge.length;
    step_ = length / (per_stretch * static_cast<double>(all_.size()));
    std::vector<Point3> points;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const Interval domain = all_[i].edge.domain;
      const int parts = 1 + static_cast<int>(all_[i].edge.length / step_);
      for (int k = 0; k <= parts; ++k) {
        points.push_back(all_[i].curve.at(domain.first + domain.length() * k / parts));
        owners_.push_back(i);
      }
    }
    return points;
  }

  void ask(std::size_t other, const Point3& point, FreeEdge<3>& edge) const {
    const Stretch& stretch = all_[other];
    const std::optional<EdgeCurve::Foot> foot = stretch.curve.nearest(point, stretch.edge.domain, edge.gap);
    if (!foot || foot->distance >= edge.gap) return;
    edge.gap = foot->distance;
    edge.nearest = static_cast<int>(other);
  }

  const std::vector<Stretch>& all_;
  double step_ = 0.0;
  std::vector<std::size_t> owners_;
  PointTree tree_;
};

}  // namespace

std::vector<FreeEdge<3>> free_edges(const Boundary<3>& boundary, const EdgeMatching& matching) {
  std::vector<FreeEdge<3>> result;
  if (matching.free_pieces.empty()) return result;
  const std::vector<ShapeLoops> loops = shape_loops(boundary);
  const std::vector<Stretch> all = stretches(loops, matching);
  const StretchPoints points(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    result.push_back(all[i].edge);
    points.find_nearest(i, result.back());
  }
  return result;
}

}  // namespace isorim::geometry
