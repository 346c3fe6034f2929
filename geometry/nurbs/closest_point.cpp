#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/bezier/subdivision.h"
#include "geometry/errors.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A rational Bézier patch of degrees p x q, q = 0 for a segment of a curve, as seen from the target: homogeneous
/// points (w (x - target), w).
template <int Dim>
struct BezierPatch {
  int p = 1;
  int q = 0;
  Interval u;
  Interval v;
  HomogeneousPoints<Dim> net;
};

/// Bernstein polynomials of degree p >= 0 on [0, 1] with two derivatives: (p + 1) x 3.
LocalBasisTable<2> bernstein(int p, double s) {
  LocalBasisTable<2> table = LocalBasisTable<2>::Zero(p + 1, 3);
  table(0, 0) = 1.0;
  for (int d = 1; d <= p; ++d) {
    // Each derivative follows from the values of the degree below it.
    if (d >= p - 1)
      for (int i = d; i >= 0; --i) {
        const auto below = [&](int j, int order) { return j < 0 || j >= d ? 0.0 : table(j, order); };
        if (d == p) table(i, 2) = d * (below(i - 1, 1) - below(i, 1));
        table(i, 1) = d * (below(i - 1, 0) - below(i, 0));
      }
    for (int i = d; i >= 0; --i)
      table(i, 0) = (i < d ? (1.0 - s) * table(i, 0) : 0.0) + (i > 0 ? s * table(i - 1, 0) : 0.0);
  }
  return table;
}

/// The squared distance from the target at one point of a patch, with gradient and Hessian of its half.
struct SquaredDistance {
  double squared = 0.0;
  Eigen::Vector2d gradient;
  Eigen::Matrix2d hessian;
  /// The part of the Hessian that is never negative (Gauss-Newton).
  Eigen::Matrix2d metric;
};

template <int Dim>
SquaredDistance squared_distance(const BezierPatch<Dim>& patch, const Eigen::Vector2d& s) {
  const LocalBasisTable<2> u = bernstein(patch.p, s[0]);
  const LocalBasisTable<2> v = bernstein(patch.q, s[1]);
  std::array<Eigen::Matrix<double, Dim + 1, 3>, 3> sums;
  for (auto& sum : sums) sum.setZero();
  for (int j = 0; j <= patch.q; ++j) {
    const Eigen::Matrix<double, Dim + 1, 3> row = patch.net.middleCols(j * (patch.p + 1), patch.p + 1).lazyProduct(u);
    for (int b = 0; b < 3; ++b) sums[static_cast<std::size_t>(b)] += v(j, b) * row;
  }
  const auto a = [&](std::size_t du, std::size_t dv) -> Vector<Dim> {
    return sums[dv].col(static_cast<Eigen::Index>(du)).template head<Dim>();
  };
  const auto w = [&](std::size_t du, std::size_t dv) { return sums[dv](Dim, static_cast<Eigen::Index>(du)); };
  const double weight = w(0, 0);
  const Vector<Dim> r = a(0, 0) / weight;
  const Vector<Dim> ru = (a(1, 0) - w(1, 0) * r) / weight;
  const Vector<Dim> rv = (a(0, 1) - w(0, 1) * r) / weight;
  const Vector<Dim> ruu = (a(2, 0) - 2.0 * w(1, 0) * ru - w(2, 0) * r) / weight;
  const Vector<Dim> ruv = (a(1, 1) - w(1, 0) * rv - w(0, 1) * ru - w(1, 1) * r) / weight;
  const Vector<Dim> rvv = (a(0, 2) - 2.0 * w(0, 1) * rv - w(0, 2) * r) / weight;
  SquaredDistance result;
  result.squared = r.squaredNorm();
  result.gradient << r.dot(ru), r.dot(rv);
  result.metric << ru.dot(ru), ru.dot(rv), ru.dot(rv), rv.dot(rv);
  result.hessian << r.dot(ruu), r.dot(ruv), r.dot(ruv), r.dot(rvv);
  result.hessian += result.metric;
  return result;
}

/// A descent step from s inside the unit square.
struct Step {
  Eigen::Vector2d change = Eigen::Vector2d::Zero();
  /// Some curvature in it is the true one: close to the minimum the step may be trusted more than the distance.
  bool is_newton = false;
};

