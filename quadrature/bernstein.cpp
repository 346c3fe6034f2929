#include "quadrature/bernstein.h"

#include <array>
#include <cassert>
#include <cstddef>
#include <mutex>

#include "geometry/spline/knot_vector.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::quadrature {

namespace {

/// All Bernstein polynomials of `degree` at u, by the recurrence of Piegl & Tiller, A1.3.
std::vector<double> bernstein_values(int degree, double u) {
  std::vector<double> values(static_cast<std::size_t>(degree) + 1, 0.0);
  values[0] = 1.0;
  for (int k = 1; k <= degree; ++k) {
    double saved = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(k); ++i) {
      const double value = values[i];
      values[i] = saved + (1.0 - u) * value;
      saved = u * value;
    }
    values[static_cast<std::size_t>(k)] = saved;
  }
  return values;
}

BernsteinTable make_table(int degree, int points) {
  BernsteinTable table{degree, points, {}, {}};
  for (const double u : gauss_legendre(points).nodes) {
    const BernsteinValues at_node = bernstein_polynomials(degree, u);
    table.values.insert(table.values.end(), at_node.values.begin(), at_node.values.end());
    table.derivatives.insert(table.derivatives.end(), at_node.derivatives.begin(), at_node.derivatives.end());
  }
  return table;
}

}  // namespace

BernsteinValues bernstein_polynomials(int degree, double u) {
  BernsteinValues result{bernstein_values(degree, u), {}};
  const std::vector<double> lower = bernstein_values(degree - 1, u);
  for (int i = 0; i <= degree; ++i) {
    const double left = i > 0 ? lower[static_cast<std::size_t>(i - 1)] : 0.0;
    const double right = i < degree ? lower[static_cast<std::size_t>(i)] : 0.0;
    result.derivatives.push_back(degree * (left - right));
  }
  return result;
}

const BernsteinTable& bernstein_table(int degree, int points) {
  assert(1 <= degree && degree <= geometry::KnotVector::max_degree);
  assert(1 <= points && points <= max_gauss_points);
  struct Slot {
    std::once_flag once;
    BernsteinTable table;
  };
  static std::array<std::array<Slot, max_gauss_points + 1>, geometry::KnotVector::max_degree + 1> slots;
  Slot& slot = slots[static_cast<std::size_t>(degree)][static_cast<std::size_t>(points)];
  std::call_once(slot.once, [&] { slot.table = make_table(degree, points); });
  return slot.table;
}

}  // namespace isorim::quadrature
