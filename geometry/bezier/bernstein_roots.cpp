#include "geometry/bezier/bernstein_roots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "geometry/bezier/subdivision.h"
#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

/// Row 0 the coefficients, row 1 the tolerances.
using Net = Eigen::Matrix2Xd;

int sign(const Net& net, Eigen::Index i) {
  if (net(0, i) > net(1, i)) return 1;
  return net(0, i) < -net(1, i) ? -1 : 0;
}

/// What the signs of the coefficients tell.
struct Signs {
  Eigen::Index leading_zeros = 0;
  Eigen::Index trailing_zeros = 0;
  int changes = 0;
  /// A zero between equal signs: rounding may hide two more changes.
  bool uncertain = false;
};

Signs signs_of(const Net& net) {
  Signs signs;
  int last = 0;
  Eigen::Index zeros = 0;
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const int here = sign(net, i);
    if (here == 0) {
      ++zeros;
      continue;
    }
    if (last == 0) signs.leading_zeros = zeros;
    if (last == -here) ++signs.changes;
    if (last == here && zeros > 0) signs.uncertain = true;
    last = here;
    zeros = 0;
  }
  (last == 0 ? signs.leading_zeros : signs.trailing_zeros) = zeros;
  return signs;
}

std::pair<Net, Net> bisect(const Net& net) {
  const Eigen::Index count = net.cols();
  Net left(2, count);
  Net right = net;
  for (Eigen::Index step = 0; step < count; ++step) {
    left.col(step) = right.col(0);
    for (Eigen::Index i = 0; i + step + 1 < count; ++i) right.col(i) += 0.5 * (right.col(i + 1) - right.col(i)).eval();
  }
  return {std::move(left), std::move(right)};
}

/// The coefficients of the polynomial divided by t^(leading zeros) (1 - t)^(trailing zeros).
Eigen::VectorXd deflated(const Net& net, const Signs& signs) {
  const Eigen::Index degree = net.cols() - 1;
  const Eigen::Index rest = degree - signs.leading_zeros - signs.trailing_zeros;
  Eigen::VectorXd quotient = net.row(0).segment(signs.leading_zeros, rest + 1).transpose();
  if (rest == degree) return quotient;
  // binomial(degree, j + leading) / binomial(rest, j), up to a common factor.
  double ratio = 1.0;
  for (Eigen::Index j = 1; j <= rest; ++j) {
    const Eigen::Index i = j + signs.leading_zeros;
    ratio *= static_cast<double>((degree - i + 1) * j) / static_cast<double>(i * (rest - j + 1));
    quotient[j] *= ratio;
  }
  return quotient;
}

struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// By de Casteljau's triangle, which runs in `work`.
ValueAndSlope evaluate(const Eigen::VectorXd& coefficients, double t, std::vector<double>& work) {
  work.assign(coefficients.begin(), coefficients.end());
  double slope = 0.0;
  for (std::size_t last = work.size() - 1; last > 0; --last) {
    if (last == 1) slope = static_cast<double>(work.size() - 1) * (work[1] - work[0]);
    for (std::size_t i = 0; i < last; ++i) work[i] += t * (work[i + 1] - work[i]);
  }
  return {work[0], slope};
}

/// Where the control polygon, which changes sign once, is zero.
double polygon_root(const Eigen::VectorXd& coefficients) {
  const bool starts_positive = coefficients[0] > 0.0;
  Eigen::Index i = 1;
  while (i + 1 < coefficients.size() && (coefficients[i] > 0.0) == starts_positive) ++i;
  const double before = coefficients[i - 1];
  const double fraction = before / (before - coefficients[i]);
  return (static_cast<double>(i - 1) + fraction) / static_cast<double>(coefficients.size() - 1);
}