/// Newton's step where the Hessian is safely positive; elsewhere one direction at a time, by its own curvature or, if
/// that is not safely positive, by Gauss and Newton's. Parameters at a bound that the descent would leave stay fixed.
Step descent_step(const SquaredDistance& f, const Eigen::Vector2d& s) {
  // Relative to the metric: on a circle about the target the Hessian is rounding alone.
  constexpr double safely = 1e-13;
  const Eigen::Matrix2d& h = f.hessian;
  const Eigen::Matrix2d& m = f.metric;
  std::array<bool, 2> is_free{};
  std::array<bool, 2> is_convex{};
  for (int d = 0; d < 2; ++d) {
    const std::size_t i = static_cast<std::size_t>(d);
    const bool blocked = (s[d] <= 0.0 && f.gradient[d] >= 0.0) || (s[d] >= 1.0 && f.gradient[d] <= 0.0);
    is_free[i] = !blocked && m(d, d) > 0.0;
    is_convex[i] = is_free[i] && h(d, d) > safely * m(d, d);
  }
  Step step;
  step.is_newton = is_convex[0] || is_convex[1];
  const double determinant = h(0, 0) * h(1, 1) - h(0, 1) * h(0, 1);
  if (is_convex[0] && is_convex[1] && determinant > safely * m(0, 0) * m(1, 1)) {
    step.change << h(0, 1) * f.gradient[1] - h(1, 1) * f.gradient[0], h(0, 1) * f.gradient[0] - h(0, 0) * f.gradient[1];
    step.change /= determinant;
    return step;
  }
  for (int d = 0; d < 2; ++d) {
    const std::size_t i = static_cast<std::size_t>(d);
    if (is_free[i]) step.change[d] = -f.gradient[d] / (is_convex[i] ? h(d, d) : m(d, d));
  }
  return step;
}

/// A local minimum of the distance over a patch, from the start s; no control point is further away than `size`.
struct LocalMinimum {
  Eigen::Vector2d s;
  double squared = 0.0;
};

template <int Dim>
LocalMinimum descend(const BezierPatch<Dim>& patch, Eigen::Vector2d s, double size) {
  constexpr int most_steps = 50;
  // Points are known to a rounding error of this.
  const double noise = 4.0 * epsilon * size;
  SquaredDistance f = squared_distance(patch, s);
  for (int i = 0; i < most_steps; ++i) {
    const Step step = descent_step(f, s);
    double fraction = 1.0;
    Eigen::Vector2d next;
    SquaredDistance at_next;
    bool accepted = false;
    for (int halving = 0; halving < 12 && !accepted; ++halving, fraction *= 0.5) {
      next = (s + fraction * step.change).cwiseMax(0.0).cwiseMin(1.0);
      at_next = squared_distance(patch, next);
      // Near the minimum the distance no longer tells points apart, the gradient still does.
      const bool flat = step.is_newton && std::sqrt(at_next.squared) <= std::sqrt(f.squared) + noise &&
                        at_next.gradient.squaredNorm() < f.gradient.squaredNorm();
      accepted = flat || at_next.squared < f.squared * (1.0 - 4.0 * epsilon);
    }
    if (!accepted) break;
    const double moved = (next - s).cwiseAbs().maxCoeff();
    s = next;
    f = at_next;
    if (moved <= epsilon) break;
  }
  return {s, f.squared};
}

/// Bounds on the squared distance over a patch. It is the quotient of the polynomials |A|^2 and w^2 of degrees
/// 2p x 2q, so it lies between the smallest and the largest quotient of their Bernstein coefficients (those of w^2
/// are positive). The bound is exact on circles and spheres about the target, and has an error of the order of the
/// square of the patch's size elsewhere.
struct Bounds {
  double lower = 0.0;
  /// Where the smallest quotient stands in the unit square.
  Eigen::Vector2d place = Eigen::Vector2d::Constant(0.5);
  /// The quotients differ by rounding alone.
  bool is_constant = false;
  /// The direction in which the quotients vary most.
  int direction = 0;
};

/// C(n, k), k = 0..n.
Eigen::VectorXd binomials(int n) {
  Eigen::VectorXd row = Eigen::VectorXd::Ones(n + 1);
  for (int k = 1; k <= n; ++k) row[k] = row[k - 1] * (n - k + 1) / k;
  return row;
}

