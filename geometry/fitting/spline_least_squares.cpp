#include "geometry/fitting/spline_least_squares.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {

namespace {

/// Rotates the row `x` into the row `r` so that x[0] vanishes.
void rotate(double* r, double* x, int count) {
  const double length = std::sqrt(r[0] * r[0] + x[0] * x[0]);
  const double c = r[0] / length;
  const double s = x[0] / length;
  r[0] = length;
  x[0] = 0.0;
  for (int i = 1; i < count; ++i) {
    const double upper = r[i];
    const double lower = x[i];
    r[i] = c * upper + s * lower;
    x[i] = c * lower - s * upper;
  }
}

}  // namespace

SplineLeastSquares::SplineLeastSquares(const FitSpace& space, int dimension)
    : degree_(space.knots.degree()),
      shared_(space.shared),
      dimension_(dimension),
      basis_count_(space.knots.basis_count()),
      band_count_(space.unknowns() - space.shared),
      stride_(degree_ + 1 + shared_ + dimension_),
      border_stride_(shared_ + dimension_) {
  if (shared_ > 0 && space.unknowns() < degree_ + 1)
    throw GeometryError(
        fmt::format("least squares: {} coefficients of a closed spline of degree {}; expected {} or more",
                    space.unknowns(), degree_, degree_ + 1));
  band_.assign(static_cast<std::size_t>(band_count_) * static_cast<std::size_t>(stride_), 0.0);
  border_.assign(static_cast<std::size_t>(shared_) * static_cast<std::size_t>(border_stride_), 0.0);
  reach_.assign(static_cast<std::size_t>(band_count_), -1);
  work_.assign(static_cast<std::size_t>(stride_), 0.0);
}

void SplineLeastSquares::add(int first_function, std::span<const double> values, std::span<const double> rhs) {
  // Function i is border column i or i - unknowns if shared, else band column i - shared.
  const int unknowns = basis_count_ - shared_;
  std::fill(work_.begin(), work_.end(), 0.0);
  double* border = work_.data() + degree_ + 1;
  int column = std::max(0, first_function - shared_);
  int last = column - 1;
  for (int j = 0; j <= degree_; ++j) {
    const int i = first_function + j;
    const double value = values[static_cast<std::size_t>(j)];
    if (i < shared_) {
      border[i] += value;
    } else if (i >= unknowns) {
      border[i - unknowns] += value;
    } else {
      work_[static_cast<std::size_t>(i - shared_ - column)] = value;
      last = i - shared_;
    }
  }
  std::copy(rhs.begin(), rhs.end(), border + shared_);

  for (; column <= last; ++column) {
    double* row = band_row(column);
    int& reach = reach_[static_cast<std::size_t>(column)];
    if (work_[0] != 0.0) {
      if (row[0] == 0.0) {
        std::copy(work_.begin(), work_.end(), row);
        reach = last;
        return;
      }
      last = reach = std::max(last, reach);
      rotate(row, work_.data(), stride_);
    }
    std::copy(work_.begin() + 1, work_.begin() + degree_ + 1, work_.begin());
    work_[static_cast<std::size_t>(degree_)] = 0.0;
  }
  add_to_border();
}

void SplineLeastSquares::add_to_border() {
  double* row = work_.data() + degree_ + 1;
  for (int i = 0; i < shared_; ++i) {
    if (row[i] == 0.0) continue;
    double* upper = border_row(i);
    if (upper[i] == 0.0) {
      std::copy(row + i, row + border_stride_, upper + i);
      return;
    }
    rotate(upper + i, row + i, border_stride_ - i);
  }
}

Eigen::MatrixXd SplineLeastSquares::solve() const {
  constexpr double rank_tolerance = 1e-13;
  double largest = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  const auto look_at = [&](double diagonal) {
    largest = std::max(largest, std::abs(diagonal));
    smallest = std::min(smallest, std::abs(diagonal));
  };
  for (int i = 0; i < band_count_; ++i) look_at(band_row(i)[0]);
  for (int i = 0; i < shared_; ++i) look_at(border_row(i)[i]);
  if (!(smallest > rank_tolerance * largest)) return {};

  Eigen::MatrixXd coefficients(dimension_, basis_count_);
  for (int d = 0; d < dimension_; ++d) {
    for (int i = shared_ - 1; i >= 0; --i) {
      const double* row = border_row(i);
      double sum = row[shared_ + d];
      for (int j = i + 1; j < shared_; ++j) sum -= row[j] * coefficients(d, j);
      coefficients(d, i) = sum / row[i];
    }
    for (int i = band_count_ - 1; i >= 0; --i) {
      const double* row = band_row(i);
      double sum = row[degree_ + 1 + shared_ + d];
      for (int j = 0; j < shared_; ++j) sum -= row[degree_ + 1 + j] * coefficients(d, j);
      for (int j = 1; j <= degree_ && i + j < band_count_; ++j) sum -= row[j] * coefficients(d, shared_ + i + j);
      coefficients(d, shared_ + i) = sum / row[0];
    }
  }
  coefficients.rightCols(shared_) = coefficients.leftCols(shared_);
  return coefficients;
}

}  // namespace isorim::geometry
