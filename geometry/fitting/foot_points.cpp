#include "geometry/fitting/foot_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/fitting/local_bezier.h"
#include "geometry/spline/corner_cutting.h"

namespace isorim::geometry {

namespace {

constexpr int capacity = KnotVector::max_degree + 1;

/// Bézier points on the stack.
template <int Dim>
using StackNet = Eigen::Matrix<double, Dim, Eigen::Dynamic, Eigen::ColMajor, Dim, capacity>;

/// De Casteljau's algorithm; derivatives with respect to s in [0, 1]. Degree: 0 if it is not known when compiled.
template <int Dim, int Degree>
CurveJet<Dim> bezier_jet_of(const double* points, int degree, double s) {
  const int p = Degree > 0 ? Degree : degree;
  std::array<Vector<Dim>, (Degree > 0 ? Degree + 1 : capacity)> net;
  for (int i = 0; i <= p; ++i) net[static_cast<std::size_t>(i)] = Eigen::Map<const Vector<Dim>>(points + Dim * i);
  CurveJet<Dim> jet;
  jet.du.setZero();
  jet.duu.setZero();
  for (int count = p; count > 0; --count) {
    if (count == 2) jet.duu = p * (p - 1) * (net[0] - 2.0 * net[1] + net[2]);
    if (count == 1) jet.du = p * (net[1] - net[0]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) net[i] += s * (net[i + 1] - net[i]);
  }
  jet.point = net[0];
  return jet;
}

template <int Dim>
CurveJet<Dim> bezier_jet(const double* points, int degree, double s) {
  return degree == 3 ? bezier_jet_of<Dim, 3>(points, degree, s) : bezier_jet_of<Dim, 0>(points, degree, s);
}

/// The Bernstein coefficients (degree 2p - 1, without a positive factor) of the derivative of |C(s)|^2, the curve
/// seen from the target.
template <int Dim>
std::array<double, 2 * capacity> distance_derivative(const StackNet<Dim>& net) {
  const int p = static_cast<int>(net.cols()) - 1;
  std::array<double, 2 * capacity> sums;
  std::fill_n(sums.begin(), 2 * p, 0.0);
  std::array<double, capacity> binomial;
  std::array<double, capacity> lower;
  const auto fill = [](std::array<double, capacity>& row, int n) {
    row[0] = 1.0;
    for (int k = 1; k <= n; ++k)
      row[static_cast<std::size_t>(k)] = row[static_cast<std::size_t>(k - 1)] * (n - k + 1) / k;
  };
  fill(binomial, p);
  fill(lower, p - 1);
  for (int i = 0; i < p; ++i) {
    const Vector<Dim> side = lower[static_cast<std::size_t>(i)] * (net.col(i + 1) - net.col(i));
    for (int j = 0; j <= p; ++j)
      sums[static_cast<std::size_t>(i + j)] += binomial[static_cast<std::size_t>(j)] * side.dot(net.col(j));
  }
  // The sums are coefficients times binomials of degree 2p - 1, which are positive: only signs are asked for.
  return sums;
}

int sign_variations(const std::array<double, 2 * capacity>& coefficients, int count) {
  int variations = 0;
  double last = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (coefficients[i] == 0.0) continue;
    if (last * coefficients[i] < 0.0) ++variations;
    last = coefficients[i];
  }
  return variations;
}

/// Cuts the net at its middle.
template <int Dim>
std::array<StackNet<Dim>, 2> halve(StackNet<Dim> net) {
  StackNet<Dim> left = net;
  const Eigen::Index p = net.cols() - 1;
  for (Eigen::Index count = p; count > 0; --count) {
    for (Eigen::Index i = 0; i < count; ++i) net.col(i) = 0.5 * (net.col(i) + net.col(i + 1));
    left.col(p - count + 1) = net.col(0);
  }
  return {left, net};
}

/// Squared distance from the origin to the box of the points.
template <int Dim>
double box_distance_squared(const StackNet<Dim>& net) {
  const Vector<Dim> low = net.rowwise().minCoeff();
  const Vector<Dim> high = net.rowwise().maxCoeff();
  return low.cwiseMax(-high).cwiseMax(0.0).squaredNorm();
}

}  // namespace

/// The best point so far.
template <int Dim>
struct SegmentedCurve<Dim>::Search {
  Point<Dim> target;
  /// The segment inside which a minimum is known already; -1: none.
  int settled = -1;
  double u = 0.0;
  double squared = std::numeric_limits<double>::infinity();

  void offer(double parameter, const Point<Dim>& point) {
    const double distance = (point - target).squaredNorm();
    if (distance < squared) {
      squared = distance;
      u = parameter;
    }
  }
};