/// Quotients of the Bernstein coefficients, (2p + 1) x (2q + 1). The binomials of degrees 2p and 2q cancel.
template <int Dim>
Eigen::MatrixXd coefficient_quotients(const BezierPatch<Dim>& patch) {
  const Eigen::VectorXd in_u = binomials(patch.p);
  const Eigen::VectorXd in_v = binomials(patch.q);
  HomogeneousPoints<Dim> scaled = patch.net;
  for (int j = 0; j <= patch.q; ++j)
    for (int i = 0; i <= patch.p; ++i) scaled.col(i + j * (patch.p + 1)) *= in_u[i] * in_v[j];
  Eigen::MatrixXd numerator = Eigen::MatrixXd::Zero(2 * patch.p + 1, 2 * patch.q + 1);
  Eigen::MatrixXd denominator = numerator;
  for (int j = 0; j <= patch.q; ++j)
    for (int i = 0; i <= patch.p; ++i) {
      const Eigen::Matrix<double, Dim + 1, 1> a = scaled.col(i + j * (patch.p + 1));
      for (int l = 0; l <= patch.q; ++l)
        for (int k = 0; k <= patch.p; ++k) {
          const auto b = scaled.col(k + l * (patch.p + 1));
          numerator(i + k, j + l) += a.template head<Dim>().dot(b.template head<Dim>());
          denominator(i + k, j + l) += a[Dim] * b[Dim];
        }
    }
  return numerator.cwiseQuotient(denominator);
}

template <int Dim>
Bounds distance_bounds(const BezierPatch<Dim>& patch) {
  const Eigen::MatrixXd quotients = coefficient_quotients(patch);
  Bounds bounds;
  const double smallest = quotients.minCoeff();
  const double rounding = 16.0 * epsilon * quotients.cwiseAbs().maxCoeff();
  bounds.lower = std::max(0.0, smallest - rounding);
  bounds.is_constant = quotients.maxCoeff() - smallest <= 4.0 * rounding;
  // The first of equal ones, so that equally near points come out with the smallest parameter.
  bool found = false;
  for (Eigen::Index j = 0; j < quotients.cols() && !found; ++j)
    for (Eigen::Index i = 0; i < quotients.rows() && !found; ++i)
      if (quotients(i, j) <= smallest + rounding) {
        found = true;
        bounds.place << static_cast<double>(i) / (2.0 * patch.p),
            patch.q == 0 ? 0.0 : static_cast<double>(j) / (2.0 * patch.q);
      }
  if (patch.q == 0) return bounds;
  const Eigen::Index rows = quotients.rows() - 1;
  const Eigen::Index columns = quotients.cols() - 1;
  const double in_u = (quotients.bottomRows(rows) - quotients.topRows(rows)).cwiseAbs().maxCoeff();
  const double in_v = (quotients.rightCols(columns) - quotients.leftCols(columns)).cwiseAbs().maxCoeff();
  bounds.direction = in_v > in_u ? 1 : 0;
  return bounds;
}

/// Squared distance from the target to the box of the control points: the cheap bound for the first patches.
template <int Dim>
double box_bound(const BezierPatch<Dim>& patch) {
  const Points<Dim> points = patch.net.template topRows<Dim>().array().rowwise() / patch.net.row(Dim).array();
  const Vector<Dim> low = points.rowwise().minCoeff();
  const Vector<Dim> high = points.rowwise().maxCoeff();
  return low.cwiseMax(-high).cwiseMax(0.0).squaredNorm();
}

template <int Dim>
std::pair<BezierPatch<Dim>, BezierPatch<Dim>> halve(const BezierPatch<Dim>& patch, int direction) {
  const std::array<int, 2> degrees{patch.p, patch.q};
  const auto halves = subdivide({patch.net.data(), static_cast<std::size_t>(patch.net.size())}, Dim + 1,
                                std::span<const int>(degrees).first(patch.q == 0 ? 1 : 2), direction);
  const auto half = [&](const std::vector<double>& net, Interval u, Interval v) {
    return BezierPatch<Dim>{patch.p, patch.q, u, v,
                            Eigen::Map<const HomogeneousPoints<Dim>>(net.data(), Dim + 1, patch.net.cols())};
  };
  const Interval u = patch.u;
  const Interval v = patch.v;
  if (direction == 0)
    return {half(halves.first, {u.first, u.middle()}, v), half(halves.second, {u.middle(), u.last}, v)};
  return {half(halves.first, u, {v.first, v.middle()}), half(halves.second, u, {v.middle(), v.last})};
}

