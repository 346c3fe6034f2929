#include "quadrature/near_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "quadrature/direction_rule.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/polar_rule.h"
#include "quadrature/winding_number.h"

namespace isorim::quadrature {

namespace {

using Complex = std::complex<double>;

/// More points along one line are not asked for: the cell is bisected instead.
constexpr int most_points = 120;
constexpr int most_bisections = 40;

template <int Dim>
Complex singularity(const ElementJet<Dim>& jet, std::size_t d) {
  return singularity_on_line<Dim>(jet.offset, jet.first[d], jet.second[d]);
}

/// Where the integrand is singular in the complex plane of a direction's parameter, on the lines through a few places.
/// Parameters are those of the cell: 0 to 1 across it.
template <int Dim>
std::vector<Complex> singularities(const NearRequest<Dim>& request, const Cell<Dim - 1>& cell,
                                   const NearestPlace<Dim>& nearest, std::size_t d) {
  std::vector<Complex> found;
  const auto i = static_cast<Eigen::Index>(d);
  const auto add = [&](double at, Complex root) {
    const Complex inside = (at + root - cell.lower[i]) / cell.width(d);
    if (std::isfinite(inside.real()) && std::isfinite(inside.imag())) found.push_back(inside);
  };
  add(nearest.place[i], singularity(nearest.jet, d));
  const geometry::Vector<Dim> straight = geometry::Vector<Dim>::Zero();
  const Complex known = nearest.place[i] + singularity(nearest.jet, d);
  for (const auto& sample : request.shape->samples) {
    const Complex root = singularity_on_line<Dim>(sample.position - request.target, sample.first[d], straight);
    if (!is_vague(sample.place[i] + root, known, sample.place[i])) add(sample.place[i], root);
  }
  if constexpr (Dim == 3) {
    // Lines beside the nearest place, at distances like the target's.
    const std::size_t other = 1 - d;
    const auto j = static_cast<Eigen::Index>(other);
    const double speed = nearest.jet.first[other].norm();
    for (const double factor : {0.5, 1.0, 2.0, 4.0, 8.0}) {
      const double shift = factor * nearest.distance / std::max(speed, 1e-300);
      for (const double signed_shift : {-shift, shift}) {
        const double at = nearest.place[j] + signed_shift;
        if (at < cell.lower[j] || at > cell.upper[j]) continue;
        const geometry::Vector3 offset = nearest.jet.offset + signed_shift * nearest.jet.first[other] +
                                         0.5 * signed_shift * signed_shift * nearest.jet.second[other];
        const geometry::Vector3 tangent = nearest.jet.first[d] + signed_shift * nearest.jet.second[2];
        add(nearest.place[i], singularity_on_line<3>(offset, tangent, nearest.jet.second[d]));
      }
    }
  }
  return found;
}

/// The growth along a direction of a cell, whose coordinate runs from 0 to 1.
template <int Dim>
double growth_in(const NearRequest<Dim>& request, const Cell<Dim - 1>& cell, std::size_t d, Complex coordinate) {
  const Complex place = cell.lower[static_cast<Eigen::Index>(d)] + coordinate * cell.width(d);
  return request.shape->growth[d](log_ellipse(place));
}

template <int Dim>
DirectionRule direction_rule(const NearRequest<Dim>& request, const Cell<Dim - 1>& cell,
                             const std::vector<Complex>& roots, std::size_t d, const SinhMap& map) {
  constexpr double largest = 10.0;
  double least_sum = std::cosh(largest);
  for (const Complex& root : roots) least_sum = std::min(least_sum, map.ellipse_sum_of(root));
  const auto growth = [&](Complex u) { return growth_in(request, cell, d, u); };
  return {map, gauss_points(map, std::acosh(least_sum), request.tolerance, growth)};
}

/// The better of a plain and a mapped rule.
template <int Dim>
DirectionRule direction_rule(const NearRequest<Dim>& request, const Cell<Dim - 1>& cell,
                             const NearestPlace<Dim>& nearest, std::size_t d) {
  const std::vector<Complex> roots = singularities(request, cell, nearest, d);
  const DirectionRule plain = direction_rule(request, cell, roots, d, SinhMap());
  const SinhMap map = SinhMap::towards(roots.front());
  if (map.is_identity()) return plain;
  const DirectionRule mapped = direction_rule(request, cell, roots, d, map);
  return 1.2 * mapped.points < plain.points ? mapped : plain;
}

void append_tensor(const Cell<2>& cell, const std::array<DirectionRule, 2>& rules, NodeBuffer<3>& nodes) {
  const MappedRule u(rules[0], cell.lower[0], cell.width(0));
  const MappedRule v(rules[1], cell.lower[1], cell.width(1));
  reserve_more(nodes, static_cast<std::size_t>(rules[0].points * rules[1].points));
  for (std::size_t b = 0; b < static_cast<std::size_t>(rules[1].points); ++b) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(rules[0].points); ++a)
      append_node(nodes, {u.places[a], v.places[b]}, u.weights[a] * v.weights[b]);
  }
}

