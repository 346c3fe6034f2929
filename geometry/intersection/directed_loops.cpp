#include "geometry/intersection/directed_loops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/topology/point_clusters.h"
#include "geometry/trimming/loop_pieces.h"

namespace isorim::geometry {
namespace {

Point2 start_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().first);
}

Point2 end_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().last);
}

class Chainer {
 public:
  Chainer(const std::vector<NurbsCurve<2>>& curves, const Vector2& scale, double tolerance, double closing)
      : scale_(scale), closing_(closing), vertices_(tolerance) {
    for (const NurbsCurve<2>& curve : curves) {
      const int from = vertices_.add(scaled(start_of(curve)));
      const int to = vertices_.add(scaled(end_of(curve)));
      if (from == to && extent(curve) <= tolerance) {
        short_.push_back({curve, from, to});
        continue;
      }
      edges_.push_back({curve, from, to});
    }
    leaving_.resize(static_cast<std::size_t>(vertices_.size()));
    entering_.resize(static_cast<std::size_t>(vertices_.size()));
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      leaving_[static_cast<std::size_t>(edges_[i].from)].push_back(i);
      ++entering_[static_cast<std::size_t>(edges_[i].to)];
    }
  }

  std::vector<TrimLoop> loops() {
    require_balance();
    std::vector<TrimLoop> result;
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (edges_[first].used) continue;
      TrimLoop loop;
      for (std::size_t i = first; !edges_[i].used; i = next_of(i)) {
        edges_[i].used = true;
        loop.curves.push_back(edges_[i].curve);
        add_short_curves(loop, edges_[i].to, start_of(edges_[next_of(i)].curve));
      }
      close_small_gaps(loop);
      result.push_back(std::move(loop));
    }
    return result;
  }

 private:
  struct Edge {
    NurbsCurve<2> curve;
    int from;
    int to;
    bool used = false;
  };

  Point2 scaled(const Point2& point) const { return point.cwiseQuotient(scale_); }

  double extent(const NurbsCurve<2>& curve) const {
    const Points<2> points = curve.control_points();
    return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cwiseQuotient(scale_).maxCoeff();
  }

  void require_balance() const {
    for (int v = 0; v < vertices_.size(); ++v) {
      const auto i = static_cast<std::size_t>(v);
      if (static_cast<int>(leaving_[i].size()) == entering_[i]) continue;
      const Point2 place = vertices_[v].cwiseProduct(scale_);
      throw GeometryError(fmt::format("curves do not close into loops: at ({:.9g}, {:.9g}) {} end and {} start",
                                      place.x(), place.y(), entering_[i], leaving_[i].size()));
    }
  }

  /// Seen from an end of the curve, a point a little way along it.
  Vector2 direction(const Edge& edge, bool from_start) const {
    const Interval domain = edge.curve.domain();
    constexpr double step = 1e-3;
    const double u = from_start ? domain.first + step * domain.length() : domain.last - step * domain.length();
    const Point2 end = from_start ? start_of(edge.curve) : end_of(edge.curve);
    return scaled(evaluate(edge.curve, u)) - scaled(end);
  }

  /// The first curve met when turning clockwise from where edge i came from.
  std::size_t next_of(std::size_t i) const {
    const std::vector<std::size_t>& candidates = leaving_[static_cast<std::size_t>(edges_[i].to)];
    const Vector2 back = direction(edges_[i], false);
    std::size_t best = candidates.front();
    double least = 10.0;
    for (const std::size_t candidate : candidates) {
      if (edges_[candidate].used && candidates.size() > 1 && !all_used(candidates)) continue;
      const Vector2 ahead = direction(edges_[candidate], true);
      double turn = std::atan2(ahead.x() * back.y() - ahead.y() * back.x(), ahead.dot(back));
      if (turn <= 0.0) turn += 2.0 * std::numbers::pi;
      if (turn >= least) continue;
      least = turn;
      best = candidate;
    }
    return best;
  }

  bool meet(const Point2& a, const Point2& b) const { return scaled(a - b).cwiseAbs().maxCoeff() <= closing_; }

  /// Those that lead on from the loop's end to the start of its next curve, all within one vertex.
  void add_short_curves(TrimLoop& loop, int vertex, const Point2& next) {
    const std::size_t before = loop.curves.size();
    std::vector<std::size_t> taken;
    while (!meet(end_of(loop.curves.back()), next)) {
      const Point2 end = end_of(loop.curves.back());
      const auto found = std::find_if(short_.begin(), short_.end(), [&](const Edge& edge) {
        return !edge.used && edge.from == vertex && meet(start_of(edge.curve), end);
      });
      if (found == short_.end()) break;
      found->used = true;
      taken.push_back(static_cast<std::size_t>(found - short_.begin()));
      loop.curves.push_back(found->curve);
    }
    if (meet(end_of(loop.curves.back()), next)) return;
    // They lead elsewhere.
    loop.curves.erase(loop.curves.begin() + static_cast<std::ptrdiff_t>(before), loop.curves.end());
    for (const std::size_t i : taken) short_[i].used = false;
  }

  bool all_used(const std::vector<std::size_t>& candidates) const {
    return std::all_of(candidates.begin(), candidates.end(), [&](std::size_t i) { return edges_[i].used; });
  }

  /// Moves each start onto the end before it.
  void close_small_gaps(TrimLoop& loop) const {
    for (std::size_t i = 0; i < loop.curves.size(); ++i) {
      NurbsCurve<2>& curve = loop.curves[(i + 1) % loop.curves.size()];
      const Point2 end = end_of(loop.curves[i]);
      const Point2 start = start_of(curve);
      if (start == end || !curve.knots().is_clamped()) continue;
      if (scaled(start - end).cwiseAbs().maxCoeff() > closing_) continue;
      HomogeneousPoints<2> net = curve.homogeneous();
      net.col(0).head<2>() = net(2, 0) * end;
      curve = NurbsCurve<2>(curve.knots(), std::move(net));
    }
  }

  Vector2 scale_;
  double closing_;
  PointClusters<2> vertices_;
  std::vector<Edge> edges_;
  /// Within one vertex.
  std::vector<Edge> short_;
  std::vector<std::vector<std::size_t>> leaving_;
  std::vector<int> entering_;
};

}  // namespace

std::vector<TrimLoop> chain_directed_curves(const std::vector<NurbsCurve<2>>& curves, const Vector2& scale,
                                            double tolerance, double closing) {
  return Chainer(curves, scale, tolerance, closing).loops();
}

double doubled_area(const TrimLoop& loop) {
  const std::vector<PlanePiece> pieces = loop_pieces(loop);
  if (pieces.empty()) return 0.0;
  Point2 lower = pieces.front().lower;
  Point2 upper = pieces.front().upper;
  for (const PlanePiece& piece : pieces) {
    lower = lower.cwiseMin(piece.lower);
    upper = upper.cwiseMax(piece.upper);
  }
  return doubled_signed_area(pieces, 1e-15 * (upper - lower).prod()).value;
}

}  // namespace isorim::geometry
