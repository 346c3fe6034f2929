#include "geometry/spline/smoothest_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/interpolation.h"

namespace isorim::geometry {
namespace {

/// Gauss-Legendre with three points on [-1, 1]: exact up to degree 5, so for squares of piecewise quadratics.
constexpr std::array<double, 3> gauss_points{-0.7745966692414834, 0.0, 0.7745966692414834};
constexpr std::array<double, 3> gauss_weights{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

/// Entry (i, j) is the integral of the products of the derivatives of the given order, in the parameter scaled to
/// [0, 1] (the scale changes nothing but the size of the numbers).
Eigen::MatrixXd energy_matrix(const KnotVector& knots, int order) {
  const int p = knots.degree();
  const double scale = std::pow(knots.domain().length(), 2 * order - 1);
  const std::vector<double> breaks = knots.breakpoints();
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(knots.basis_count(), knots.basis_count());
  for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
    const double half = 0.5 * (breaks[s + 1] - breaks[s]);
    for (std::size_t g = 0; g < gauss_points.size(); ++g) {
      const double u = breaks[s] + half * (1.0 + gauss_points[g]);
      const int span = knots.find_span(u);
      const Eigen::VectorXd row = basis_derivatives(knots, span, u, order).row(order);
      energy.block(span - p, span - p, p + 1, p + 1) += (scale * half * gauss_weights[g]) * row * row.transpose();
    }
  }
  return energy;
}

void check_conditions(const KnotVector& knots, const SmoothestSpline::Conditions& given) {
  const std::vector<double>& t = given.parameters;
  const Interval domain = knots.domain();
  if (t.size() < 2 || t.front() != domain.first || t.back() != domain.last || !knots.is_clamped()) {
    throw GeometryError(
        fmt::format("smoothest spline: {} parameters; expected at least two, from one end of clamped knots over "
                    "[{}, {}] to the other",
                    t.size(), domain.first, domain.last));
  }
  const auto fall = std::adjacent_find(t.begin(), t.end(), [](double a, double b) { return !(a < b); });
  if (fall != t.end())
    throw GeometryError(
        fmt::format("smoothest spline: parameter {} is followed by {}; expected rising ones", *fall, *std::next(fall)));
}

/// The functions that live on (a, b).
std::pair<int, int> functions_on(const KnotVector& knots, double a, double b) {
  int first = 0;
  while (knots[first + knots.degree() + 1] <= a) ++first;
  int last = knots.basis_count() - 1;
  while (knots[last] >= b) --last;
  return {first, last};
}

Eigen::MatrixXd columns(const Eigen::MatrixXd& matrix, const std::vector<int>& chosen) {
  Eigen::MatrixXd result(matrix.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k) result.col(static_cast<Eigen::Index>(k)) = matrix.col(chosen[k]);
  return result;
}

/// All solutions of constraint x = b are x = particular b + null w.
struct SolutionSpace {
  Eigen::MatrixXd particular;
  Eigen::MatrixXd null;
};
SolutionSpace solution_space(const Eigen::MatrixXd& constraint) {
  const Eigen::Index rows = constraint.rows();
  const Eigen::Index unknowns = constraint.cols();
  if (rows == 0) return {Eigen::MatrixXd(unknowns, 0), Eigen::MatrixXd::Identity(unknowns, unknowns)};
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(constraint.transpose());
  if (rows > unknowns || qr.rank() < rows) {
    throw GeometryError(
        fmt::format("smoothest spline: {} functions cannot meet {} conditions where these lie; "
                    "expected more knots there",
                    unknowns, rows));
  }
  // constraint = P R^T Q^T, so its solution in the range is Q R^-T P^T b.
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(unknowns, unknowns);
  const Eigen::MatrixXd permuted = qr.colsPermutation().transpose() * Eigen::MatrixXd::Identity(rows, rows);
  const Eigen::MatrixXd triangle = qr.matrixR().topLeftCorner(rows, rows);
  return {q.leftCols(rows) * triangle.triangularView<Eigen::Upper>().transpose().solve(permuted),
          q.rightCols(unknowns - rows)};
}

}  // namespace

SmoothestSpline::SmoothestSpline(const KnotVector& knots, Conditions conditions) : conditions_(std::move(conditions)) {
  check_conditions(knots, conditions_);
  const std::vector<double>& t = conditions_.parameters;
  const int data = static_cast<int>(t.size());
  const int functions = knots.basis_count();
  fixed_by_.assign(static_cast<std::size_t>(functions), not_fixed);
  std::vector<bool> in_run(t.size(), false);
  for (const ConstantRun& run : conditions_.runs) {
    const auto [first, last] =
        functions_on(knots, t[static_cast<std::size_t>(run.first)], t[static_cast<std::size_t>(run.last)]);
    std::fill(fixed_by_.begin() + first, fixed_by_.begin() + last + 1, run.first);
    std::fill(in_run.begin() + run.first, in_run.begin() + run.last + 1, true);
  }
  for (const int function : conditions_.zeros) {
    if (function <= 0 || function + 1 >= functions)
      throw GeometryError(
          fmt::format("smoothest spline: function {} cannot be 0; expected an inner one of {}", function, functions));
    if (fixed_by_[static_cast<std::size_t>(function)] == not_fixed)
      fixed_by_[static_cast<std::size_t>(function)] = zero;
  }
  fixed_by_.front() = std::max(fixed_by_.front(), 0);
  if (fixed_by_.back() == not_fixed) fixed_by_.back() = data - 1;
  in_run.front() = true;
  in_run.back() = true;
  for (int i = 0; i < functions; ++i) {
    if (fixed_by_[static_cast<std::size_t>(i)] == not_fixed) free_.push_back(i);
  }
  for (int k = 0; k < data; ++k) {
    if (!in_run[static_cast<std::size_t>(k)]) met_.push_back(k);
  }

  const Eigen::MatrixXd collocation = collocation_matrix(knots, t);
  const bool has_level_row = conditions_.is_level_at_start && fixed_by_[1] == not_fixed;
  const auto met = static_cast<Eigen::Index>(met_.size());
  conditions_matrix_ = Eigen::MatrixXd::Zero(met + (has_level_row ? 1 : 0), functions);
  for (Eigen::Index k = 0; k < met; ++k) conditions_matrix_.row(k) = collocation.row(met_[static_cast<std::size_t>(k)]);
  if (has_level_row) conditions_matrix_.row(met).head(2) << -1.0, 1.0;

  const auto unknowns = static_cast<Eigen::Index>(free_.size());
  const SolutionSpace space = solution_space(columns(conditions_matrix_, free_));
  const Eigen::MatrixXd& null = space.null;
  from_conditions_ = space.particular;
  from_fixed_ = Eigen::MatrixXd::Zero(unknowns, functions);
  if (null.cols() == 0) return;

  const int order = std::min({3, knots.degree(), data - 1});
  const Eigen::MatrixXd energy = energy_matrix(knots, order);
  Eigen::MatrixXd free_rows(unknowns, functions);
  for (Eigen::Index k = 0; k < unknowns; ++k) free_rows.row(k) = energy.row(free_[static_cast<std::size_t>(k)]);
  const Eigen::MatrixXd projected = null.transpose() * columns(free_rows, free_);
  const Eigen::LDLT<Eigen::MatrixXd> reduced(projected * null);
  from_conditions_ -= null * reduced.solve(projected * space.particular);
  from_fixed_ = -null * reduced.solve(null.transpose() * free_rows);
}

Eigen::MatrixXd SmoothestSpline::coefficients(const Eigen::Ref<const Eigen::MatrixXd>& values) const {
  if (std::cmp_not_equal(values.cols(), conditions_.parameters.size())) {
    throw GeometryError(
        fmt::format("smoothest spline: {} values for {} parameters", values.cols(), conditions_.parameters.size()));
  }
  const auto functions = static_cast<Eigen::Index>(fixed_by_.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(functions, values.rows());
  for (Eigen::Index i = 0; i < functions; ++i) {
    const int datum = fixed_by_[static_cast<std::size_t>(i)];
    if (datum >= 0) all.row(i) = values.col(datum).transpose();
  }
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(conditions_matrix_.rows(), values.rows());
  for (std::size_t k = 0; k < met_.size(); ++k)
    wanted.row(static_cast<Eigen::Index>(k)) = values.col(met_[k]).transpose();
  wanted -= conditions_matrix_ * all;
  const Eigen::MatrixXd free = from_conditions_ * wanted + from_fixed_ * all;
  for (std::size_t k = 0; k < free_.size(); ++k) all.row(free_[k]) = free.row(static_cast<Eigen::Index>(k));
  return all.transpose();
}

KnotVector doubled_knots(int degree, std::span<const double> parameters) {
  std::vector<double> breaks{parameters.front()};
  for (std::size_t k = 1; k < parameters.size(); ++k) {
    breaks.push_back(0.5 * (parameters[k - 1] + parameters[k]));
    breaks.push_back(parameters[k]);
  }
  return KnotVector::clamped(degree, breaks);
}

}  // namespace isorim::geometry
