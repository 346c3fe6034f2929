#include "quadrature/element_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace isorim::quadrature {

namespace {

/// The area vector of the cell at a place, or the line's tangent.
template <int Dim>
geometry::Vector<Dim> jacobian(const ElementJet<Dim>& jet) {
  if constexpr (Dim == 2) {
    return jet.first[0];
  } else {
    const geometry::Vector3& u = jet.first[0];
    const geometry::Vector3& v = jet.first[1];
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  }
}

double chebyshev_place(int k, int count) {
  return 0.5 - 0.5 * std::cos(std::numbers::pi * (k + 0.5) / count);
}

/// Raises each of `sizes` to the size of that Chebyshev coefficient of values taken at the points above.
template <class Value>
void add_coefficients(const std::vector<Value>& values, std::vector<double>& sizes) {
  const auto count = static_cast<int>(values.size());
  for (int j = 0; j < count; ++j) {
    Value sum = Value::Zero();
    for (int k = 0; k < count; ++k)
      sum += std::cos(std::numbers::pi * j * (k + 0.5) / count) * values[static_cast<std::size_t>(k)];
    double& size = sizes[static_cast<std::size_t>(j)];
    size = std::max(size, (j == 0 ? 1.0 : 2.0) / count * sum.norm());
  }
}

/// Sizes of Chebyshev coefficients, relative to the largest value.
struct Spectrum {
  std::vector<double> sizes;

