#include "solver/hydrostatics/wetted_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "quadrature/adaptive.h"
#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::solver {
namespace {

using geometry::Point3;
using geometry::Vector3;
using quadrature::ElementPiece;
using quadrature::Orders;
using Layout = WettedLayout;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Differences of two rules below this, relative to area times distance, are rounding.
constexpr double difference_noise = 4.0 * epsilon;

/// y relative to x0, n the normal with the rule's weight.
void add_point(const Vector3& y, const Vector3& n, double area, WettedArray& sums) {
  sums[Layout::area] += area;
  sums.segment<3>(Layout::normal) += n.array();
  constexpr std::array<std::pair<int, int>, 6> products{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  for (int i = 0; i < 3; ++i) sums.segment<3>(Layout::first + 3 * i) += y[i] * n.array();
  for (int k = 0; k < 6; ++k) {
    const auto [a, b] = products[static_cast<std::size_t>(k)];
    sums.segment<3>(Layout::second + 3 * k) += y[a] * y[b] * n.array();
  }
}

/// A piece at the nodes of a tensor rule, one row of nodes after the other.
class NodeWalker {
 public:
  NodeWalker(const ElementPiece<3>& piece, const Orders<2>& nodes)
      : piece_(piece),
        nodes_(nodes),
        u_(quadrature::bernstein_table(piece.element->degree[0], nodes[0])),
        v_(quadrature::bernstein_table(piece.element->degree[1], nodes[1])),
        rows_(static_cast<std::size_t>(piece.element->degree[1] + 1)) {}

  /// body(a, b, position, S_u x S_v).
  template <class Body>
  void walk(Body body) {
    for (int a = 0; a < nodes_[0]; ++a) {
      contract(a);
      for (int b = 0; b < nodes_[1]; ++b) {
        Eigen::Vector4d point = Eigen::Vector4d::Zero();
        Eigen::Vector4d du = Eigen::Vector4d::Zero();
        Eigen::Vector4d dv = Eigen::Vector4d::Zero();
        for (std::size_t j = 0; j < rows_.size(); ++j) {
          point += v_.values_at(b)[j] * rows_[j].first;
          du += v_.values_at(b)[j] * rows_[j].second;
          dv += v_.derivatives_at(b)[j] * rows_[j].first;
        }
        const double w = point[3];
        const Point3 x = point.head<3>() / w;
        const Vector3 s_u = (du.head<3>() - du[3] * x) / w;
        const Vector3 s_v = (dv.head<3>() - dv[3] * x) / w;
        body(a, b, x, s_u.cross(s_v));
      }
    }
  }

 private:
  /// The net's rows at the node a of u: values and derivatives.
  void contract(int a) {
    const int columns = piece_.element->degree[0] + 1;
    const Eigen::Map<const Eigen::Matrix4Xd> net(piece_.net(), 4, columns * static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      rows_[j] = {Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
      for (int i = 0; i < columns; ++i) {
        const auto column = net.col(static_cast<Eigen::Index>(j) * columns + i);
        rows_[j].first += u_.values_at(a)[i] * column;
        rows_[j].second += u_.derivatives_at(a)[i] * column;
      }
    }
  }

  const ElementPiece<3>& piece_;
  Orders<2> nodes_;
  const quadrature::BernsteinTable& u_;
  const quadrature::BernsteinTable& v_;
  std::vector<std::pair<Eigen::Vector4d, Eigen::Vector4d>> rows_;
};

/// One rule; a cut piece has moments with enough counts after that.
WettedArray apply_rule(const ElementPiece<3>& piece, const Point3& x0, const Orders<2>& orders) {
  const Orders<2> nodes = quadrature::nodes_of_rule(piece, orders);
  static thread_local std::vector<double> weights;
  if (piece.is_cut()) quadrature::region_weights(piece.region->moments(nodes), nodes, weights);
  const std::vector<double>& w_u = quadrature::gauss_legendre(nodes[0]).weights;
  const std::vector<double>& w_v = quadrature::gauss_legendre(nodes[1]).weights;
  const double orientation = piece.element->orientation;
  WettedArray sums = WettedArray::Zero();
  NodeWalker(piece, nodes).walk([&](int a, int b, const Point3& x, const Vector3& area_vector) {
    const double weight = piece.is_cut() ? weights[static_cast<std::size_t>(a + b * nodes[0])]
                                         : w_u[static_cast<std::size_t>(a)] * w_v[static_cast<std::size_t>(b)];
    add_point(x - x0, orientation * weight * area_vector, weight * area_vector.norm(), sums);
  });
  return sums;
}

/// On an element with unit weights of degree p the products have degree 4 p - 1 in each direction.
Orders<2> exact_orders(const ElementPiece<3>& piece) {
  return {2 * piece.element->degree[0], 2 * piece.element->degree[1]};
}

int power_of_distance(int k) {
  return k < Layout::first ? 0 : k < Layout::second ? 1 : 2;
}

/// The diagonal of the box of the control points.
double diagonal(const ElementPiece<3>& piece) {
  const int count = piece.element->control_point_count();
  const Eigen::Map<const Eigen::Matrix4Xd> net(piece.net(), 4, count);
  const Eigen::Matrix3Xd points = net.colwise().hnormalized();
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

class WettedEvaluator {
 public:
  using Piece = ElementPiece<3>;
  using Values = WettedArray;
  static constexpr int directions = 2;
  static constexpr int batch_size = 1;

  WettedEvaluator(const Point3& x0, const WettedScales& scales, WettedScope scope, double tolerance)
      : x0_(x0), scales_(scales), tolerance_(tolerance) {
    // Volume and first moments of slender bodies are far smaller than area times distance.
    target_.segment<3>(Layout::normal).fill(tolerance * scales.area);
    target_.segment<9>(Layout::first).fill(tolerance * scales.volume);
    target_.segment<18>(Layout::second).fill(tolerance * scales.volume * scales.volume / scales.area);
    target_[Layout::area] =
        scope == WettedScope::moments ? std::numeric_limits<double>::max() : tolerance * scales.area;
  }

  Orders<2> start_orders(const Piece& piece) const {
    return piece.element->polynomial ? exact_orders(piece) : quadrature::expected_orders(piece, tolerance_);
  }
  bool same_kind(const Piece& /*a*/, const Piece& /*b*/) const { return false; }
  void evaluate(std::span<const Piece* const> pieces, const Orders<2>& orders, std::span<Values> values) const {
    values.front() = apply_rule(*pieces.front(), x0_, orders);
  }
  std::int64_t points(const Piece& piece, const Orders<2>& orders) const {
    return quadrature::points_of_rule(piece, orders);
  }
  std::pair<Piece, Piece> split(const Piece& piece, int direction) const { return bisect(piece, direction); }

  /// What rounding is relative to: the area times powers of the distance; more for a body that lies far from the
  /// origin of its coordinates.
  Values magnitude(const Piece& piece, const Values& value) const {
    const double distance = std::max(1.0, scales_.coordinate / scales_.radius);
    return powers_of_distance(amplification(piece) * distance * std::abs(value[Layout::area]));
  }
  /// Rounding of the control points turns the tangents of a small piece, so its area is known to a rounding of the
  /// coordinates times its size.
  Values noise(const Piece& piece, const Values& value) const {
    const int degree = std::max(piece.element->degree[0], piece.element->degree[1]);
    const double tangents = amplification(piece) * degree * scales_.coordinate * diagonal(piece);
    return (difference_noise * (magnitude(piece, value) + powers_of_distance(tangents)))
        .max(std::numeric_limits<double>::min());
  }
  /// Half of the target is shared out by area, half equally among elements and their halves.
  Values allowance(const Piece& piece, const Values& value) const {
    const double share = 0.5 * std::ldexp(1.0 / static_cast<double>(scales_.elements), -piece.depth) +
                         0.5 * std::max(0.0, value[Layout::area]) / scales_.area;
    return (target_ * share).max(noise(piece, value));
  }
  void clear_exact(const Piece& piece, const Orders<2>& orders, Values& difference) const {
    if (!piece.element->polynomial) return;
    const Orders<2> exact = exact_orders(piece);
    if (orders[0] >= exact[0] && orders[1] >= exact[1]) difference.tail<Layout::count - 1>().setZero();
  }

 private:
  Values powers_of_distance(double area) const {
    Values result;
    for (int k = 0; k < Layout::count; ++k) result[k] = area * std::pow(scales_.radius, power_of_distance(k));
    return result;
  }
  /// A piece that has been evaluated: see RegionMoments.
  static double amplification(const Piece& piece) {
    return piece.is_cut() ? piece.region->moments({}).amplification() : 1.0;
  }

  Point3 x0_;
  const WettedScales& scales_;
  double tolerance_;
  Values target_;
};

}  // namespace

WettedSums& WettedSums::operator+=(const WettedSums& other) {
  value += other.value;
  error += other.error;
  magnitude += other.magnitude;
  evaluations += other.evaluations;
  unfinished += other.unfinished;
  return *this;
}

WettedSums integrate_piece(const ElementPiece<3>& piece, const Point3& x0, const WettedScales& scales,
                           WettedScope scope, double tolerance) {
  if (piece.empty()) return {};
  const WettedEvaluator evaluator(x0, scales, scope, tolerance);
  if (piece.element->polynomial && scope == WettedScope::moments) {
    const Orders<2> orders = exact_orders(piece);
    WettedSums sums;
    sums.value = apply_rule(piece, x0, orders);
    sums.magnitude = evaluator.magnitude(piece, sums.value);
    sums.evaluations = evaluator.points(piece, orders);
    return sums;
  }
  constexpr std::int64_t most_bisections = 400;
  quadrature::Options options;
  options.tolerance = tolerance;
  const auto totals = quadrature::AdaptiveIntegrator(evaluator, options, most_bisections).integrate({piece});
  return {totals.sum, totals.error, totals.magnitude, totals.evaluations, totals.unfinished};
}

WettedArray rough_integrals(const ElementPiece<3>& piece, const Point3& x0) {
  constexpr int low_order = 3;
  return piece.empty() ? WettedArray(WettedArray::Zero()) : apply_rule(piece, x0, {low_order, low_order});
}

}  // namespace isorim::solver
