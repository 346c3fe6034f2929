// volume_sign(): the flux of x / 3 through a shell by quadrature.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/topology/enclosed_volume.h"

namespace isorim::geometry {
namespace {

struct GaussLegendre {
  std::vector<double> nodes;
  std::vector<double> weights;
};

/// On [0, 1], by Newton's method on the Legendre recurrence.
GaussLegendre gauss_legendre(int n) {
  GaussLegendre rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int k = 0; k < 20; ++k) {
      double p0 = 1.0;
      double p1 = x;
      for (int j = 2; j <= n; ++j) {
        const double p2 = ((2.0 * j - 1.0) * x * p1 - (j - 1.0) * p0) / j;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1.0);
      x -= p1 / slope;
    }
    rule.nodes.push_back(0.5 * (1.0 - x));
    rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

/// Values and first derivatives of the Bernstein polynomials of one degree, on the stack.
using BernsteinTable = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::ColMajor, KnotVector::max_degree + 1, 2>;

/// Of degree p at s: (p + 1) x 2.
BernsteinTable bernstein(int p, double s) {
  BernsteinTable table = BernsteinTable::Zero(p + 1, 2);
  table(0, 0) = 1.0;
  for (int d = 1; d <= p; ++d) {
    if (d == p) {
      for (int i = 0; i <= p; ++i) table(i, 1) = p * ((i > 0 ? table(i - 1, 0) : 0.0) - (i < p ? table(i, 0) : 0.0));
    }
    for (int i = d; i >= 0; --i)
      table(i, 0) = (i < d ? (1.0 - s) * table(i, 0) : 0.0) + (i > 0 ? s * table(i - 1, 0) : 0.0);
  }
  return table;
}

/// Flux of x / 3, area, and the sum of what the flux was added up from.
struct Flux {
  double volume = 0.0;
  double area = 0.0;
  double magnitude = 0.0;

  Flux& operator+=(const Flux& part) {
    volume += part.volume;
    area += part.area;
    magnitude += part.magnitude;
    return *this;
  }
};

/// Per unit of the cell, times `weight`.
Flux flux_at(const SurfacePiece& piece, const Point3& origin, const BernsteinTable& u, const BernsteinTable& v,
             double weight) {
  Eigen::Matrix<double, 4, 2> along = Eigen::Matrix<double, 4, 2>::Zero();
  Eigen::Vector4d across = Eigen::Vector4d::Zero();
  for (Eigen::Index j = 0; j < v.rows(); ++j) {
    const Eigen::Matrix<double, 4, 2> row = piece.net.middleCols(j * u.rows(), u.rows()).lazyProduct(u);
    along += v(j, 0) * row;
    across += v(j, 1) * row.col(0);
  }
  const double w = along(3, 0);
  const Point3 point = along.col(0).head<3>() / w;
  const Vector3 du = (along.col(1).head<3>() - along(3, 1) * point) / w;
  const Vector3 dv = (across.head<3>() - across(3) * point) / w;
  const Vector3 normal = du.cross(dv);
  const double volume = weight * piece.orientation * (point - origin).dot(normal) / 3.0;
  return {volume, weight * normal.norm(), std::abs(volume)};
}

Flux flux_through_cell(const SurfacePiece& piece, const Point3& origin, const GaussLegendre& rule) {
  std::vector<BernsteinTable> us;
  std::vector<BernsteinTable> vs;
  for (const double node : rule.nodes) {
    us.push_back(bernstein(piece.degree_u, node));
    vs.push_back(bernstein(piece.degree_v, node));
  }
  Flux sum;
  for (std::size_t j = 0; j < vs.size(); ++j) {
    for (std::size_t i = 0; i < us.size(); ++i)
      sum += flux_at(piece, origin, us[i], vs[j], rule.weights[i] * rule.weights[j]);
  }
  return sum;
}

/// Radial integration from the cell's corner: the integral over the region is the one over its curves of what lies
/// between them and the corner, and that stays in the cell.
Flux flux_through_region(const SurfacePiece& piece, const Point3& origin, const GaussLegendre& rule) {
  Flux sum;
  for (const HomogeneousPoints<2>& curve : piece.region->curves) {
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const Eigen::Matrix<double, 3, 2> value =
          curve.lazyProduct(bernstein(static_cast<int>(curve.cols()) - 1, rule.nodes[k]));
      const Point2 place = value.col(0).head<2>() / value(2, 0);
      const Vector2 derivative = (value.col(1).head<2>() - value(2, 1) * place) / value(2, 0);
      const double swept = place.x() * derivative.y() - place.y() * derivative.x();
      if (swept == 0.0) continue;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double r = rule.nodes[i];
        const double weight = rule.weights[k] * rule.weights[i] * r * swept;
        sum += flux_at(piece, origin, bernstein(piece.degree_u, r * place.x()),
                       bernstein(piece.degree_v, r * place.y()), weight);
      }
    }
  }
  return sum;
}

}  // namespace

std::optional<int> volume_sign(std::span<const SurfacePiece> shell) {
  Point3 lower = shell.front().lower;
  Point3 upper = shell.front().upper;
  for (const SurfacePiece& piece : shell) {
    lower = lower.cwiseMin(piece.lower);
    upper = upper.cwiseMax(piece.upper);
  }
  const Point3 origin = 0.5 * (lower + upper);
  Flux previous;
  bool was_sure = false;
  for (const int n : {2, 3, 5, 8, 13, 21, 32}) {
    const GaussLegendre rule = gauss_legendre(n);
    Flux sum;
    for (const SurfacePiece& piece : shell)
      sum += piece.is_cut() ? flux_through_region(piece, origin, rule) : flux_through_cell(piece, origin, rule);
    const double volume = std::abs(sum.volume);
    const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * sum.magnitude;
    const bool is_sure = n > 2 && volume > rounding && std::abs(sum.volume - previous.volume) <= 0.1 * volume;
    const bool is_thick = volume > 0.01 * sum.area * (upper - lower).norm();
    if (is_sure && (is_thick || was_sure)) return sum.volume > 0.0 ? 1 : -1;
    was_sure = is_sure;
    previous = sum;
  }
  return std::nullopt;
}

}  // namespace isorim::geometry