  /// The last few fall below the tolerance.
  bool is_resolved(double tolerance) const { return *std::max_element(sizes.end() - 3, sizes.end()) <= tolerance; }
};

/// Of the Jacobian and its length (which is no polynomial, whatever the element), from `count` points on each of a few
/// parameter lines. Seen from the element's centre: rounding is relative to its own size then, wherever it lies.
template <int Dim>
Spectrum jacobian_spectrum(const ElementShape<Dim>& shape, std::size_t direction, int count) {
  using Value = Eigen::Matrix<double, Dim + 1, 1>;
  Spectrum spectrum{std::vector<double>(static_cast<std::size_t>(count), 0.0)};
  std::vector<Value> values(static_cast<std::size_t>(count));
  const std::vector<double> lines = Dim == 2 ? std::vector{0.0} : std::vector{0.05, 0.5, 0.95};
  double largest = std::numeric_limits<double>::min();
  for (const double line : lines) {
    geometry::Point<Dim - 1> place = geometry::Point<Dim - 1>::Constant(line);
    for (int k = 0; k < count; ++k) {
      place[static_cast<Eigen::Index>(direction)] = chebyshev_place(k, count);
      const geometry::Vector<Dim> normal = jacobian(element_jet<Dim>(shape.net, place, shape.centre));
      values[static_cast<std::size_t>(k)] << normal, normal.norm();
      largest = std::max(largest, normal.norm());
    }
    add_coefficients(values, spectrum.sizes);
  }
  for (double& size : spectrum.sizes) size /= largest;
  return spectrum;
}

/// With as many points as it takes.
template <int Dim>
Growth jacobian_growth(const ElementShape<Dim>& shape, std::size_t direction, double field_degree, double tolerance) {
  constexpr int most_points = 150;
  constexpr double rounding = 1e-14;
  const double negligible = std::max(0.03 * tolerance, rounding);
  int count = 4 * shape.net.degree[direction] + 8;
  Spectrum spectrum = jacobian_spectrum(shape, direction, count);
  while (!spectrum.is_resolved(negligible) && count < most_points) {
    count *= 2;
    spectrum = jacobian_spectrum(shape, direction, count);
  }
  for (double& size : spectrum.sizes) size = size > negligible ? size : 0.0;
  return {spectrum.sizes, field_degree};
}

template <int Dim>
void add_samples(ElementShape<Dim>& shape) {
  constexpr std::array<double, 4> places{0.03, 0.33, 0.67, 0.97};
  constexpr std::size_t count = Dim == 2 ? 4 : 16;
  for (std::size_t k = 0; k < count; ++k) {
    geometry::Point<Dim - 1> place;
    place[0] = places[k % 4];
    if constexpr (Dim == 3) place[1] = places[k / 4];
    const ElementJet<Dim> jet = element_jet<Dim>(shape.net, place, geometry::Point<Dim>::Zero());
    shape.samples.push_back({place, jet.offset, jet.first});
  }
}

template <int Dim>
void set_sphere(ElementShape<Dim>& shape) {
  int count = 1;
  for (const int degree : shape.net.degree) count *= degree + 1;
  const Eigen::Map<const geometry::HomogeneousPoints<Dim>> net(shape.net.points, Dim + 1, count);
  const geometry::Points<Dim> points = net.template topRows<Dim>().array().rowwise() / net.row(Dim).array();
  shape.centre = 0.5 * (points.rowwise().minCoeff() + points.rowwise().maxCoeff());
  shape.radius = (points.colwise() - shape.centre).colwise().norm().maxCoeff();
}

/// From the samples and the corners, beyond which speeds grow further.
template <int Dim>
void set_half_length(ElementShape<Dim>& shape) {
  constexpr double share = 0.55;
  const auto raise = [&](const auto& speeds) {
    for (std::size_t d = 0; d < Dim - 1; ++d)
      shape.half_length[d] = std::max(shape.half_length[d], share * speeds[d].norm());
  };
  for (const auto& sample : shape.samples) raise(sample.first);
  for (int corner = 0; corner < (Dim == 2 ? 2 : 4); ++corner) {
    geometry::Point<Dim - 1> place;
    place[0] = corner % 2;
    if constexpr (Dim == 3) place[1] = corner < 2 ? 0.0 : 1.0;
    raise(element_jet<Dim>(shape.net, place, geometry::Point<Dim>::Zero()).first);
  }
}

/// Newton's direction for |offset|^2 / 2, or that of Gauss and Newton where the Hessian is not positive, within the
/// directions that are free.
template <int Dim>
geometry::Vector<Dim - 1> newton_step(const ElementJet<Dim>& jet, const geometry::Vector<Dim - 1>& slope,
                                      const std::array<bool, Dim - 1>& is_free) {
  constexpr double least_sine = 1e-6;
  geometry::Vector<Dim - 1> step = geometry::Vector<Dim - 1>::Zero();
  double first[Dim - 1];
  double full[Dim - 1];
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    first[d] = std::max(jet.first[d].squaredNorm(), std::numeric_limits<double>::min());
    full[d] = first[d] + jet.offset.dot(jet.second[d]);
    if (full[d] < 0.2 * first[d]) full[d] = first[d];
  }
  if constexpr (Dim == 3) {
    if (is_free[0] && is_free[1]) {
      double mixed = jet.first[0].dot(jet.first[1]) + jet.offset.dot(jet.second[2]);
      double determinant = full[0] * full[1] - mixed * mixed;
      if (determinant < least_sine * full[0] * full[1]) {
        mixed = 0.0;
        determinant = full[0] * full[1];
      }
      return {(mixed * slope[1] - full[1] * slope[0]) / determinant,
              (mixed * slope[0] - full[0] * slope[1]) / determinant};
    }
  }
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    if (is_free[d]) step[i] = -slope[i] / full[d];
  }
  return step;
}

/// One step down, along the cell's sides where it ends there; false if there is none.
template <int Dim>
bool descend(const ElementShape<Dim>& shape, const Cell<Dim - 1>& cell, const geometry::Point<Dim>& target,
             NearestPlace<Dim>& best) {
  geometry::Vector<Dim - 1> slope;
  std::array<bool, Dim - 1> is_free{};
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    slope[i] = best.jet.offset.dot(best.jet.first[d]);
    is_free[d] =
        !(best.place[i] <= cell.lower[i] && slope[i] > 0.0) && !(best.place[i] >= cell.upper[i] && slope[i] < 0.0);
  }
  geometry::Vector<Dim - 1> step = newton_step<Dim>(best.jet, slope, is_free);
  for (int halving = 0; halving < 6; ++halving, step *= 0.35) {
    const geometry::Point<Dim - 1> place = cell.clamped(best.place + step);
    if ((place - best.place).template lpNorm<Eigen::Infinity>() < 1e-9) return false;
    const ElementJet<Dim> jet = element_jet(shape.net, place, target);
    const double distance = jet.offset.norm();
    if (distance >= best.distance) continue;
    const bool is_worth_more = distance < 0.999 * best.distance || (place - best.place).norm() > 1e-4;
    best = {place, jet, distance};
    return is_worth_more;
  }
  return false;
}