/// What is found: the patch (an index into the given ones) and the place in its unit square.
struct Nearest {
  std::size_t patch = 0;
  Eigen::Vector2d s = Eigen::Vector2d::Zero();
  double squared = std::numeric_limits<double>::infinity();
};

/// Best-first branch and bound. Nodes are dyadic parts of the given patches, their intervals in the unit square.
template <int Dim>
class Search {
 public:
  explicit Search(std::vector<BezierPatch<Dim>> patches) : patches_(std::move(patches)) {
    for (const BezierPatch<Dim>& patch : patches_)
      size_ = std::max(
          size_, (patch.net.template topRows<Dim>().colwise().norm().array() / patch.net.row(Dim).array()).maxCoeff());
    floor_ = 16.0 * epsilon * epsilon * size_ * size_;
    is_curve_ = patches_.front().q == 0;
  }

  Nearest run() {
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      BezierPatch<Dim> whole = patches_[i];
      whole.u = whole.v = {0.0, 1.0};
      const double lower = box_bound(whole);
      queue_.push({lower, i, std::move(whole)});
    }
    // Only a whole line of equally near points that slants across the parameters of a surface comes near this number.
    constexpr int most_nodes = 200'000;
    for (int count = 0; !queue_.empty() && count < most_nodes; ++count) {
      const Node node = queue_.top();
      queue_.pop();
      if (!is_hopeless(node, node.lower)) visit(node);
    }
    return best_;
  }

 private:
  struct Node {
    double lower = 0.0;
    std::size_t root = 0;
    BezierPatch<Dim> part;

    /// Nearest first, then in the order of the parameter.
    friend bool operator<(const Node& a, const Node& b) {
      if (a.lower != b.lower) return a.lower > b.lower;
      if (a.root != b.root) return a.root > b.root;
      return a.part.u.first > b.part.u.first;
    }
  };

  static constexpr double tie = 1e-14;
  static constexpr double apart = 1e-6;

  /// Position along a curve, in segments.
  static double position(std::size_t root, double s) { return static_cast<double>(root) + s; }

  bool is_hopeless(const Node& node, double lower) const {
    const double best = best_.squared;
    // On a curve an equally near point with a smaller parameter is still of interest.
    if (is_curve_ && position(node.root, node.part.u.first) < position(best_.patch, best_.s[0]) - apart)
      return lower > best * (1.0 + tie) + floor_;
    return lower >= best * (1.0 - (is_curve_ ? 1e-13 : 1e-10)) - floor_;
  }

  bool is_better(std::size_t root, const LocalMinimum& found) const {
    if (std::isinf(best_.squared)) return true;
    if (std::abs(found.squared - best_.squared) > tie * best_.squared + floor_) return found.squared < best_.squared;
    const double ahead = position(best_.patch, best_.s[0]) - position(root, found.s[0]);
    if (is_curve_ && std::abs(ahead) > apart) return ahead > 0.0;
    return found.squared < best_.squared;
  }

  void visit(const Node& node) {
    const Bounds bounds = distance_bounds(node.part);
    const double lower = std::max(node.lower, bounds.lower);
    if (is_hopeless(node, lower)) return;
    const Interval u = node.part.u;
    const Interval v = node.part.v;
    const Eigen::Vector2d start(u.first + bounds.place[0] * u.length(), v.first + bounds.place[1] * v.length());
    const LocalMinimum found = descend(patches_[node.root], start, size_);
    if (is_better(node.root, found)) best_ = {node.root, found.s, found.squared};
    const Interval side = bounds.direction == 0 ? u : v;
    if (is_hopeless(node, lower) || bounds.is_constant || side.length() < 1e-12) return;
    auto [low, high] = halve(node.part, bounds.direction);
    queue_.push({lower, node.root, std::move(low)});
    queue_.push({lower, node.root, std::move(high)});
  }

  std::vector<BezierPatch<Dim>> patches_;
  std::priority_queue<Node> queue_;
  Nearest best_;
  /// The distance of the farthest control point.
  double size_ = 0.0;
  /// Squared distances below this are rounding.
  double floor_ = 0.0;
  bool is_curve_ = false;
};

