#include "geometry/spline/local_basis.h"

#include <algorithm>
#include <array>
#include <utility>

namespace isorim::geometry {

namespace {

constexpr std::size_t capacity = KnotVector::max_degree + 1;

/// Piegl & Tiller's ndu: above and on the diagonal the basis functions of all degrees (column = degree), below it
/// the knot differences. Rows follow each other without gaps, whatever the degree.
class Triangle {
 public:
  explicit Triangle(int degree) : stride_(degree + 1) {}
  double* operator[](int row) { return values_ + row * stride_; }
  const double* operator[](int row) const { return values_ + row * stride_; }

 private:
  int stride_;
  double values_[capacity * capacity];
};

void fill_triangle(const KnotVector& knots, int span, double u, Triangle& ndu) {
  ndu[0][0] = 1.0;
  for (int j = 1; j <= knots.degree(); ++j) {
    double saved = 0.0;
    for (int r = 0; r < j; ++r) {
      const double left = knots[span + 1 - j + r];
      const double right = knots[span + 1 + r];
      ndu[j][r] = right - left;
      const double share = ndu[r][j - 1] / ndu[j][r];
      ndu[r][j] = saved + (right - u) * share;
      saved = (u - left) * share;
    }
    ndu[j][j] = saved;
  }
}

/// First derivatives, without the factor p.
void differentiate_once(const Triangle& ndu, int p, Eigen::Ref<Eigen::MatrixXd> table) {
  for (int r = 0; r <= p; ++r) {
    const double before = r > 0 ? 1.0 / ndu[p][r - 1] * ndu[r - 1][p - 1] : 0.0;
    const double after = r < p ? 1.0 / ndu[p][r] * ndu[r][p - 1] : 0.0;
    table(r, 1) = before - after;
  }
}

/// Derivatives of function r, without the factor p! / (p - k)!.
void differentiate(const Triangle& ndu, int p, int r, Eigen::Ref<Eigen::MatrixXd> table) {
  std::array<double, capacity> previous{};
  std::array<double, capacity> next{};
  previous[0] = 1.0;
  const int orders = std::min(p, static_cast<int>(table.cols()) - 1);
  for (int k = 1; k <= orders; ++k) {
    const int rk = r - k;
    const int pk = p - k;
    double sum = 0.0;
    if (rk >= 0) {
      next[0] = previous[0] / ndu[pk + 1][rk];
      sum = next[0] * ndu[rk][pk];
    }
    const int begin = rk >= -1 ? 1 : -rk;
    const int end = r - 1 <= pk ? k - 1 : p - r;
    for (int j = begin; j <= end; ++j) {
      next[j] = (previous[j] - previous[j - 1]) / ndu[pk + 1][rk + j];
      sum += next[j] * ndu[rk + j][pk];
    }
    if (r <= pk) {
      next[k] = -previous[k - 1] / ndu[pk + 1][r];
      sum += next[k] * ndu[r][pk];
    }
    table(r, k) = sum;
    std::swap(previous, next);
  }
}

}  // namespace

void fill_basis_table(const KnotVector& knots, int span, double u, Eigen::Ref<Eigen::MatrixXd> table) {
  const int p = knots.degree();
  Triangle ndu(p);
  fill_triangle(knots, span, u, ndu);
  for (int r = 0; r <= p; ++r) table(r, 0) = ndu[r][p];
  if (table.cols() == 1) return;

  if (table.cols() == 2) {
    differentiate_once(ndu, p, table);
  } else {
    for (int r = 0; r <= p; ++r) differentiate(ndu, p, r, table);
  }
  double factor = p;
  for (int k = 1; k < table.cols(); ++k) {
    if (k > p) {
      table.col(k).setZero();
      continue;
    }
    table.col(k) *= factor;
    factor *= p - k;
  }
}

}  // namespace isorim::geometry
