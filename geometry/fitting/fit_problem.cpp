#include "geometry/fitting/fit_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/fitting/derivative_row.h"
#include "geometry/fitting/gauss_points.h"
#include "geometry/fitting/span_order.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

namespace {

constexpr std::size_t capacity = KnotVector::max_degree + 1;

/// The control point next to a natural end as the mean of its neighbours: c1 = outer * c0 + inner * c2.
struct NaturalEnd {
  double outer = 0.0;
  double inner = 0.0;
};

/// The rows of a fit with the constrained control points taken out: those columns become zero.
template <int Dim>
class ConstrainedRows {
 public:
  ConstrainedRows(const FitSpace& space, const FitConstraints<Dim>& constraints)
      : degree_(space.knots.degree()), count_(space.knots.basis_count()), system_(space, Dim) {
    if (constraints.fixed.empty()) return;
    fixed_.assign(static_cast<std::size_t>(count_), -1);
    points_.resize(Dim, count_);
    for (const auto& [function, point] : constraints.fixed) fix(function, point);
    const KnotVector& knots = space.knots;
    const auto natural = [](double nearer, double farther) {
      return NaturalEnd{farther / (nearer + farther), nearer / (nearer + farther)};
    };
    if (constraints.natural_start) {
      start_ = natural(knots[degree_ + 1] - knots[1], knots[degree_ + 2] - knots[2]);
      has_start_ = true;
    }
    if (constraints.natural_end) {
      end_ = natural(knots[count_ + degree_ - 1] - knots[count_ - 1], knots[count_ + degree_ - 2] - knots[count_ - 2]);
      has_end_ = true;
    }
  }

  void add(int first, double* values, double* rhs) {
    if (!fixed_.empty()) {
      if (has_start_ && first <= 1) replace(values, rhs, 1 - first, -1, 1, start_, points_.col(0));
      if (has_end_ && first + degree_ >= count_ - 2)
        replace(values, rhs, count_ - 2 - first, 1, -1, end_, points_.col(count_ - 1));
      for (int j = 0; j <= degree_; ++j) {
        if (fixed_[static_cast<std::size_t>(first + j)] < 0) continue;
        for (int d = 0; d < Dim; ++d) rhs[d] -= values[j] * points_(d, first + j);
        values[j] = 0.0;
      }
    }
    system_.add(first, {values, static_cast<std::size_t>(degree_) + 1}, {rhs, Dim});
  }

  Points<Dim> solve() {
    for (int i = 0; i < static_cast<int>(fixed_.size()); ++i)
      if (fixed_[static_cast<std::size_t>(i)] >= 0) add_unit_row(i, points_.col(i));
    if (has_start_) add_unit_row(1, Point<Dim>::Zero());
    if (has_end_) add_unit_row(count_ - 2, Point<Dim>::Zero());
    Points<Dim> solution = system_.solve();
    if (solution.cols() == 0) return solution;
    if (has_start_) solution.col(1) = start_.outer * solution.col(0) + start_.inner * solution.col(2);
    if (has_end_)
      solution.col(count_ - 2) = end_.outer * solution.col(count_ - 1) + end_.inner * solution.col(count_ - 3);
    return solution;
  }

 private:
  void fix(int function, const Point<Dim>& point) {
    fixed_[static_cast<std::size_t>(function)] = function;
    points_.col(function) = point;
  }

  /// Distributes the column at `place` to its outer (fixed) and inner neighbours.
  void replace(double* values, double* rhs, int place, int outer, int inner, const NaturalEnd& end,
               const Point<Dim>& outer_point) {
    const double value = values[place];
    if (place + outer >= 0 && place + outer <= degree_)
      values[place + outer] += value * end.outer;
    else
      for (int d = 0; d < Dim; ++d) rhs[d] -= value * end.outer * outer_point[d];
    values[place + inner] += value * end.inner;
    values[place] = 0.0;
  }

  void add_unit_row(int function, const Point<Dim>& point) {
    std::array<double, capacity> values{};
    const int first = std::min(function, count_ - degree_ - 1);
    values[static_cast<std::size_t>(function - first)] = 1.0;
    system_.add(first, {values.data(), static_cast<std::size_t>(degree_) + 1}, {point.data(), Dim});
  }

  int degree_;
  int count_;
  SplineLeastSquares system_;
  /// -1 for free control points; empty if all are free.
  std::vector<int> fixed_;
  Points<Dim> points_;
  bool has_start_ = false;
  bool has_end_ = false;
  NaturalEnd start_;
  NaturalEnd end_;
};

/// Rows of the data in one span.
template <int Dim>
void add_data(const KnotVector& knots, int span, const FitData<Dim>& data, std::span<const double> parameters,
              std::span<const int> members, ConstrainedRows<Dim>& rows) {
  const double share = 1.0 / static_cast<double>(data.size());
  LocalBasisTable<0> table(knots.degree() + 1, 1);
  for (const int member : members) {
    const std::size_t i = static_cast<std::size_t>(member);
    const double factor = std::sqrt(data.weights[i] * share);
    fill_basis_table(knots, span, parameters[i], table);
    table *= factor;
    Point<Dim> rhs = factor * data.points.col(member);
    rows.add(span - knots.degree(), table.data(), rhs.data());
  }
}

/// Rows whose squares add up to the fairness term over one span.
template <int Dim>
void add_fairness(const KnotVector& knots, int span, const Fairness& fairness, std::span<const GaussPoint> rule,
                  ConstrainedRows<Dim>& rows) {
  const double length = knots[span + 1] - knots[span];
  const double mu =
      fairness.mu *
      (fairness.factors.empty() ? 1.0 : fairness.factors[static_cast<std::size_t>(span - knots.degree())]);
  LocalBasisTable<0> row(knots.degree() + 1, 1);
  for (const GaussPoint& gauss : rule) {
    fill_basis_derivative(knots, span, knots[span] + gauss.node * length, fairness.derivative, row.data());
    row *= std::sqrt(mu * gauss.weight * length);
    Point<Dim> rhs = Point<Dim>::Zero();
    rows.add(span - knots.degree(), row.data(), rhs.data());
  }
}

}  // namespace

template <int Dim>
Points<Dim> solve_fit(const FitSpace& space, const FitData<Dim>& data, std::span<const double> parameters,
                      const Fairness& fairness, const FitConstraints<Dim>& constraints) {
  const KnotVector& knots = space.knots;
  const int p = knots.degree();
  const SpanOrder sorted(knots, parameters);
  std::vector<GaussPoint> rule;
  if (fairness.mu > 0.0 && fairness.derivative <= p) rule = gauss_points(p - fairness.derivative + 1);
  ConstrainedRows<Dim> rows(space, constraints);
  for (int span = p; span < knots.basis_count(); ++span) {
    if (!(knots[span] < knots[span + 1])) continue;
    add_data(knots, span, data, parameters, sorted.of(span - p), rows);
    add_fairness(knots, span, fairness, rule, rows);
  }
  return rows.solve();
}

template Points<2> solve_fit(const FitSpace&, const FitData<2>&, std::span<const double>, const Fairness&,
                             const FitConstraints<2>&);
template Points<3> solve_fit(const FitSpace&, const FitData<3>&, std::span<const double>, const Fairness&,
                             const FitConstraints<3>&);

}  // namespace isorim::geometry
