#include "solver/bem/ray_rule.h"

#include <map>
#include <mutex>

#include "quadrature/gauss_legendre.h"

namespace isorim::solver {

namespace {

/// P_0, ..., P_degree at 2 s - 1.
std::vector<double> legendre(int degree, double s) {
  std::vector<double> p(static_cast<std::size_t>(degree) + 1, 1.0);
  const double x = 2.0 * s - 1.0;
  if (degree > 0) p[1] = x;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const auto k = static_cast<double>(i);
    p[i + 1] = ((2.0 * k + 1.0) * x * p[i] - k * p[i - 1]) / (k + 1.0);
  }
  return p;
}

/// int_0^1 P_i(2 s - 1) (-ln s) ds.
double log_moment(int i) {
  if (i == 0) return 1.0;
  return (i % 2 == 0 ? 1.0 : -1.0) / (static_cast<double>(i) * (i + 1));
}

/// int_0^1 P_i(2 s - 1) s (-ln s) ds, by s = (1 + x) / 2 and the recurrence of x P_i.
double linear_log_moment(int i) {
  const double below = i > 0 ? i * log_moment(i - 1) : 0.0;
  return 0.5 * (log_moment(i) + ((i + 1) * log_moment(i + 1) + below) / (2 * i + 1));
}

RayRule make_ray_rule(int n) {
  const quadrature::Rule& gauss = quadrature::gauss_legendre(n);
  const auto count = static_cast<std::size_t>(n);
  RayRule rule{gauss.nodes, gauss.weights, std::vector<double>(count, 0.0), std::vector<double>(2 * count)};
  for (std::size_t k = 0; k < count; ++k) {
    const std::vector<double> p = legendre(n - 1, rule.nodes[k]);
    for (int i = 0; i < n; ++i) {
      const double coefficient = (2 * i + 1) * rule.weights[k] * p[static_cast<std::size_t>(i)];
      rule.log_weights[k] += coefficient * linear_log_moment(i);
      if (i >= n - 2) rule.tail[static_cast<std::size_t>(i - (n - 2)) * count + k] = coefficient;
    }
  }
  return rule;
}

}  // namespace

const RayRule& ray_rule(int n) {
  static std::mutex mutex;
  static std::map<int, RayRule> rules;
  const std::lock_guard lock(mutex);
  const auto found = rules.find(n);
  return found != rules.end() ? found->second : rules.emplace(n, make_ray_rule(n)).first->second;
}

}  // namespace isorim::solver
