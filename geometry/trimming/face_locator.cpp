#include "geometry/trimming/face_locator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/bezier/bernstein_roots.h"
#include "geometry/errors.h"
#include "geometry/trimming/loop_pieces.h"

namespace isorim::geometry {
namespace {

/// What is nearer to a curve in the unit square cannot be told from being on it.
constexpr double unit_rounding = 1e-14;

}  // namespace

FaceLocator::FaceLocator(const TrimmedSurface& face) {
  build(loop_pieces(face.loops()));
}

FaceLocator::FaceLocator(std::span<const TrimLoop> loops) {
  build(loop_pieces(loops));
}

void FaceLocator::build(std::vector<PlanePiece> pieces) {
  if (pieces.empty()) throw GeometryError("the loops are single points");
  Point2 lower = pieces.front().lower;
  Point2 upper = pieces.front().upper;
  for (const PlanePiece& piece : pieces) {
    lower = lower.cwiseMin(piece.lower);
    upper = upper.cwiseMax(piece.upper);
  }
  corner_ = lower;
  size_ = upper - lower;
  if (!(size_.minCoeff() > 0.0)) throw GeometryError("the loops lie on a line of constant parameter");
  pieces_.reserve(pieces.size());
  for (PlanePiece& piece : pieces) {
    HomogeneousPoints<2> net = std::move(piece.net);
    for (Eigen::Index d = 0; d < 2; ++d) net.row(d) = (net.row(d) - corner_[d] * net.row(2)) / size_[d];
    pieces_.emplace_back(std::move(net));
  }
}

std::optional<int> FaceLocator::winding_number(const Point2& uv, double resolution) const {
  return geometry::winding_number(pieces_, (uv - corner_).cwiseQuotient(size_), resolution);
}

std::optional<bool> FaceLocator::contains(const Point2& uv, double resolution) const {
  const std::optional<int> turns = winding_number(uv, resolution);
  if (!turns) return std::nullopt;
  return *turns > 0;
}

/// Where the line on which the other coordinate is `level` meets the loops: values of coordinate `direction`,
/// increasing.
std::vector<double> FaceLocator::crossings(Eigen::Index direction, double level) const {
  const Eigen::Index across = 1 - direction;
  std::vector<double> places;
  std::vector<double> coefficients;
  std::vector<double> tolerances;
  for (const PlanePiece& piece : pieces_) {
    if (piece.lower[across] > level + unit_rounding || piece.upper[across] < level - unit_rounding) continue;
    coefficients.clear();
    tolerances.clear();
    for (Eigen::Index i = 0; i < piece.net.cols(); ++i) {
      coefficients.push_back(piece.net(across, i) - piece.net(2, i) * level);
      tolerances.push_back(piece.net(2, i) * unit_rounding);
    }
    for (const Interval& root : bernstein_roots(coefficients, tolerances)) {
      places.push_back(evaluate(piece, root.first)[direction]);
      if (root.last > root.first) places.push_back(evaluate(piece, root.last)[direction]);
    }
  }
  std::ranges::sort(places);
  return places;
}

/// The stretch of the line through a point in one direction on which no loop is met.
std::optional<Interval> FaceLocator::kept_interval(Eigen::Index direction, const Point2& through) const {
  const std::vector<double> places = crossings(direction, through[1 - direction]);
  const auto above = std::ranges::upper_bound(places, through[direction]);
  if (above == places.begin() || above == places.end()) return std::nullopt;
  return Interval{*(above - 1), *above};
}

/// The middle of the longest kept stretch on which v = level.
std::optional<Point2> FaceLocator::longest_on_level(double level) const {
  const std::vector<double> places = crossings(0, level);
  std::vector<Interval> stretches;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) stretches.push_back({places[i], places[i + 1]});
  std::ranges::sort(stretches, std::greater<>(), &Interval::length);
  for (const Interval& stretch : stretches) {
    const Point2 middle(stretch.middle(), level);
    const std::optional<int> turns = geometry::winding_number(pieces_, middle, unit_rounding);
    if (turns && *turns > 0) return middle;
  }
  return std::nullopt;
}

/// About the distance from the loops of a point that the stretches through it are the kept ones of.
double FaceLocator::clearance(const Point2& point, Interval in_u, Interval in_v) const {
  constexpr int samples = 8;
  double least =
      std::min({point.x() - in_u.first, in_u.last - point.x(), point.y() - in_v.first, in_v.last - point.y()});
  for (const PlanePiece& piece : pieces_) {
    if ((point.array() < piece.lower.array() - least || point.array() > piece.upper.array() + least).any()) continue;
    for (int k = 0; k < samples; ++k) least = std::min(least, (evaluate(piece, (k + 0.5) / samples) - point).norm());
  }
  return least;
}

std::optional<Point2> FaceLocator::best_of_levels(int count) const {
  std::optional<Point2> best;
  double best_distance = 0.0;
  for (int k = 0; k < count; ++k) {
    std::optional<Point2> candidate = longest_on_level((k + 0.5) / count);
    if (!candidate) continue;
    for (int round = 0; round < 2; ++round)
      for (Eigen::Index direction : {1, 0})
        if (const std::optional<Interval> kept = kept_interval(direction, *candidate))
          (*candidate)[direction] = kept->middle();
    const std::optional<Interval> in_u = kept_interval(0, *candidate);
    const std::optional<Interval> in_v = kept_interval(1, *candidate);
    if (!in_u || !in_v) continue;
    const double distance = clearance(*candidate, *in_u, *in_v);
    const std::optional<int> turns = geometry::winding_number(pieces_, *candidate, unit_rounding);
    if (distance <= best_distance || !turns || *turns <= 0) continue;
    best = candidate;
    best_distance = distance;
  }
  return best;
}

Point2 FaceLocator::interior_point() const {
  constexpr int most_levels = 4000;
  for (int count = 7; count < most_levels; count = 5 * count + 2)
    if (const std::optional<Point2> found = best_of_levels(count)) return corner_ + size_.cwiseProduct(*found);
  throw GeometryError("the loops enclose nothing in which a point could be found");
}

std::optional<bool> contains(const TrimmedSurface& face, const Point2& uv) {
  return FaceLocator(face).contains(uv);
}

Point2 interior_point(const TrimmedSurface& face) {
  return FaceLocator(face).interior_point();
}

}  // namespace isorim::geometry