/// Squared lengths of steps in the parameters, in units of those at the pole.
class PoleMetric {
 public:
  explicit PoleMetric(const ElementJet<3>& pole) {
    constexpr double least_sine = 1e-4;
    constexpr double least_speed = 1e-9;
    const double speed = std::max(pole.first[0].norm(), pole.first[1].norm());
    u_ = std::max(pole.first[0].norm(), least_speed * speed);
    const double along = pole.first[0].dot(pole.first[1]) / u_;
    const double v = std::max(pole.first[1].norm(), least_speed * speed);
    shift_ = std::clamp(along, -v, v) / u_;
    height_ = std::max(std::sqrt(std::max(v * v - along * along, 0.0)), least_sine * v);
  }

  /// Of the tangents elsewhere.
  Eigen::Matrix2d seen(const std::array<geometry::Vector3, 2>& tangents) const {
    const geometry::Vector3 first = tangents[0] / u_;
    const geometry::Vector3 second = (tangents[1] - shift_ * tangents[0]) / height_;
    Eigen::Matrix2d metric;
    metric << first.dot(first), first.dot(second), first.dot(second), second.dot(second);
    return metric;
  }

 private:
  /// Steps of 1 / u in the first parameter, and of 1 / height in the second with -shift / height in the first, are
  /// orthonormal at the pole.
  double u_ = 1.0;
  double shift_ = 0.0;
  double height_ = 1.0;
};

/// The larger eigenvalue.
double most_stretch(const Eigen::Matrix2d& metric) {
  const double mean = 0.5 * (metric(0, 0) + metric(1, 1));
  return mean + std::hypot(0.5 * (metric(0, 0) - metric(1, 1)), metric(0, 1));
}

/// How the metric changes over a cell.
struct Distortion {
  /// The largest ratio of a step's length in the cell to that of the same step at the pole.
  double ratio = 1.0;
  /// By how much of its largest value the metric changes, in the direction where it does most.
  double change = 0.0;
  std::size_t direction = 0;
};

/// Sheared elements are narrower than their speeds tell: what counts is the metric as seen by that at the pole.
Distortion distortion(const NearRequest<3>& request, const Cell<2>& cell, const PoleMetric& metric) {
  constexpr std::size_t count = 3;
  std::array<std::array<Eigen::Matrix2d, count>, count> seen;
  double largest = 0.0;
  for (std::size_t k = 0; k < count * count; ++k) {
    const std::size_t across = k / count;
    const geometry::Point2 fraction(0.5 * static_cast<double>(k % count), 0.5 * static_cast<double>(across));
    const geometry::Point2 at = cell.lower + fraction.cwiseProduct(cell.upper - cell.lower);
    seen[k % count][across] = metric.seen(element_jet(request.shape->net, at, request.target).first);
    largest = std::max(largest, most_stretch(seen[k % count][across]));
  }
  Distortion result;
  result.ratio = std::max(1.0, std::sqrt(largest));
  for (std::size_t k = 0; k < count * (count - 1); ++k) {
    const std::size_t along = k % (count - 1);
    const std::size_t across = k / (count - 1);
    const std::array<double, 2> change{(seen[along + 1][across] - seen[along][across]).norm() / (2.0 * largest),
                                       (seen[across][along + 1] - seen[across][along]).norm() / (2.0 * largest)};
    for (std::size_t direction = 0; direction < 2; ++direction) {
      if (change[direction] <= result.change) continue;
      result.change = change[direction];
      result.direction = direction;
    }
  }
  return result;
}

