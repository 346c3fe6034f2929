#include "geometry/intersection/section_edges.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/trimming/lifted_curve.h"

namespace isorim::geometry {
namespace {

constexpr int samples = 16;

/// Of an edge that others may run along.
struct Sampled {
  std::array<Point3, samples + 1> points;
  double length = 0.0;

  explicit Sampled(const SectionPiece& piece) {
    for (int k = 0; k <= samples; ++k) points[static_cast<std::size_t>(k)] = point_on(piece, k / double{samples});
    for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  }
  const Point3& start() const { return points.front(); }
  const Point3& end() const { return points.back(); }
};

NearestOnPiece nearest_on(const SectionPiece& piece, const Sampled& sampled, const Point3& x) {
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= samples; ++k) {
    const double distance = (sampled.points[static_cast<std::size_t>(k)] - x).norm();
    if (distance >= least) continue;
    least = distance;
    best = k;
  }
  // Golden section about the nearest sample.
  constexpr double ratio = 0.6180339887498949;
  double low = std::max(0, best - 1) / double{samples};
  double high = std::min(samples, best + 1) / double{samples};
  const auto distance = [&](double t) { return (point_on(piece, t) - x).squaredNorm(); };
  double a = high - ratio * (high - low);
  double b = low + ratio * (high - low);
  double at_a = distance(a);
  double at_b = distance(b);
  for (int iteration = 0; iteration < 44; ++iteration) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - ratio * (high - low);
      at_a = distance(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + ratio * (high - low);
      at_b = distance(b);
    }
  }
  NearestOnPiece result{0.5 * (low + high), 0.0};
  result.distance = (point_on(piece, result.t) - x).norm();
  const double at_sample = best / double{samples};
  if (least < result.distance) result = {at_sample, least};
  return result;
}

SectionPiece part_of(const SectionPiece& piece, Interval part) {
  SectionPiece result = piece;
  result.parameters = reparametrise(restrict_to(piece.parameters, part), {0.0, 1.0});
  return result;
}

/// The edges on loops, cut at each other's ends.
std::vector<SectionEdge> divided(const std::vector<SectionEdge>& edges, double distance) {
  std::vector<std::optional<Sampled>> sampled;
  for (const SectionEdge& edge : edges)
    sampled.push_back(edge.is_on_loop ? std::optional<Sampled>(edge.piece) : std::nullopt);
  std::vector<SectionEdge> result;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!sampled[i]) {
      result.push_back(edges[i]);
      continue;
    }
    std::vector<double> cuts{0.0, 1.0};
    const double reach = sampled[i]->length + distance;
    for (std::size_t j = 0; j < edges.size(); ++j) {
      if (i == j || !sampled[j]) continue;
      for (const Point3& end : {sampled[j]->start(), sampled[j]->end()}) {
        const double from_ends = std::min((end - sampled[i]->start()).norm(), (end - sampled[i]->end()).norm());
        if (from_ends <= 2.0 * distance || from_ends > reach) continue;
        const NearestOnPiece near = nearest_on(edges[i].piece, *sampled[i], end);
        if (near.distance <= distance && near.t > 0.0 && near.t < 1.0) cuts.push_back(near.t);
      }
    }
    std::ranges::sort(cuts);
    const double least = 2.0 * distance / std::max(sampled[i]->length, distance);
    double from = 0.0;
    for (const double cut : cuts) {
      if (cut != 1.0 && (cut - from < least || 1.0 - cut < least)) continue;
      if (cut == from) continue;
      SectionEdge part = edges[i];
      if (from > 0.0 || cut < 1.0) part.piece = part_of(edges[i].piece, {from, cut});
      result.push_back(std::move(part));
      from = cut;
    }
  }
  return result;
}

enum class Relation { none, same, opposite };

Relation relation(const SectionPiece& a, const Sampled& of_a, const SectionPiece& b, const Sampled& of_b,
                  double distance) {
  const auto near = [&](const Point3& x, const Point3& y) { return (x - y).norm() <= 2.0 * distance; };
  const bool same = near(of_a.start(), of_b.start()) && near(of_a.end(), of_b.end());
  const bool opposite = near(of_a.start(), of_b.end()) && near(of_a.end(), of_b.start());
  if (!same && !opposite) return Relation::none;
  for (const double t : {0.5, 0.25, 0.75})
    if (nearest_on(b, of_b, point_on(a, t)).distance > 2.0 * distance) return Relation::none;
  if (same != opposite) return same ? Relation::same : Relation::opposite;
  // Both closed, or shorter than the distance.
  const NearestOnPiece first = nearest_on(b, of_b, point_on(a, 0.25));
  const NearestOnPiece second = nearest_on(b, of_b, point_on(a, 0.5));
  return first.t < second.t ? Relation::same : Relation::opposite;
}

}  // namespace

Point3 point_on(const SectionPiece& piece, double t) {
  return lifted_point(*piece.surface, piece.parameters, t);
}

NearestOnPiece nearest_on(const SectionPiece& piece, const Point3& x) {
  return nearest_on(piece, Sampled(piece), x);
}

SectionPiece reversed(const SectionPiece& piece) {
  SectionPiece result = piece;
  result.parameters = reverse(piece.parameters);
  return result;
}

std::vector<SectionEdge> cancel_opposite_edges(std::vector<SectionEdge> edges, double distance,
                                               std::vector<SectionPiece>& touching) {
  const auto on_loops = std::ranges::count_if(edges, [](const SectionEdge& edge) { return edge.is_on_loop; });
  if (on_loops < 2) return edges;
  edges = divided(edges, distance);
  std::vector<std::optional<Sampled>> sampled;
  for (const SectionEdge& edge : edges)
    sampled.push_back(edge.is_on_loop ? std::optional<Sampled>(edge.piece) : std::nullopt);
  std::vector<bool> is_out(edges.size(), false);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size() && !is_out[i]; ++j) {
      if (!sampled[i] || !sampled[j] || is_out[j]) continue;
      const Relation found = relation(edges[i].piece, *sampled[i], edges[j].piece, *sampled[j], distance);
      if (found == Relation::none) continue;
      is_out[j] = true;
      if (found == Relation::same) continue;
      is_out[i] = true;
      if (!edges[i].is_of_coplanar_face && !edges[j].is_of_coplanar_face) touching.push_back(edges[i].piece);
    }
  }
  std::vector<SectionEdge> result;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!is_out[i]) result.push_back(std::move(edges[i]));
  return result;
}

}  // namespace isorim::geometry
