#include "geometry/shapes/star_kernel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isorim::geometry {
namespace {

/// The points x with normal.x <= offset.
struct HalfPlane {
  Vector2 normal;
  double offset = 0.0;
};

double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 0; i < k; ++i) value = value * (n - i) / (i + 1);
  return value;
}

/// Bernstein coefficients (degree 2 p - 1) of f g' - g f' for two rows of a net of degree p.
Eigen::VectorXd wronskian(const Eigen::RowVectorXd& f, const Eigen::RowVectorXd& g) {
  const int p = static_cast<int>(f.size()) - 1;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(2 * p);
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j < p; ++j) {
      const double factor = p * binomial(p, i) * binomial(p - 1, j) / binomial(2 * p - 1, i + j);
      result(i + j) += factor * (f(i) * (g(j + 1) - g(j)) - g(i) * (f(j + 1) - f(j)));
    }
  }
  return result;
}

/// With homogeneous (X, Y, W) and the apex a, the sign of (C - a) x C' is that of
/// (X Y' - Y X') - a_x (W Y' - Y W') - a_y (X W' - W X').
void append_half_planes(const PlanePiece& piece, const Point2& origin, std::vector<HalfPlane>& planes) {
  const Eigen::RowVectorXd w = piece.net.row(2);
  const Eigen::RowVectorXd x = piece.net.row(0) - origin.x() * w;
  const Eigen::RowVectorXd y = piece.net.row(1) - origin.y() * w;
  const Eigen::VectorXd constant = wronskian(x, y);
  const Eigen::VectorXd along_x = wronskian(w, y);
  const Eigen::VectorXd along_y = wronskian(x, w);
  const double scale = w.maxCoeff() * w.maxCoeff() * piece.diagonal();
  for (Eigen::Index k = 0; k < constant.size(); ++k) {
    const Vector2 normal(along_x(k), along_y(k));
    const double length = normal.norm();
    // A stretch of zero speed (doubled control points) asks for nothing.
    if (length <= 1e-12 * scale) continue;
    planes.push_back({normal / length, constant(k) / length});
  }
}

/// Sutherland & Hodgman: the convex polygon cut by a half-plane.
std::vector<Point2> clip(const std::vector<Point2>& polygon, const HalfPlane& plane) {
  std::vector<Point2> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2& a = polygon[i];
    const Point2& b = polygon[(i + 1) % polygon.size()];
    const double da = plane.normal.dot(a) - plane.offset;
    const double db = plane.normal.dot(b) - plane.offset;
    if (da <= 0.0) result.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) result.push_back(a + (b - a) * (da / (da - db)));
  }
  return result;
}

}  // namespace

std::optional<Point2> kernel_point(std::span<const PlanePiece> loop) {
  Point2 lower = loop.front().lower;
  Point2 upper = loop.front().upper;
  for (const PlanePiece& piece : loop) {
    lower = lower.cwiseMin(piece.lower);
    upper = upper.cwiseMax(piece.upper);
  }
  const Point2 origin = 0.5 * (lower + upper);
  std::vector<HalfPlane> planes;
  for (const PlanePiece& piece : loop) append_half_planes(piece, origin, planes);

  const Vector2 half = 0.5 * (upper - lower);
  std::vector<Point2> kernel{-half, {half.x(), -half.y()}, half, {-half.x(), half.y()}};
  for (const HalfPlane& plane : planes) {
    kernel = clip(kernel, plane);
    if (kernel.size() < 3) return std::nullopt;
  }
  double area = 0.0;
  Vector2 moment = Vector2::Zero();
  for (std::size_t i = 1; i + 1 < kernel.size(); ++i) {
    const Vector2 a = kernel[i] - kernel[0];
    const Vector2 b = kernel[i + 1] - kernel[0];
    const double triangle = a.x() * b.y() - a.y() * b.x();
    area += triangle;
    moment += triangle / 3.0 * (a + b);
  }
  if (area <= 1e-6 * half.prod()) return std::nullopt;
  return origin + kernel[0] + moment / area;
}

bool is_visible_from(const PlanePiece& piece, const Point2& apex) {
  std::vector<HalfPlane> planes;
  append_half_planes(piece, apex, planes);
  return std::ranges::all_of(planes, [&](const HalfPlane& plane) { return plane.offset >= -1e-13 * piece.diagonal(); });
}

}  // namespace isorim::geometry