template <int Dim>
SegmentedCurve<Dim>::SegmentedCurve(const KnotVector& knots, const Points<Dim>& points, bool is_closed)
    : degree_(knots.degree()), is_closed_(is_closed) {
  const std::vector<int> spans = nonempty_spans(knots);
  starts_.reserve(spans.size() + 1);
  points_.reserve(spans.size() * static_cast<std::size_t>(Dim * (degree_ + 1)));
  LocalNet<Dim> control;
  LocalNet<Dim> bezier;
  for (const int span : spans) {
    starts_.push_back(knots[span]);
    for (int i = 0; i <= degree_; ++i) control[static_cast<std::size_t>(i)] = points.col(span - degree_ + i);
    cut_to_bezier<Dim>(&knots.knots()[static_cast<std::size_t>(span - degree_ + 1)], control, degree_, bezier);
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_); ++i)
      points_.insert(points_.end(), bezier[i].data(), bezier[i].data() + Dim);
  }
  starts_.push_back(knots.domain().last);
  build_boxes();
}

template <int Dim>
void SegmentedCurve<Dim>::build_boxes() {
  while (leaf_count_ < segment_count()) leaf_count_ *= 2;
  Eigen::Matrix<double, Dim, 2> empty;
  empty.col(0).setConstant(std::numeric_limits<double>::infinity());
  empty.col(1).setConstant(-std::numeric_limits<double>::infinity());
  boxes_.assign(2 * static_cast<std::size_t>(leaf_count_), empty);
  for (int i = 0; i < segment_count(); ++i) {
    Eigen::Matrix<double, Dim, 2>& box = boxes_[static_cast<std::size_t>(leaf_count_ + i)];
    box.col(0) = segment_points(i).rowwise().minCoeff();
    box.col(1) = segment_points(i).rowwise().maxCoeff();
  }
  for (std::size_t i = static_cast<std::size_t>(leaf_count_) - 1; i > 0; --i) {
    boxes_[i].col(0) = boxes_[2 * i].col(0).cwiseMin(boxes_[2 * i + 1].col(0));
    boxes_[i].col(1) = boxes_[2 * i].col(1).cwiseMax(boxes_[2 * i + 1].col(1));
  }
}

template <int Dim>
int SegmentedCurve<Dim>::find_segment(double u) const {
  const auto after = std::upper_bound(starts_.begin() + 1, starts_.end() - 1, u);
  return static_cast<int>(after - starts_.begin()) - 1;
}

template <int Dim>
CurveJet<Dim> SegmentedCurve<Dim>::jet_on(int segment, double u) const {
  const Interval domain = segment_domain(segment);
  const double scale = 1.0 / domain.length();
  CurveJet<Dim> jet = bezier_jet<Dim>(segment_points(segment).data(), degree_, (u - domain.first) * scale);
  jet.du *= scale;
  jet.duu *= scale * scale;
  return jet;
}

template <int Dim>
FootPoint SegmentedCurve<Dim>::follow(const Point<Dim>& target, double u, int steps) const {
  constexpr double rounding = 1e-15;
  const Interval whole = domain();
  const auto into_domain = [&](double v) {
    if (!is_closed_) return std::clamp(v, whole.first, whole.last);
    if (v < whole.first) v += whole.length();
    if (v >= whole.last) v -= whole.length();
    return std::clamp(v, whole.first, whole.last);
  };
  int segment = find_segment(u);
  CurveJet<Dim> jet = jet_on(segment, u);
  double squared = (jet.point - target).squaredNorm();
  for (int i = 0; i < steps; ++i) {
    const Vector<Dim> offset = jet.point - target;
    const double metric = jet.du.squaredNorm();
    const double slope = offset.dot(jet.du);
    const double hessian = metric + offset.dot(jet.duu);
    if (!(metric > 0.0) || slope == 0.0) break;
    // Newton's step where the distance is safely convex, else Gauss and Newton's; never more than half a segment.
    const double longest = 0.5 * segment_domain(segment).length();
    double step = std::clamp(-slope / (hessian > 0.1 * metric ? hessian : metric), -longest, longest);
    // What is to be gained is less than can be told.
    if (-slope * step <= rounding * squared || std::abs(step) <= rounding * whole.length()) break;
    bool accepted = false;
    for (int halving = 0; halving < 8 && !accepted; ++halving, step *= 0.5) {
      const double next = into_domain(u + step);
      const int next_segment = find_segment(next);
      const CurveJet<Dim> at_next = jet_on(next_segment, next);
      const double distance = (at_next.point - target).squaredNorm();
      accepted = distance < squared;
      if (!accepted) continue;
      u = next;
      segment = next_segment;
      jet = at_next;
      squared = distance;
    }
    if (!accepted) break;
  }
  return {u, squared};
}

