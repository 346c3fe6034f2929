#include "geometry/fitting/derivative_row.h"

namespace isorim::geometry {

void fill_basis_derivative(const KnotVector& knots, int span, double u, int order, double* values) {
  const int p = knots.degree();
  const int low = p - order;
  // Values of degree `low`, by the recurrence of Cox and de Boor; functions span - low .. span.
  values[0] = 1.0;
  for (int d = 1; d <= low; ++d) {
    double saved = 0.0;
    for (int r = 0; r < d; ++r) {
      const double left = knots[span + 1 - d + r];
      const double right = knots[span + 1 + r];
      const double share = values[r] / (right - left);
      values[r] = saved + (right - u) * share;
      saved = (u - left) * share;
    }
    values[d] = saved;
  }
  // A derivative's control point i is d (c_i - c_{i-1}) / (knots[i + d] - knots[i]).
  for (int d = low + 1; d <= p; ++d) {
    double before = 0.0;
    for (int r = 0; r < d; ++r) {
      const int i = span - d + 1 + r;
      const double slope = d * values[r] / (knots[i + d] - knots[i]);
      values[r] = before - slope;
      before = slope;
    }
    values[d] = before;
  }
}

}  // namespace isorim::geometry
