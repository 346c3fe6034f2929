#include "geometry/fitting/bordered_cholesky.h"

#include <algorithm>
#include <cmath>

namespace isorim::geometry {

namespace {

/// y -= a x.
void subtract(int count, double a, const double* __restrict x, double* __restrict y) {
  for (int i = 0; i < count; ++i) y[i] -= a * x[i];
}

}  // namespace

BorderedCholesky::BorderedCholesky(int size, int half_width, int border)
    : size_(size),
      half_width_(std::min(half_width, size - 1)),
      band_rows_(size - border),
      stride_(half_width_ + 1 + border),
      values_(static_cast<std::size_t>(size) * static_cast<std::size_t>(stride_), 0.0) {}

bool BorderedCholesky::factorise() {
  constexpr double smallest_pivot = 1e-14;
  // Each column is finished and taken from those to its right, where every part of it is contiguous.
  std::vector<double> before(static_cast<std::size_t>(size_));
  for (int j = 0; j < size_; ++j) before[static_cast<std::size_t>(j)] = diagonal(j);
  const int border = this->border();
  for (int j = 0; j < size_; ++j) {
    double* pivot = place(j, j);
    if (!(*pivot > smallest_pivot * before[static_cast<std::size_t>(j)])) return false;
    *pivot = std::sqrt(*pivot);
    const double inverse = 1.0 / *pivot;
    const int below = j < band_rows_ ? std::min(half_width_, band_rows_ - 1 - j) : 0;
    double* band = column(j);
    double* rows = band + half_width_ + 1;
    const int first_border = j < band_rows_ ? 0 : j - band_rows_ + 1;
    for (int k = 1; k <= below; ++k) band[k] *= inverse;
    for (int k = first_border; k < border; ++k) rows[k] *= inverse;
    for (int k = 1; k <= below; ++k) {
      if (band[k] == 0.0) continue;
      double* other = column(j + k);
      subtract(below - k + 1, band[k], band + k, other);
      subtract(border, band[k], rows, other + half_width_ + 1);
    }
    for (int k = first_border; k < border; ++k)
      subtract(border - k, rows[k], rows + k, column(band_rows_ + k) + half_width_ + 1 + k);
  }
  return true;
}

Eigen::VectorXd BorderedCholesky::solve(Eigen::VectorXd rhs) const {
  const int border = this->border();
  double* tail = rhs.data() + band_rows_;
  for (int j = 0; j < size_; ++j) {
    const int below = j < band_rows_ ? std::min(half_width_, band_rows_ - 1 - j) : 0;
    const double* band = column(j);
    const double* rows = band + half_width_ + 1;
    const int first_border = j < band_rows_ ? 0 : j - band_rows_ + 1;
    rhs[j] /= *place(j, j);
    subtract(below, rhs[j], band + 1, rhs.data() + j + 1);
    subtract(border - first_border, rhs[j], rows + first_border, tail + first_border);
  }
  for (int j = size_ - 1; j >= 0; --j) {
    const int below = j < band_rows_ ? std::min(half_width_, band_rows_ - 1 - j) : 0;
    const double* band = column(j);
    const double* rows = band + half_width_ + 1;
    double sum = rhs[j];
    for (int k = 1; k <= below; ++k) sum -= band[k] * rhs[j + k];
    for (int k = j < band_rows_ ? 0 : j - band_rows_ + 1; k < border; ++k) sum -= rows[k] * tail[k];
    rhs[j] = sum / *place(j, j);
  }
  return rhs;
}

}  // namespace isorim::geometry
