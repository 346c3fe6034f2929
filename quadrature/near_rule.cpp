#include "quadrature/near_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "quadrature/gauss_legendre.h"

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

/// A rule along one direction of a cell.
struct DirectionRule {
  SinhMap map;
  int points = 0;
};

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
  for (const auto& sample : request.shape->samples)
    add(sample.place[i], singularity_on_line<Dim>(sample.position - request.target, sample.first[d], straight));
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
  double log_rho = 10.0;
  for (const Complex& root : roots) log_rho = std::min(log_rho, map.log_ellipse_of(root));
  const auto growth = [&](Complex u) { return growth_in(request, cell, d, u); };
  return {map, gauss_points(map, log_rho, request.tolerance, growth)};
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

template <int Dim>
void reserve_more(NodeBuffer<Dim>& nodes, std::size_t count) {
  const std::size_t size = nodes.size + count;
  if (nodes.cell_weight.size() >= size) return;
  nodes.cell_weight.resize(size);
  for (std::vector<double>& values : nodes.place) values.resize(size);
}

void append_node(NodeBuffer<3>& nodes, const geometry::Point2& place, double weight) {
  nodes.place[0][nodes.size] = place[0];
  nodes.place[1][nodes.size] = place[1];
  nodes.cell_weight[nodes.size++] = weight;
}

/// Places across a cell's direction and their weights.
struct MappedRule {
  std::array<double, max_gauss_points> places;
  std::array<double, max_gauss_points> weights;

  MappedRule(const DirectionRule& direction, double lower, double width) {
    const Rule& gauss = gauss_legendre(direction.points);
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const SinhMap::Value at = direction.map.at(gauss.nodes[k]);
      places[k] = lower + width * at.place;
      weights[k] = width * gauss.weights[k] * at.derivative;
    }
  }
};

void append_tensor(const Cell<2>& cell, const std::array<DirectionRule, 2>& rules, NodeBuffer<3>& nodes) {
  const MappedRule u(rules[0], cell.lower[0], cell.width(0));
  const MappedRule v(rules[1], cell.lower[1], cell.width(1));
  reserve_more(nodes, static_cast<std::size_t>(rules[0].points * rules[1].points));
  for (std::size_t b = 0; b < static_cast<std::size_t>(rules[1].points); ++b) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(rules[0].points); ++a)
      append_node(nodes, {u.places[a], v.places[b]}, u.weights[a] * v.weights[b]);
  }
}

/// The metric of the surface at a place: squared lengths of steps in the parameters.
struct Metric {
  double uu;
  double vv;
  double uv;

  /// Kept away from singular, where an edge is degenerate.
  Metric(const ElementJet<3>& jet, const std::array<double, 2>& half_length) {
    constexpr double least_speed = 1e-5;
    constexpr double most_cosine = 0.999;
    uu = std::max(jet.first[0].squaredNorm(), std::pow(least_speed * half_length[0], 2));
    vv = std::max(jet.first[1].squaredNorm(), std::pow(least_speed * half_length[1], 2));
    const double most = most_cosine * std::sqrt(uu * vv);
    uv = std::clamp(jet.first[0].dot(jet.first[1]), -most, most);
  }
  double product(const geometry::Vector2& a, const geometry::Vector2& b) const {
    return uu * a[0] * b[0] + vv * a[1] * b[1] + uv * (a[0] * b[1] + a[1] * b[0]);
  }
  double root_determinant() const { return std::sqrt(uu * vv - uv * uv); }
};

