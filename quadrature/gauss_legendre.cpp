#include "quadrature/gauss_legendre.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <numbers>

namespace isorim::quadrature {

namespace {

struct LegendreValue {
  long double value;
  long double derivative;
};

LegendreValue legendre(int n, long double x) {
  long double previous = 1.0L;
  long double current = x;
  for (int k = 2; k <= n; ++k) {
    const long double next = ((2 * k - 1) * x * current - (k - 1) * previous) / k;
    previous = current;
    current = next;
  }
  return {current, n * (x * current - previous) / (x * x - 1.0L)};
}

/// The i-th largest root of P_n, from Tricomi's initial guess.
long double legendre_root(int n, int i) {
  if (2 * i + 1 == n) return 0.0L;
  const long double angle = std::numbers::pi_v<long double> * (4 * i + 3) / (4 * n + 2);
  long double x = (1.0L - (n - 1.0L) / (8.0L * n * n * n)) * std::cos(angle);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const LegendreValue p = legendre(n, x);
    const long double step = p.value / p.derivative;
    x -= step;
    if (std::abs(step) < 1e-19L) break;
  }
  return x;
}

Rule make_rule(int n) {
  const auto count = static_cast<std::size_t>(n);
  Rule rule{std::vector<double>(count), std::vector<double>(count)};
  if (n == 1) return {{0.5}, {1.0}};
  for (std::size_t i = 0; i < (count + 1) / 2; ++i) {
    const long double x = legendre_root(n, static_cast<int>(i));
    const long double derivative = legendre(n, x).derivative;
    const auto weight = static_cast<double>(1.0L / ((1.0L - x * x) * derivative * derivative));
    rule.nodes[i] = static_cast<double>(0.5L * (1.0L - x));
    rule.nodes[count - 1 - i] = static_cast<double>(0.5L * (1.0L + x));
    rule.weights[i] = rule.weights[count - 1 - i] = weight;
  }
  return rule;
}

}  // namespace

const Rule& gauss_legendre(int n) {
  assert(1 <= n && n <= max_gauss_points);
  struct Slot {
    std::once_flag once;
    Rule rule;
  };
  static std::array<Slot, max_gauss_points + 1> slots;
  Slot& slot = slots[static_cast<std::size_t>(n)];
  std::call_once(slot.once, [&] { slot.rule = make_rule(n); });
  return slot.rule;
}

}  // namespace isorim::quadrature
