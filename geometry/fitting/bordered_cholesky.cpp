#include "geometry/fitting/bordered_cholesky.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isorim::geometry {

BorderedCholesky::BorderedCholesky(int size, int half_width, int border)
    : size_(size), half_width_(half_width), band_rows_(std::max(0, size - border)) {
  const std::size_t band = static_cast<std::size_t>(band_rows_) * static_cast<std::size_t>(half_width + 1);
  const std::size_t rest = static_cast<std::size_t>(size - band_rows_) * static_cast<std::size_t>(size);
  values_.assign(band + rest, 0.0);
}

int BorderedCholesky::first_column(int i) const {
  return i < band_rows_ ? std::max(0, i - half_width_) : 0;
}

const double* BorderedCholesky::place(int i, int j) const {
  if (i < j) std::swap(i, j);
  // Band rows end with their diagonal, border rows begin with column 0.
  if (i < band_rows_)
    return values_.data() + static_cast<std::ptrdiff_t>(i) * (half_width_ + 1) + (j - i + half_width_);
  return values_.data() + static_cast<std::ptrdiff_t>(band_rows_) * (half_width_ + 1) +
         static_cast<std::ptrdiff_t>(i - band_rows_) * size_ + j;
}

bool BorderedCholesky::factorise() {
  constexpr double smallest_pivot = 1e-14;
  for (int i = 0; i < size_; ++i) {
    const int first = first_column(i);
    double* row = place(i, first);
    const double before = row[i - first];
    for (int j = first; j <= i; ++j) {
      const int start = std::max(first, first_column(j));
      const double* other = place(j, start);
      double sum = row[j - first];
      for (int k = start; k < j; ++k) sum -= row[k - first] * other[k - start];
      if (j < i) {
        row[j - first] = sum / other[j - start];
      } else {
        if (!(sum > smallest_pivot * before)) return false;
        row[i - first] = std::sqrt(sum);
      }
    }
  }
  return true;
}

Eigen::VectorXd BorderedCholesky::solve(Eigen::VectorXd rhs) const {
  for (int i = 0; i < size_; ++i) {
    const int first = first_column(i);
    const double* row = place(i, first);
    double sum = rhs[i];
    for (int k = first; k < i; ++k) sum -= row[k - first] * rhs[k];
    rhs[i] = sum / row[i - first];
  }
  for (int i = size_ - 1; i >= 0; --i) {
    const int first = first_column(i);
    const double* row = place(i, first);
    rhs[i] /= row[i - first];
    for (int k = first; k < i; ++k) rhs[k] -= row[k - first] * rhs[i];
  }
  return rhs;
}

}  // namespace isorim::geometry