/// The root in (0, 1) of a polynomial whose end coefficients have opposite signs: Newton's method, bisecting wherever
/// it leaves the bracket or does not halve its steps (Press et al., Numerical Recipes, section 9.4).
double bracketed_root(const Eigen::VectorXd& coefficients) {
  double t = polygon_root(coefficients);
  if (coefficients.size() == 2) return t;
  constexpr int most_steps = 200;
  constexpr double resolution = 0.5 * std::numeric_limits<double>::epsilon();
  const bool starts_positive = coefficients[0] > 0.0;
  Interval bracket;
  std::vector<double> work;
  double step_before_last = 1.0;
  double last_step = 1.0;
  for (int i = 0; i < most_steps; ++i) {
    const ValueAndSlope here = evaluate(coefficients, t, work);
    if (here.value == 0.0) return t;
    ((here.value > 0.0) == starts_positive ? bracket.first : bracket.last) = t;
    double next = t - here.value / here.slope;
    const bool slow = std::abs(next - t) > 0.5 * std::abs(step_before_last);
    if (slow || !(next > bracket.first && next < bracket.last)) next = bracket.middle();
    step_before_last = std::exchange(last_step, next - t);
    t = next;
    if (std::abs(last_step) <= resolution * t) break;
  }
  return t;
}

class RootSearch {
 public:
  void search(const Net& net, Interval range, int depth = 0) {
    constexpr int deepest = 52;
    const Signs signs = signs_of(net);
    if (signs.leading_zeros == net.cols() || depth == deepest) return report(range);
    if (signs.changes <= 1 && !signs.uncertain) {
      if (signs.leading_zeros > 0) report({range.first, range.first});
      if (signs.changes == 1) {
        const double t = range.first + range.length() * bracketed_root(deflated(net, signs));
        report({t, t});
      }
      if (signs.trailing_zeros > 0) report({range.last, range.last});
      return;
    }
    const auto [left, right] = bisect(net);
    search(left, {range.first, range.middle()}, depth + 1);
    search(right, {range.middle(), range.last}, depth + 1);
  }

  /// Neighbours between which `whole` is zero within twice the tolerance (that of its value and that of its bound by
  /// the coefficients) are one root.
  std::vector<Interval> merged(const Net& whole) const {
    std::vector<Interval> result;
    for (const Interval& root : roots_) {
      if (!result.empty() && is_zero(whole, {result.back().last, root.first}))
        result.back().last = root.last;
      else
        result.push_back(root);
    }
    return result;
  }

 private:
  static bool is_zero(Net net, Interval range) {
    const int degree = static_cast<int>(net.cols()) - 1;
    restrict_net({net.data(), static_cast<std::size_t>(net.size())}, 2, {&degree, 1}, 0, range);
    net.row(1) *= 2.0;
    return signs_of(net).leading_zeros == net.cols();
  }

  void report(Interval root) {
    if (!roots_.empty() && root.first <= roots_.back().last)
      roots_.back().last = std::max(roots_.back().last, root.last);
    else
      roots_.push_back(root);
  }

  std::vector<Interval> roots_;
};

std::vector<Interval> roots_of(const Net& net) {
  if (net.cols() == 0) throw GeometryError("roots of a polynomial: no coefficient");
  for (Eigen::Index i = 0; i < net.cols(); ++i)
    if (!std::isfinite(net(0, i)) || !std::isfinite(net(1, i)))
      throw GeometryError(fmt::format("roots of a polynomial: coefficient {} is {}, its tolerance {}; expected finite",
                                      i, net(0, i), net(1, i)));
  RootSearch search;
  search.search(net, {0.0, 1.0});
  return search.merged(net);
}

}  // namespace

std::vector<Interval> bernstein_roots(std::span<const double> coefficients, std::span<const double> tolerances) {
  if (coefficients.size() != tolerances.size())
    throw GeometryError(fmt::format("roots of a polynomial: {} coefficients but {} tolerances", coefficients.size(),
                                    tolerances.size()));
  Net net(2, static_cast<Eigen::Index>(coefficients.size()));
  for (Eigen::Index i = 0; i < net.cols(); ++i)
    net.col(i) << coefficients[static_cast<std::size_t>(i)], tolerances[static_cast<std::size_t>(i)];
  return roots_of(net);
}

std::vector<Interval> bernstein_roots(std::span<const double> coefficients, double tolerance) {
  Net net(2, static_cast<Eigen::Index>(coefficients.size()));
  for (Eigen::Index i = 0; i < net.cols(); ++i) net.col(i) << coefficients[static_cast<std::size_t>(i)], tolerance;
  return roots_of(net);
}

}  // namespace isorim::geometry