/// Whether u is a minimum of the distance to so many digits that the distance is met to rounding.
template <int Dim>
bool SegmentedCurve<Dim>::is_stationary(const Point<Dim>& target, double u) const {
  constexpr double precision = 1e-9;
  const int segment = find_segment(u);
  const CurveJet<Dim> at = jet_on(segment, u);
  const Vector<Dim> offset = at.point - target;
  const double hessian = at.du.squaredNorm() + offset.dot(at.duu);
  return hessian > 0.0 && std::abs(offset.dot(at.du)) <= precision * hessian * segment_domain(segment).length();
}

template <int Dim>
ClosestCurvePoint<Dim> SegmentedCurve<Dim>::nearest(const Point<Dim>& target, double guess) const {
  constexpr int steps = 12;
  Search state{target};
  const double near = follow(target, guess, steps).u;
  state.offer(near, jet(near).point);
  if (is_stationary(target, near)) state.settled = find_segment(near);
  search(state, 1);
  const Point<Dim> point = jet(state.u).point;
  return {state.u, point, (point - target).norm()};
}

template <int Dim>
void SegmentedCurve<Dim>::search(Search& state, int node) const {
  const auto distance = [&](int i) {
    const Eigen::Matrix<double, Dim, 2>& box = boxes_[static_cast<std::size_t>(i)];
    return (box.col(0) - state.target).cwiseMax(state.target - box.col(1)).cwiseMax(0.0).squaredNorm();
  };
  if (node >= leaf_count_) {
    if (node - leaf_count_ < segment_count()) search_segment(state, node - leaf_count_);
    return;
  }
  // The nearer child first; empty boxes are infinitely far away.
  std::array<int, 2> children{2 * node, 2 * node + 1};
  std::array<double, 2> bounds{distance(children[0]), distance(children[1])};
  if (bounds[1] < bounds[0]) {
    std::swap(bounds[0], bounds[1]);
    std::swap(children[0], children[1]);
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (bounds[i] < state.squared) search(state, children[i]);
}

template <int Dim>
void SegmentedCurve<Dim>::search_segment(Search& state, int segment) const {
  struct Part {
    StackNet<Dim> net;
    double first;
    double last;
  };
  constexpr double narrowest = 1e-9;
  const Interval domain = segment_domain(segment);
  const StackNet<Dim> net = segment_points(segment).colwise() - state.target;
  const int p = degree_;
  const auto offer = [&](double s) {
    state.offer(domain.first + s * domain.length(), state.target + bezier_jet<Dim>(net.data(), p, s).point);
  };
  state.offer(domain.first, segment_points(segment).col(0));
  state.offer(domain.last, segment_points(segment).col(p));
  if (segment == state.settled && sign_variations(distance_derivative<Dim>(net), 2 * p) == 1) return;
  std::vector<Part> parts{{net, 0.0, 1.0}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    if (box_distance_squared<Dim>(part.net) >= state.squared) continue;
    const auto derivative = distance_derivative<Dim>(part.net);
    const int variations = sign_variations(derivative, 2 * p);
    // Without a minimum inside, the ends are nearest; they have been offered.
    const double leading =
        *std::find_if(derivative.begin(), derivative.begin() + 2 * p - 1, [](double d) { return d != 0.0; });
    if (variations == 0 || (variations == 1 && leading > 0.0)) continue;
    const double middle = 0.5 * (part.first + part.last);
    if (variations == 1 || part.last - part.first < narrowest) {
      double low = part.first;
      double high = part.last;
      double s = middle;
      for (int i = 0; i < 60 && high - low > 1e-16; ++i) {
        const CurveJet<Dim> jet = bezier_jet<Dim>(net.data(), p, s);
        const double slope = jet.point.dot(jet.du);
        (slope > 0.0 ? high : low) = s;
        const double hessian = jet.du.squaredNorm() + jet.point.dot(jet.duu);
        const double newton = s - slope / hessian;
        const double next = hessian > 0.0 && newton > low && newton < high ? newton : 0.5 * (low + high);
        if (std::abs(next - s) < 1e-15) break;
        s = next;
      }
      offer(s);
      continue;
    }
    offer(middle);
    auto halves = halve<Dim>(part.net);
    parts.push_back({halves[1], middle, part.last});
    parts.push_back({halves[0], part.first, middle});
  }
}

template class SegmentedCurve<2>;
template class SegmentedCurve<3>;

}  // namespace isorim::geometry