/// Not too near to the place.
std::pair<Cell<2>, Cell<2>> bisect(const Cell<2>& cell, std::size_t direction, const geometry::Point2& place) {
  constexpr double margin = 0.2;
  const auto i = static_cast<Eigen::Index>(direction);
  const double width = cell.width(direction);
  double at = cell.lower[i] + 0.5 * width;
  const double beside = place[i] - at;
  if (std::abs(beside) < margin * width) at = place[i] + (beside > 0.0 ? -margin : margin) * width;
  std::pair<Cell<2>, Cell<2>> halves{cell, cell};
  halves.first.upper[i] = at;
  halves.second.lower[i] = at;
  return halves;
}

/// `known`: the rules along the cell's directions, if they have been made.
void append_cell(const NearRequest<3>& request, const Cell<2>& cell, const NearestPlace<3>& nearest, int depth,
                 const std::array<DirectionRule, 2>* known, NodeBuffer<3>& nodes);

void append_halves(const NearRequest<3>& request, const Cell<2>& cell, std::size_t direction,
                   const NearestPlace<3>& nearest, int depth, NodeBuffer<3>& nodes) {
  const auto [first, second] = bisect(cell, direction, nearest.place);
  for (const Cell<2>& half : {first, second}) {
    const bool holds = half.clamped(nearest.place) == nearest.place;
    append_cell(request, half, holds ? nearest : nearest_place(*request.shape, half, request.target), depth + 1,
                nullptr, nodes);
  }
}

void append_cell(const NearRequest<3>& request, const Cell<2>& cell, const NearestPlace<3>& nearest, int depth,
                 const std::array<DirectionRule, 2>* known, NodeBuffer<3>& nodes) {
  constexpr double most_aspect = 5.0;
  constexpr double most_distortion = 2.0;
  constexpr double least_change = 0.25;
  constexpr int cheap = 300;
  const bool is_own = request.is_own && cell.clamped(request.place) == request.place;
  int tensor_points = std::numeric_limits<int>::max();
  std::array<DirectionRule, 2> rules;
  if (!is_own) {
    for (std::size_t d = 0; d < 2; ++d) rules[d] = known ? (*known)[d] : direction_rule(request, cell, nearest, d);
    if (std::max(rules[0].points, rules[1].points) <= most_points) tensor_points = rules[0].points * rules[1].points;
    if (tensor_points <= cheap) return append_tensor(cell, rules, nodes);
  }
  const PolarRule polar(request, sides(cell), nearest.place, nearest.jet, is_own, PolarRule::Around::place);
  if (tensor_points <= polar.points()) return append_tensor(cell, rules, nodes);
  const std::array<double, 2> length{nearest.jet.first[0].norm() * cell.width(0),
                                     nearest.jet.first[1].norm() * cell.width(1)};
  const std::size_t longer = length[1] > length[0] ? 1 : 0;
  if (length[longer] > most_aspect * length[1 - longer] && depth < most_bisections)
    return append_halves(request, cell, longer, nearest, depth, nodes);
  const Distortion metric = distortion(request, cell, PoleMetric(nearest.jet));
  const bool is_even = metric.ratio <= most_distortion && polar.most_points_on_a_line() <= most_points;
  if (!is_even && metric.change >= least_change && depth < most_bisections)
    return append_halves(request, cell, metric.direction, nearest, depth, nodes);
  polar.append(nodes);
}

