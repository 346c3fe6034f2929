#include "geometry/topology/enclosed_volume.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

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

struct VolumeAndArea {
  double volume = 0.0;
  double area = 0.0;
};

VolumeAndArea& operator+=(VolumeAndArea& sum, const VolumeAndArea& part) {
  sum.volume += part.volume;
  sum.area += part.area;
  return sum;
}

/// The triangle's cone from the origin.
VolumeAndArea cone(const Point3& a, const Point3& b, const Point3& c) {
  return {a.dot(b.cross(c)) / 6.0, 0.5 * (b - a).cross(c - a).norm()};
}

VolumeAndArea sample_volume(const SurfacePiece& piece, const Point3& origin, int divisions) {
  std::vector<Point3> points;
  for (int j = 0; j <= divisions; ++j) {
    for (int i = 0; i <= divisions; ++i) {
      const double step = 1.0 / divisions;
      points.push_back(evaluate(piece, i * step, j * step) - origin);
    }
  }
  VolumeAndArea sum;
  const int row = divisions + 1;
  for (int j = 0; j < divisions; ++j) {
    for (int i = 0; i < divisions; ++i) {
      const Point3* corner = points.data() + i + j * row;
      sum += cone(corner[0], corner[1], corner[row + 1]);
      sum += cone(corner[0], corner[row + 1], corner[row]);
    }
  }
  sum.volume *= piece.orientation;
  return sum;
}

/// Solid angle of the triangle seen from the origin.
double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), denominator);
}

/// The solid angle of a piece; empty if the point is too near. `ratio` bounds size over distance of what counts as
/// flat.
std::optional<double> solid_angle(const SurfacePiece& piece, const Point3& point, double ratio, double resolution) {
  const Vector3 outside = (piece.lower - point).cwiseMax(point - piece.upper).cwiseMax(0.0);
  if (piece.diagonal() <= ratio * outside.norm()) {
    const Vector3 a = piece.corner(0, 0) - point;
    const Vector3 b = piece.corner(1, 0) - point;
    const Vector3 c = piece.corner(1, 1) - point;
    const Vector3 d = piece.corner(0, 1) - point;
    return piece.orientation * (solid_angle(a, b, c) + solid_angle(a, c, d));
  }
  if (piece.diagonal() <= resolution) return std::nullopt;
  double sum = 0.0;
  for (const SurfacePiece& part : quarter(piece)) {
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

Point3 SurfacePiece::corner(int i, int j) const {
  const Eigen::Index column = i * degree_u + j * degree_v * (degree_u + 1);
  return net.col(column).head<3>() / net(3, column);
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

std::vector<SurfacePiece> quarter(const SurfacePiece& piece) {
  const Eigen::Index count_u = piece.degree_u + 1;
  const Eigen::Index count_v = piece.degree_v + 1;
  const auto [left, right] = halve(piece.net, count_u);
  std::vector<SurfacePiece> parts;
  for (const HomogeneousPoints<3>* half : {&left, &right}) {
    const auto [low, high] = halve(transposed(*half, count_u), count_v);
    for (const HomogeneousPoints<3>* part : {&low, &high}) {
      parts.emplace_back(transposed(*part, count_v), piece.degree_u, piece.degree_v, piece.orientation);
    }
  }
  return parts;
}

std::optional<int> volume_sign(std::span<const SurfacePiece> shell, double thickness) {
  constexpr int finest = 64;
  const Point3 origin = shell.front().lower;
  VolumeAndArea sum;
  double change = 0.0;
  for (int divisions = 1; divisions <= finest; divisions *= 2) {
    const double previous = sum.volume;
    sum = {};
    for (const SurfacePiece& piece : shell) sum += sample_volume(piece, origin, divisions);
    change = std::abs(sum.volume - previous);
    if (divisions >= 4 && change <= 0.1 * std::abs(sum.volume) && std::abs(sum.volume) > thickness * sum.area) break;
  }
  if (std::abs(sum.volume) <= thickness * sum.area || change > 0.5 * std::abs(sum.volume)) return std::nullopt;
  return sum.volume > 0.0 ? 1 : -1;
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
