#include "geometry/topology/enclosed_volume.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/intersection/plane_pieces.h"

namespace isorim::geometry {
namespace {

/// Halves a net in its first parameter (de Casteljau at 1/2); `count_u` columns a row.
std::pair<HomogeneousPoints<3>, HomogeneousPoints<3>> halve(const HomogeneousPoints<3>& net, Eigen::Index count_u) {
  HomogeneousPoints<3> left(4, net.cols());
  HomogeneousPoints<3> right(4, net.cols());
  for (Eigen::Index row = 0; row < net.cols(); row += count_u) {
    HomogeneousPoints<3> points = net.middleCols(row, count_u);
    for (Eigen::Index last = count_u - 1; last >= 0; --last) {
      left.col(row + count_u - 1 - last) = points.col(0);
      right.col(row + last) = points.col(last);
      for (Eigen::Index i = 0; i < last; ++i) points.col(i) = 0.5 * (points.col(i) + points.col(i + 1)).eval();
    }
  }
  return {std::move(left), std::move(right)};
}

HomogeneousPoints<3> transposed(const HomogeneousPoints<3>& net, Eigen::Index count_u) {
  const Eigen::Index count_v = net.cols() / count_u;
  HomogeneousPoints<3> result(4, net.cols());
  for (Eigen::Index i = 0; i < count_u; ++i) {
    for (Eigen::Index j = 0; j < count_v; ++j) result.col(j + i * count_v) = net.col(i + j * count_u);
  }
  return result;
}

/// Solid angle of the triangle seen from the origin.
double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), denominator);
}

Point3 corner(const SurfacePiece& piece, int i, int j) {
  const Eigen::Index column = i * piece.degree_u + j * piece.degree_v * (piece.degree_u + 1);
  return piece.net.col(column).head<3>() / piece.net(3, column);
}

/// Chords of the region's curves.
std::vector<CellChord> outline_of(const TrimmedRegion& region) {
  std::vector<CellChord> chords;
  for (const HomogeneousPoints<2>& curve : region.curves) {
    const PlanePiece piece(curve);
    // Straight in the parameters is not straight in space.
    const int parts = curve.cols() == 2 ? 4 : 16;
    Point2 from = piece.start();
    for (int k = 1; k <= parts; ++k) {
      const Point2 to = k == parts ? piece.end() : evaluate(piece, static_cast<double>(k) / parts);
      chords.push_back({from, to});
      from = to;
    }
  }
  return chords;
}

/// The chords with what lies beyond `limit` in one coordinate (below it for side = -1, above it for side = +1) moved
/// onto the limit: the outline of what is left of the region there.
std::vector<CellChord> clamped(const std::vector<CellChord>& chords, int axis, double limit, int side) {
  std::vector<CellChord> result;
  const auto beyond = [&](const Point2& point) { return side * (point[axis] - limit) > 0.0; };
  const auto move = [&](Point2 point) {
    if (beyond(point)) point[axis] = limit;
    return point;
  };
  for (const CellChord& chord : chords) {
    if (beyond(chord.from) == beyond(chord.to)) {
      result.push_back({move(chord.from), move(chord.to)});
      continue;
    }
    const double s = (limit - chord.from[axis]) / (chord.to[axis] - chord.from[axis]);
    Point2 crossing = chord.from + s * (chord.to - chord.from);
    crossing[axis] = limit;
    result.push_back({move(chord.from), crossing});
    result.push_back({crossing, move(chord.to)});
  }
  std::erase_if(result, [](const CellChord& chord) { return chord.from == chord.to; });
  return result;
}

double area(const std::vector<CellChord>& chords) {
  double sum = 0.0;
  for (const CellChord& chord : chords) sum += 0.5 * (chord.from.x() * chord.to.y() - chord.from.y() * chord.to.x());
  return sum;
}

/// The chords over a quarter of the cell, in the coordinates of that quarter's own cell.
std::vector<CellChord> over_quarter(const std::vector<CellChord>& chords, int i, int j) {
  std::vector<CellChord> part = clamped(clamped(chords, 0, 0.5, i == 0 ? 1 : -1), 1, 0.5, j == 0 ? 1 : -1);
  const Vector2 shift(i, j);
  for (CellChord& chord : part) chord = {2.0 * chord.from - shift, 2.0 * chord.to - shift};
  return part;
}