template <int Dim>
void require_finite(const Point<Dim>& target) {
  for (int d = 0; d < Dim; ++d)
    if (!std::isfinite(target[d]))
      throw GeometryError(fmt::format("closest point: coordinate {} of the target is {}", "xyz"[d], target[d]));
}

/// The net as seen from the target.
template <int Dim>
HomogeneousPoints<Dim> seen_from(const Point<Dim>& target, HomogeneousPoints<Dim> net) {
  net.template topRows<Dim>() -= target * net.row(Dim);
  return net;
}

double at_fraction(Interval interval, double s) {
  return s <= 0.5 ? interval.first + s * interval.length() : interval.last - (1.0 - s) * interval.length();
}

/// The point of a patch relative to the target.
template <int Dim>
Vector<Dim> relative_point(const BezierPatch<Dim>& patch, const Eigen::Vector2d& s) {
  const LocalBasisTable<2> u = bernstein(patch.p, s[0]);
  const LocalBasisTable<2> v = bernstein(patch.q, s[1]);
  Eigen::Matrix<double, Dim + 1, 1> sum = Eigen::Matrix<double, Dim + 1, 1>::Zero();
  for (int j = 0; j <= patch.q; ++j)
    sum += v(j, 0) * patch.net.middleCols(j * (patch.p + 1), patch.p + 1).lazyProduct(u.col(0));
  return sum.template head<Dim>() / sum[Dim];
}

}  // namespace

template <int Dim>
ClosestCurvePoint<Dim> closest_point(const NurbsCurve<Dim>& curve, const Point<Dim>& target) {
  require_finite(target);
  std::vector<BezierPatch<Dim>> patches;
  for (BezierSegment& segment : bezier_segments({curve.knots(), curve.homogeneous()}))
    patches.push_back({curve.degree(), 0, segment.domain, {}, seen_from<Dim>(target, segment.coefficients)});
  const Nearest nearest = Search<Dim>(patches).run();
  const BezierPatch<Dim>& patch = patches[nearest.patch];
  const Vector<Dim> offset = relative_point(patch, nearest.s);
  return {at_fraction(patch.u, nearest.s[0]), target + offset, offset.norm()};
}

template <int Dim>
ClosestSurfacePoint<Dim> closest_point(const NurbsSurface<Dim>& surface, const Point<Dim>& target) {
  require_finite(target);
  const int p = surface.knots_u().degree();
  const int q = surface.knots_v().degree();
  const int nu = surface.count_u();
  const std::vector<ExtractionOperator> in_u = extraction_operators(surface.knots_u());
  std::vector<BezierPatch<Dim>> patches;
  for (const ExtractionOperator& v : extraction_operators(surface.knots_v())) {
    const Eigen::MatrixXd strip =
        surface.homogeneous().middleCols(v.first_function * nu, (q + 1) * nu).reshaped((Dim + 1) * nu, q + 1) *
        v.matrix;
    for (const ExtractionOperator& u : in_u) {
      HomogeneousPoints<Dim> net(Dim + 1, (p + 1) * (q + 1));
      for (int j = 0; j <= q; ++j)
        net.middleCols(j * (p + 1), p + 1) =
            strip.col(j).reshaped(Dim + 1, nu).middleCols(u.first_function, p + 1).lazyProduct(u.matrix);
      patches.push_back({p, q, u.domain, v.domain, seen_from<Dim>(target, std::move(net))});
    }
  }
  const Nearest nearest = Search<Dim>(patches).run();
  const BezierPatch<Dim>& patch = patches[nearest.patch];
  const Vector<Dim> offset = relative_point(patch, nearest.s);
  return {{at_fraction(patch.u, nearest.s[0]), at_fraction(patch.v, nearest.s[1])}, target + offset, offset.norm()};
}

template ClosestCurvePoint<2> closest_point(const NurbsCurve<2>&, const Point<2>&);
template ClosestCurvePoint<3> closest_point(const NurbsCurve<3>&, const Point<3>&);
template ClosestSurfacePoint<2> closest_point(const NurbsSurface<2>&, const Point<2>&);
template ClosestSurfacePoint<3> closest_point(const NurbsSurface<3>&, const Point<3>&);

}  // namespace isorim::geometry
