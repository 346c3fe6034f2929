#include "geometry/intersection/plane_pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace isorim::geometry {
namespace {

double cross(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool turns_little(const PlanePiece& piece) {
  const Vector2 chord = piece.end() - piece.start();
  for (Eigen::Index i = 0; i + 1 < piece.net.cols(); ++i) {
    const Vector2 leg = piece.control_point(i + 1) - piece.control_point(i);
    if (leg.dot(chord) < 0.5 * leg.norm() * chord.norm()) return false;
  }
  return chord.norm() > 0.0;
}

/// Lowest and highest of the control points along a direction.
Interval extent(const PlanePiece& piece, const Vector2& direction) {
  Interval range{direction.dot(piece.start()), direction.dot(piece.start())};
  for (Eigen::Index i = 1; i < piece.net.cols(); ++i) {
    const double x = direction.dot(piece.control_point(i));
    range.first = std::min(range.first, x);
    range.last = std::max(range.last, x);
  }
  return range;
}

bool separated_across_chord(const PlanePiece& a, const PlanePiece& b, double distance) {
  const Vector2 chord = a.end() - a.start();
  const double length = chord.norm();
  if (length == 0.0) return false;
  const Vector2 normal = Vector2(-chord.y(), chord.x()) / length;
  const Interval range_a = extent(a, normal);
  const Interval range_b = extent(b, normal);
  return range_a.first > range_b.last + distance || range_b.first > range_a.last + distance;
}

/// The curve lies within the control polygon's height of its chord and within its box.
AreaEstimate one_piece_area(const PlanePiece& piece, const Point2& origin) {
  const Vector2 chord = piece.end() - piece.start();
  double height = 0.0;
  for (Eigen::Index i = 0; i < piece.net.cols(); ++i) {
    height = std::max(height, std::abs(cross(chord, piece.control_point(i) - piece.start())));
  }
  const double length = chord.norm();
  const double rise = length > 0.0 ? height / length : piece.diagonal();
  return {cross(piece.start() - origin, piece.end() - origin), 4.0 * rise * piece.diagonal()};
}

AreaEstimate piece_area(const PlanePiece& piece, const Point2& origin, int depth) {
  const AreaEstimate whole = one_piece_area(piece, origin);
  if (depth == 0 || whole.bound == 0.0) return whole;
  const auto [first, second] = bisect(piece);
  const AreaEstimate a = piece_area(first, origin, depth - 1);
  const AreaEstimate b = piece_area(second, origin, depth - 1);
  return {a.value + b.value, a.bound + b.bound};
}

/// The angle that the piece subtends at the point, or nothing if the point is too near.
std::optional<double> subtended_angle(const PlanePiece& piece, const Point2& point, double resolution) {
  const Vector2 first = piece.start() - point;
  if (first.norm() <= resolution || (piece.end() - point).norm() <= resolution) return std::nullopt;
  double low = 0.0;
  double high = 0.0;
  bool touches = false;
  for (Eigen::Index i = 1; i < piece.net.cols() && !touches; ++i) {
    const Vector2 ray = piece.control_point(i) - point;
    touches = ray.norm() == 0.0;
    const double angle = std::atan2(cross(first, ray), first.dot(ray));
    low = std::min(low, angle);
    high = std::max(high, angle);
  }
  if (!touches && high - low < 0.99 * std::numbers::pi) {
    const Vector2 last = piece.end() - point;
    return std::atan2(cross(first, last), first.dot(last));
  }
  if (piece.diagonal() <= resolution) return std::nullopt;
  const auto [left, right] = bisect(piece);
  const std::optional<double> a = subtended_angle(left, point, resolution);
  if (!a) return std::nullopt;
  const std::optional<double> b = subtended_angle(right, point, resolution);
  if (!b) return std::nullopt;
  return *a + *b;
}

}  // namespace

PlanePiece::PlanePiece(HomogeneousPoints<2> homogeneous) : net(std::move(homogeneous)) {
  lower = upper = start();
  for (Eigen::Index i = 1; i < net.cols(); ++i) {
    lower = lower.cwiseMin(control_point(i));
    upper = upper.cwiseMax(control_point(i));
  }
}

Point2 evaluate(const PlanePiece& piece, double s) {
  HomogeneousPoints<2> points = piece.net;
  for (Eigen::Index last = points.cols() - 1; last > 0; --last) {
    for (Eigen::Index i = 0; i < last; ++i) points.col(i) = (1.0 - s) * points.col(i) + s * points.col(i + 1);
  }
  return points.col(0).head<2>() / points(2, 0);
}

std::pair<PlanePiece, PlanePiece> bisect(const PlanePiece& piece) {
  const Eigen::Index count = piece.net.cols();
  HomogeneousPoints<2> points = piece.net;
  HomogeneousPoints<2> left(3, count);
  HomogeneousPoints<2> right(3, count);
  for (Eigen::Index last = count - 1; last >= 0; --last) {
    left.col(count - 1 - last) = points.col(0);
    right.col(last) = points.col(last);
    for (Eigen::Index i = 0; i < last; ++i) points.col(i) = 0.5 * (points.col(i) + points.col(i + 1)).eval();
  }
  return {PlanePiece(std::move(left)), PlanePiece(std::move(right))};
}

PlanePiece reverse(const PlanePiece& piece) {
  return PlanePiece(piece.net.rowwise().reverse());
}

void append_monotone_parts(const PlanePiece& piece, double smallest, std::vector<PlanePiece>& parts) {
  if (turns_little(piece) || piece.diagonal() <= smallest) {
    parts.push_back(piece);
    return;
  }
  const auto [first, second] = bisect(piece);
  append_monotone_parts(first, smallest, parts);
  append_monotone_parts(second, smallest, parts);
}

bool are_separated(const PlanePiece& a, const PlanePiece& b, double distance) {
  if (((a.lower - b.upper).array() > distance).any() || ((b.lower - a.upper).array() > distance).any()) return true;
  return separated_across_chord(a, b, distance) || separated_across_chord(b, a, distance);
}

AreaEstimate doubled_signed_area(std::span<const PlanePiece> pieces, double resolution) {
  constexpr int deepest = 12;
  const Point2 origin = pieces.front().start();
  AreaEstimate sum;
  for (int depth = 0; depth <= deepest; ++depth) {
    sum = {};
    for (const PlanePiece& piece : pieces) {
      const AreaEstimate part = piece_area(piece, origin, depth);
      sum.value += part.value;
      sum.bound += part.bound;
    }
    if (sum.bound < 0.5 * std::abs(sum.value) || sum.bound < resolution) break;
  }
  return sum;
}

std::optional<int> winding_number(std::span<const PlanePiece> pieces, const Point2& point, double resolution) {
  double turn = 0.0;
  for (const PlanePiece& piece : pieces) {
    const std::optional<double> angle = subtended_angle(piece, point, resolution);
    if (!angle) return std::nullopt;
    turn += *angle;
  }
  return static_cast<int>(std::lround(turn / (2.0 * std::numbers::pi)));
}

}  // namespace isorim::geometry