double cross(const geometry::Vector2& a, const geometry::Vector2& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// The triangle between the pole and one side of a cell; sides are straight lines in the parameters.
struct Triangle {
  /// From the pole.
  geometry::Vector2 first;
  geometry::Vector2 side;
  double area_factor = 0.0;
  DirectionRule along;
  int radial_points = 0;

  geometry::Vector2 ray(double s) const { return first + s * side; }
};

/// Polar coordinates about a pole in the parameters.
class PolarRule {
 public:
  PolarRule(const NearRequest<3>& request, const Cell<2>& cell, const geometry::Point2& pole, const ElementJet<3>& jet,
            bool is_own)
      : request_(request),
        cell_(cell),
        pole_(pole),
        jet_(jet),
        is_own_(is_own),
        metric_(jet, request.shape->half_length) {
    const std::array<geometry::Point2, 4> corners{
        geometry::Point2(cell.lower), {cell.upper[0], cell.lower[1]}, cell.upper, {cell.lower[0], cell.upper[1]}};
    for (std::size_t k = 0; k < 4; ++k) add_triangle(corners[k], corners[(k + 1) % 4], k % 2);
  }

  /// Of all triangles.
  int points() const {
    int sum = 0;
    for (const Triangle& triangle : triangles_) sum += triangle.along.points * triangle.radial_points;
    return sum;
  }
  int most_points_on_a_line() const {
    int most = 0;
    for (const Triangle& triangle : triangles_) most = std::max({most, triangle.along.points, triangle.radial_points});
    return most;
  }

  void append(NodeBuffer<3>& nodes) const {
    reserve_more(nodes, static_cast<std::size_t>(points()));
    for (const Triangle& triangle : triangles_) append(triangle, nodes);
  }

 private:
  void add_triangle(const geometry::Point2& from, const geometry::Point2& to, std::size_t direction) {
    constexpr double nothing = 1e-15;
    Triangle triangle{from - pole_, to - from, 0.0, {}, 0};
    triangle.area_factor = cross(triangle.first, triangle.side);
    if (triangle.area_factor <= nothing * cell_.width(0) * cell_.width(1)) return;
    const double squared = metric_.product(triangle.side, triangle.side);
    const double foot = -metric_.product(triangle.first, triangle.side) / squared;
    const double height = metric_.root_determinant() * triangle.area_factor / squared;
    const SinhMap map(foot, height);
    const Complex root(foot, height);
    const auto growth = [&](Complex s) {
      const auto i = static_cast<Eigen::Index>(direction);
      return request_.shape->growth[direction](log_ellipse(pole_[i] + triangle.first[i] + s * triangle.side[i]));
    };
    triangle.along = {map, gauss_points(map, map.log_ellipse_of(root), request_.tolerance, growth)};
    for (const double s : {0.0, std::clamp(foot, 0.0, 1.0), 1.0})
      triangle.radial_points = std::max(triangle.radial_points, radial_points(triangle.ray(s)));
    triangles_.push_back(triangle);
  }

  geometry::Vector3 tangent(const geometry::Vector2& ray) const {
    return ray[0] * jet_.first[0] + ray[1] * jet_.first[1];
  }
  geometry::Vector3 curvature(const geometry::Vector2& ray) const {
    return ray[0] * ray[0] * jet_.second[0] + ray[1] * ray[1] * jet_.second[1] + 2.0 * ray[0] * ray[1] * jet_.second[2];
  }

  /// Along a ray, on which the integrand's coordinate runs from 0 at the pole to 1.
  Complex singularity(const geometry::Vector2& ray) const {
    return singularity_on_line<3>(jet_.offset, tangent(ray), curvature(ray));
  }
  /// Where the distance from the pole, divided by the coordinate, vanishes.
  Complex distant_singularity(const geometry::Vector2& ray) const {
    const geometry::Vector3 turn = curvature(ray);
    const double bending = turn.squaredNorm();
    const double speed = tangent(ray).squaredNorm();
    if (bending < 1e-6 * speed) return {0.0, 1e3};
    const double b = 2.0 * tangent(ray).dot(turn) / bending;
    return {-b, std::sqrt(std::max(4.0 * speed / bending - b * b, 0.0))};
  }
  SinhMap radial_map(const geometry::Vector2& ray) const {
    if (is_own_) return {};
    const Complex root = singularity(ray);
    return root.real() <= 0.0 ? SinhMap::towards(Complex(0.0, std::abs(root))) : SinhMap::towards(root);
  }

  int radial_points(const geometry::Vector2& ray) const {
    const SinhMap map = radial_map(ray);
    double log_rho = map.log_ellipse_of(distant_singularity(ray));
    if (!is_own_) log_rho = std::min(log_rho, map.log_ellipse_of(singularity(ray)));
    const auto growth = [&](Complex t) {
      return request_.shape->growth[0](log_ellipse(pole_[0] + t * ray[0])) +
             request_.shape->growth[1](log_ellipse(pole_[1] + t * ray[1]));
    };
    return gauss_points(map, log_rho, request_.tolerance, growth);
  }

  void append(const Triangle& triangle, NodeBuffer<3>& nodes) const {
    const MappedRule along(triangle.along, 0.0, 1.0);
    for (std::size_t a = 0; a < static_cast<std::size_t>(triangle.along.points); ++a) {
      const geometry::Vector2 ray = triangle.ray(along.places[a]);
      const MappedRule radial({radial_map(ray), triangle.radial_points}, 0.0, 1.0);
      const double factor = triangle.area_factor * along.weights[a];
      for (std::size_t b = 0; b < static_cast<std::size_t>(triangle.radial_points); ++b) {
        const double t = radial.places[b];
        append_node(nodes, cell_.clamped(pole_ + t * ray), factor * t * radial.weights[b]);
      }
    }
  }

  const NearRequest<3>& request_;
  const Cell<2>& cell_;
  geometry::Point2 pole_;
  ElementJet<3> jet_;
  bool is_own_;
  Metric metric_;
  std::vector<Triangle> triangles_;
};

/// How the speeds of the parameters change over a cell.
struct Distortion {
  /// The largest ratio of a speed in the cell to that at the pole.
  double ratio = 1.0;
  /// By how much of the largest speed one changes, in the direction where it does most.
  double change = 0.0;
  std::size_t direction = 0;
};

Distortion distortion(const NearRequest<3>& request, const Cell<2>& cell, const ElementJet<3>& jet) {
  constexpr std::size_t count = 3;
  std::array<std::array<std::array<double, count>, count>, 2> speed;
  std::array<double, 2> largest{};
  for (std::size_t k = 0; k < count * count; ++k) {
    const geometry::Point2 fraction(0.5 * static_cast<double>(k % count), 0.5 * static_cast<double>(k / count));
    const geometry::Point2 at = cell.lower + fraction.cwiseProduct(cell.upper - cell.lower);
    const ElementJet<3> there = element_jet(request.shape->net, at, request.target);
    for (std::size_t d = 0; d < 2; ++d) {
      speed[d][k % count][k / count] = there.first[d].norm();
      largest[d] = std::max(largest[d], there.first[d].norm());
    }
  }
  Distortion result;
  for (std::size_t d = 0; d < 2; ++d) {
    if (largest[d] == 0.0) continue;
    result.ratio = std::max(result.ratio, largest[d] / std::max(jet.first[d].norm(), 1e-9 * largest[d]));
    for (std::size_t k = 0; k < count * (count - 1); ++k) {
      const std::size_t along = k % (count - 1);
      const std::size_t across = k / (count - 1);
      const std::array<double, 2> change{std::abs(speed[d][along + 1][across] - speed[d][along][across]) / largest[d],
                                         std::abs(speed[d][across][along + 1] - speed[d][across][along]) / largest[d]};
      for (std::size_t direction = 0; direction < 2; ++direction) {
        if (change[direction] <= result.change) continue;
        result.change = change[direction];
        result.direction = direction;
      }
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

void append_cell(const NearRequest<3>& request, const Cell<2>& cell, const NearestPlace<3>& nearest, int depth,
                 NodeBuffer<3>& nodes);

void append_halves(const NearRequest<3>& request, const Cell<2>& cell, std::size_t direction,
                   const NearestPlace<3>& nearest, int depth, NodeBuffer<3>& nodes) {
  const auto [first, second] = bisect(cell, direction, nearest.place);
  for (const Cell<2>& half : {first, second}) {
    const bool holds = half.clamped(nearest.place) == nearest.place;
    append_cell(request, half, holds ? nearest : nearest_place(*request.shape, half, request.target), depth + 1, nodes);
  }
}

void append_cell(const NearRequest<3>& request, const Cell<2>& cell, const NearestPlace<3>& nearest, int depth,
                 NodeBuffer<3>& nodes) {
  constexpr double most_distortion = 3.5;
  constexpr double least_change = 0.25;
  constexpr int cheap = 300;
  const bool is_own = request.is_own && cell.clamped(request.place) == request.place;
  int tensor_points = std::numeric_limits<int>::max();
  std::array<DirectionRule, 2> rules;
  if (!is_own) {
    for (std::size_t d = 0; d < 2; ++d) rules[d] = direction_rule(request, cell, nearest, d);
    if (std::max(rules[0].points, rules[1].points) <= most_points) tensor_points = rules[0].points * rules[1].points;
    if (tensor_points <= cheap) return append_tensor(cell, rules, nodes);
  }
  const PolarRule polar(request, cell, nearest.place, nearest.jet, is_own);
  if (tensor_points <= polar.points()) return append_tensor(cell, rules, nodes);
  const Distortion metric = distortion(request, cell, nearest.jet);
  const bool is_even = metric.ratio <= most_distortion && polar.most_points_on_a_line() <= most_points;
  if (!is_even && metric.change >= least_change && depth < most_bisections)
    return append_halves(request, cell, metric.direction, nearest, depth, nodes);
  polar.append(nodes);
}

/// Lines -------------------------------------------------------------------

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
std::array<int, Dim - 1> plain_orders(const NearRequest<Dim>& request, const NearestPlace<Dim>& nearest, int most) {
  std::array<int, Dim - 1> orders{};
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    const DirectionRule rule = direction_rule(request, Cell<Dim - 1>(), nearest, d);
    if (!rule.map.is_identity() || rule.points > most) return {};
    orders[d] = rule.points;
  }
  return orders;
}

template <>
void near_rule(const NearRequest<3>& request, const NearestPlace<3>& nearest, NodeBuffer<3>& nodes) {
  nodes.size = 0;
  append_cell(request, Cell<2>(), nearest, 0, nodes);
}

template <>
void near_rule(const NearRequest<2>& request, const NearestPlace<2>& nearest, NodeBuffer<2>& nodes) {
  nodes.size = 0;
  if (request.is_own) {
    const SinhMap plain;
    const auto growth = [&](Complex u) { return growth_in(request, Cell<1>(), 0, u); };
    const int degree = 2 * gauss_points(plain, 2.0, request.tolerance, growth);
    append_logarithmic(request.place[0], 0.0, degree, nodes);
    append_logarithmic(request.place[0], 1.0, degree, nodes);
    return;
  }
  const DirectionRule whole = direction_rule(request, Cell<1>(), nearest, 0);
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

template std::array<int, 1> plain_orders(const NearRequest<2>&, const NearestPlace<2>&, int);
template std::array<int, 2> plain_orders(const NearRequest<3>&, const NearestPlace<3>&, int);

}  // namespace isorim::quadrature