/// The quarters of a piece that hold some of what is kept.
std::vector<SurfacePiece> quarters(const SurfacePiece& piece) {
  const Eigen::Index count_u = piece.degree_u + 1;
  const Eigen::Index count_v = piece.degree_v + 1;
  const std::vector<CellChord> outline = piece.region != nullptr ? outline_of(*piece.region) : piece.outline;
  const auto [left, right] = halve(piece.net, count_u);
  std::vector<SurfacePiece> parts;
  for (int i = 0; i < 2; ++i) {
    const auto [low, high] = halve(transposed(i == 0 ? left : right, count_u), count_v);
    for (int j = 0; j < 2; ++j) {
      SurfacePiece part(transposed(j == 0 ? low : high, count_v), piece.degree_u, piece.degree_v, piece.orientation);
      if (piece.is_cut()) {
        constexpr double nothing = 1e-12;
        part.outline = over_quarter(outline, i, j);
        const double kept = area(part.outline);
        if (kept < nothing) continue;
        if (kept > 1.0 - nothing) part.outline.clear();
      }
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

/// The solid angle of a piece small against its distance.
double flat_solid_angle(const SurfacePiece& piece, const Point3& point) {
  if (!piece.is_cut()) {
    const Vector3 a = corner(piece, 0, 0) - point;
    const Vector3 b = corner(piece, 1, 0) - point;
    const Vector3 c = corner(piece, 1, 1) - point;
    const Vector3 d = corner(piece, 0, 1) - point;
    return piece.orientation * (solid_angle(a, b, c) + solid_angle(a, c, d));
  }
  const std::vector<CellChord>& own = piece.outline;
  const std::vector<CellChord> outline = piece.region != nullptr ? outline_of(*piece.region) : own;
  const Vector3 apex = evaluate(piece, 0.5, 0.5) - point;
  double sum = 0.0;
  for (const CellChord& chord : outline) {
    const Vector3 from = evaluate(piece, chord.from.x(), chord.from.y()) - point;
    const Vector3 to = evaluate(piece, chord.to.x(), chord.to.y()) - point;
    sum += solid_angle(apex, from, to);
  }
  return piece.orientation * sum;
}

/// The solid angle of a piece; empty if the point is too near. `ratio` bounds size over distance of what counts as
/// flat.
std::optional<double> solid_angle(const SurfacePiece& piece, const Point3& point, double ratio, double resolution) {
  const Vector3 outside = (piece.lower - point).cwiseMax(point - piece.upper).cwiseMax(0.0);
  if (piece.diagonal() <= ratio * outside.norm()) return flat_solid_angle(piece, point);
  if (piece.diagonal() <= resolution) return std::nullopt;
  double sum = 0.0;
  for (const SurfacePiece& part : quarters(piece)) {
    const std::optional<double> angle = solid_angle(part, point, ratio, resolution);
    if (!angle) return std::nullopt;
    sum += *angle;
  }
  return sum;
}

}  // namespace

SurfacePiece::SurfacePiece(HomogeneousPoints<3> homogeneous, int p, int q, int sign)
    : net(std::move(homogeneous)), degree_u(p), degree_v(q), orientation(sign) {
  lower = upper = net.col(0).head<3>() / net(3, 0);
  for (Eigen::Index i = 1; i < net.cols(); ++i) {
    const Point3 point = net.col(i).head<3>() / net(3, i);
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
}

SurfacePiece surface_piece(const ElementTable<3>& table, const BezierElement<3>& element, int sign) {
  SurfacePiece piece(table.net_matrix(element), element.degree[0], element.degree[1], sign * element.orientation);
  if (element.is_cut()) piece.region = &table.regions[static_cast<std::size_t>(element.region)];
  return piece;
}

Point3 evaluate(const SurfacePiece& piece, double s, double t) {
  const auto collapse = [](HomogeneousPoints<3> points, double at) -> Eigen::Vector4d {
    for (Eigen::Index last = points.cols() - 1; last > 0; --last) {
      for (Eigen::Index i = 0; i < last; ++i) points.col(i) = (1.0 - at) * points.col(i) + at * points.col(i + 1);
    }
    return points.col(0);
  };
  HomogeneousPoints<3> across(4, piece.degree_v + 1);
  for (int j = 0; j <= piece.degree_v; ++j) {
    across.col(j) = collapse(piece.net.middleCols(j * (piece.degree_u + 1), piece.degree_u + 1), s);
  }
  const Eigen::Vector4d point = collapse(std::move(across), t);
  return point.head<3>() / point(3);
}

Point3 probe_point(const SurfacePiece& piece) {
  if (piece.region == nullptr) return evaluate(piece, 0.4142, 0.5858);
  const std::vector<HomogeneousPoints<2>>& curves = piece.region->curves;
  const Point2 place = evaluate(PlanePiece(curves[curves.size() / 2]), 0.4142);
  return evaluate(piece, place.x(), place.y());
}

std::optional<int> winding_number(std::span<const SurfacePiece> shell, const Point3& point, double resolution) {
  for (const double ratio : {1.0, 0.5, 0.25, 0.125}) {
    double sum = 0.0;
    for (const SurfacePiece& piece : shell) {
      const std::optional<double> angle = solid_angle(piece, point, ratio, resolution);
      if (!angle) return std::nullopt;
      sum += *angle;
    }
    const double turns = sum / (4.0 * std::numbers::pi);
    if (std::abs(turns - std::round(turns)) < 0.1) return static_cast<int>(std::lround(turns));
  }
  return std::nullopt;
}

}  // namespace isorim::geometry