/// Newton's method for the quartic; the guess where it leads elsewhere.
template <int Dim>
std::complex<double> refined(const geometry::Vector<Dim>& offset, const geometry::Vector<Dim>& tangent,
                             const geometry::Vector<Dim>& curvature, std::complex<double> guess) {
  constexpr int most_steps = 5;
  std::complex<double> t = guess;
  for (int step = 0; step < most_steps; ++step) {
    std::complex<double> value = 0.0;
    std::complex<double> slope = 0.0;
    for (int c = 0; c < Dim; ++c) {
      const std::complex<double> d = offset[c] + t * (tangent[c] + 0.5 * t * curvature[c]);
      value += d * d;
      slope += 2.0 * d * (tangent[c] + t * curvature[c]);
    }
    if (std::norm(slope) == 0.0) return guess;
    const std::complex<double> change = value / slope;
    t -= change;
    if (std::norm(change) < 1e-6 * std::norm(t)) break;
  }
  t.imag(std::abs(t.imag()));
  return std::norm(t - guess) < 0.5 * std::norm(guess) ? t : guess;
}

}  // namespace

template <int Dim>
ElementShape<Dim> plain_shape(const ElementNet<Dim>& net) {
  ElementShape<Dim> shape;
  shape.net = net;
  set_sphere(shape);
  add_samples(shape);
  set_half_length(shape);
  return shape;
}

template <int Dim>
ElementShape<Dim> element_shape(const ElementNet<Dim>& net, double field_degree, double tolerance) {
  ElementShape<Dim> shape = plain_shape(net);
  for (std::size_t d = 0; d < Dim - 1; ++d) shape.growth[d] = jacobian_growth(shape, d, field_degree, tolerance);
  return shape;
}

template <int Dim>
NearestPlace<Dim> nearest_place(const ElementShape<Dim>& shape, const Cell<Dim - 1>& cell,
                                const geometry::Point<Dim>& target) {
  constexpr int most_steps = 20;
  // The nearest sample, by what its tangent plane promises of the cell.
  double least = std::numeric_limits<double>::max();
  geometry::Point<Dim - 1> start = cell.lower;
  for (const auto& sample : shape.samples) {
    const double squared = (sample.position - target).squaredNorm();
    if (squared < least) {
      least = squared;
      start = sample.place;
    }
  }
  NearestPlace<Dim> best;
  best.place = cell.clamped(start);
  best.jet = element_jet(shape.net, best.place, target);
  best.distance = best.jet.offset.norm();
  for (int step = 0; step < most_steps && descend(shape, cell, target, best); ++step) {
  }
  return best;
}

template <int Dim>
std::complex<double> singularity_on_line(const geometry::Vector<Dim>& offset, const geometry::Vector<Dim>& tangent,
                                         const geometry::Vector<Dim>& curvature) {
  const double length = tangent.squaredNorm();
  const double a = std::max(length + offset.dot(curvature), 0.25 * length);
  const double b = offset.dot(tangent);
  const double c = offset.squaredNorm();
  if (!(a > 1e-30 * c)) return {0.0, 1e15};
  const std::complex<double> guess = std::complex<double>(-b, std::sqrt(std::max(a * c - b * b, 0.0))) / a;
  return offset.dot(curvature) == 0.0 && tangent.dot(curvature) == 0.0
             ? guess
             : refined<Dim>(offset, tangent, curvature, guess);
}

template ElementShape<2> plain_shape(const ElementNet<2>&);
template ElementShape<3> plain_shape(const ElementNet<3>&);
template ElementShape<2> element_shape(const ElementNet<2>&, double, double);
template ElementShape<3> element_shape(const ElementNet<3>&, double, double);
template NearestPlace<2> nearest_place(const ElementShape<2>&, const Cell<1>&, const geometry::Point2&);
template NearestPlace<3> nearest_place(const ElementShape<3>&, const Cell<2>&, const geometry::Point3&);
template std::complex<double> singularity_on_line<2>(const geometry::Vector2&, const geometry::Vector2&,
                                                     const geometry::Vector2&);
template std::complex<double> singularity_on_line<3>(const geometry::Vector3&, const geometry::Vector3&,
                                                     const geometry::Vector3&);

}  // namespace isorim::quadrature
