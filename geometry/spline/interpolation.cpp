#include "geometry/spline/interpolation.h"

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

void check_parameters(const KnotVector& knots, std::span<const double> parameters, Eigen::Index values) {
  const int count = knots.basis_count();
  if (std::cmp_not_equal(parameters.size(), count) || values != count) {
    throw GeometryError(
        fmt::format("interpolation: {} parameters and {} values for {} functions", parameters.size(), values, count));
  }
  const Interval domain = knots.domain();
  for (int i = 0; i < count; ++i) {
    const double t = parameters[static_cast<std::size_t>(i)];
    const double first = knots[i];
    const double last = knots[i + knots.degree() + 1];
    const bool at_end = (i == 0 && t == domain.first) || (i + 1 == count && t == domain.last);
    if (!at_end && !(first < t && t < last)) {
      throw GeometryError(fmt::format("interpolation: parameter {} is {}, outside ({}, {}) where function {} lives", i,
                                      t, first, last, i));
    }
  }
}

}  // namespace

KnotVector averaged_knots(int degree, std::span<const double> parameters) {
  const auto p = static_cast<std::size_t>(degree);
  std::vector<double> knots(p + 1, parameters.front());
  for (std::size_t j = 1; j + p < parameters.size(); ++j) {
    double sum = 0.0;
    for (std::size_t i = j; i < j + p; ++i) sum += parameters[i];
    knots.push_back(sum / degree);
  }
  knots.insert(knots.end(), p + 1, parameters.back());
  return {degree, std::move(knots)};
}

Eigen::MatrixXd collocation_matrix(const KnotVector& knots, std::span<const double> parameters) {
  const auto count = static_cast<Eigen::Index>(parameters.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, knots.basis_count());
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = parameters[static_cast<std::size_t>(k)];
    const int span = knots.find_span(t);
    matrix.block(k, span - knots.degree(), 1, knots.degree() + 1) = basis_derivatives(knots, span, t, 0).row(0);
  }
  return matrix;
}

BSpline interpolate(const KnotVector& knots, std::span<const double> parameters,
                    const Eigen::Ref<const Eigen::MatrixXd>& values) {
  check_parameters(knots, parameters, values.cols());
  const Eigen::MatrixXd matrix = collocation_matrix(knots, parameters);
  const Eigen::Index last = matrix.rows() - 1;
  BSpline spline{knots, matrix.partialPivLu().solve(values.transpose()).transpose()};
  if (matrix(0, 0) == 1.0) spline.coefficients.col(0) = values.col(0);
  if (matrix(last, last) == 1.0) spline.coefficients.col(last) = values.col(last);
  return spline;
}

}  // namespace isorim::geometry