void append_line(const Cell<1>& cell, const DirectionRule& direction, NodeBuffer<2>& nodes) {
  const MappedRule rule(direction, cell.lower[0], cell.width(0));
  reserve_more(nodes, static_cast<std::size_t>(direction.points));
  for (std::size_t k = 0; k < static_cast<std::size_t>(direction.points); ++k) {
    nodes.place[0][nodes.size] = rule.places[k];
    nodes.cell_weight[nodes.size++] = rule.weights[k];
  }
}

/// From the place to one end of the cell. With s = t^6 a logarithm of s becomes t^5 ln t, for which Gauss's rule of n
/// points errs like n^-12.
void append_logarithmic(double place, double end, int degree, NodeBuffer<2>& nodes) {
  constexpr int power = 6;
  const double length = end - place;
  if (length == 0.0) return;
  const Rule& gauss = gauss_legendre(std::min(3 * degree + 20, max_gauss_points));
  reserve_more(nodes, gauss.nodes.size());
  for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
    const double t = gauss.nodes[k];
    nodes.place[0][nodes.size] = place + length * std::pow(t, power);
    nodes.cell_weight[nodes.size++] = std::abs(length) * power * std::pow(t, power - 1) * gauss.weights[k];
  }
}

}  // namespace

template <int Dim>
std::array<DirectionRule, Dim - 1> direction_rules(const NearRequest<Dim>& request, const NearestPlace<Dim>& nearest) {
  std::array<DirectionRule, Dim - 1> rules;
  for (std::size_t d = 0; d < Dim - 1; ++d) rules[d] = direction_rule(request, Cell<Dim - 1>(), nearest, d);
  return rules;
}

template <>
void near_rule(const NearRequest<3>& request, const NearestPlace<3>& nearest, const std::array<DirectionRule, 2>* known,
               NodeBuffer<3>& nodes) {
  nodes.size = 0;
  if (request.region != nullptr) {
    const bool is_kept = request.is_own || winding_number(*request.region, nearest.place) > 0.5;
    const auto around = is_kept ? PolarRule::Around::place : PolarRule::Around::hole;
    return PolarRule(request, request.region->curves, nearest.place, nearest.jet, request.is_own, around).append(nodes);
  }
  append_cell(request, Cell<2>(), nearest, 0, known, nodes);
}

template <>
void near_rule(const NearRequest<2>& request, const NearestPlace<2>& nearest, const std::array<DirectionRule, 1>* known,
               NodeBuffer<2>& nodes) {
  nodes.size = 0;
  if (request.is_own) {
    const SinhMap plain;
    const auto growth = [&](Complex u) { return growth_in(request, Cell<1>(), 0, u); };
    const int degree = 2 * gauss_points(plain, 2.0, request.tolerance, growth);
    append_logarithmic(request.place[0], 0.0, degree, nodes);
    append_logarithmic(request.place[0], 1.0, degree, nodes);
    return;
  }
  const DirectionRule whole = known ? (*known)[0] : direction_rule(request, Cell<1>(), nearest, 0);
  if (whole.points <= most_points) return append_line(Cell<1>(), whole, nodes);
  // Towards the nearest place from both sides.
  Cell<1> below;
  Cell<1> above;
  below.upper = above.lower = nearest.place.cwiseMax(1e-12).cwiseMin(1.0 - 1e-12);
  for (const Cell<1>& half : {below, above}) {
    DirectionRule rule = direction_rule(request, half, nearest, 0);
    rule.points = std::min(rule.points, max_gauss_points);
    append_line(half, rule, nodes);
  }
}

template std::array<DirectionRule, 1> direction_rules(const NearRequest<2>&, const NearestPlace<2>&);
template std::array<DirectionRule, 2> direction_rules(const NearRequest<3>&, const NearestPlace<3>&);

}  // namespace isorim::quadrature
