#include "geometry/spline/bspline.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/corner_cutting.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

Eigen::MatrixXd basis_derivatives(const KnotVector& knots, int span, double u, int orders) {
  if (orders < 0) throw GeometryError(fmt::format("B-spline: derivatives up to order {} asked for", orders));
  if (span < knots.degree() || span >= knots.basis_count() || !(knots[span] < knots[span + 1]))
    throw GeometryError(fmt::format("B-spline: {} is no non-empty span of the domain", span));
  Eigen::MatrixXd table(knots.degree() + 1, orders + 1);
  fill_basis_table(knots, span, u, table);
  return table.transpose();
}

Eigen::MatrixXd evaluate_derivatives(const BSpline& spline, double u, int orders) {
  require_consistent(spline);
  const int span = spline.knots.find_span(u);
  const int p = spline.knots.degree();
  const Eigen::MatrixXd table = basis_derivatives(spline.knots, span, u, orders);
  return spline.coefficients.middleCols(span - p, p + 1).lazyProduct(table.transpose());
}

Eigen::VectorXd evaluate(const BSpline& spline, double u) {
  require_consistent(spline);
  const int span = spline.knots.find_span(u);
  const int p = spline.knots.degree();
  Eigen::MatrixXd local = spline.coefficients.middleCols(span - p, p + 1);
  // Both ends of the span must be met exactly: cut from the nearer one.
  if (u - spline.knots[span] <= spline.knots[span + 1] - u) {
    cut_from_left(spline.knots, span, u, local);
    return local.col(0);
  }
  cut_from_right(spline.knots, span, u, local);
  return local.col(p);
}

namespace {

void require_insertable(const KnotVector& knots, std::span<const double> new_knots) {
  const Interval domain = knots.domain();
  for (std::size_t i = 0; i < new_knots.size(); ++i) {
    if (!domain.contains(new_knots[i]))
      throw GeometryError(fmt::format("knot insertion: new knot {} lies outside the domain [{}, {}]", new_knots[i],
                                      domain.first, domain.last));
    if (i > 0 && new_knots[i] < new_knots[i - 1])
      throw GeometryError(fmt::format("knot insertion: new knot {} follows the larger {}; new knots must not fall",
                                      new_knots[i], new_knots[i - 1]));
  }
}

void require_piece(const KnotVector& knots, Interval piece) {
  const Interval domain = knots.domain();
  if (!(piece.first < piece.last && domain.contains(piece.first) && domain.contains(piece.last)))
    throw GeometryError(fmt::format("piece [{}, {}] is no interval inside the domain [{}, {}]", piece.first, piece.last,
                                    domain.first, domain.last));
}

/// The part from u on, clamped at u.
BSpline without_left_part(const BSpline& spline, double u) {
  const KnotVector& knots = spline.knots;
  const int p = knots.degree();
  const int span = knots.find_span(u);
  const std::span<const double> kept = knots.knots().subspan(static_cast<std::size_t>(span) + 1);
  std::vector<double> new_knots(static_cast<std::size_t>(p) + 1, u);
  new_knots.insert(new_knots.end(), kept.begin(), kept.end());
  Eigen::MatrixXd coefficients = spline.coefficients.rightCols(knots.basis_count() - span + p);
  cut_from_left(knots, span, u, coefficients.leftCols(p + 1));
  return {KnotVector(p, std::move(new_knots)), std::move(coefficients)};
}

/// The part up to u, clamped at u.
BSpline without_right_part(const BSpline& spline, double u) {
  const KnotVector& knots = spline.knots;
  const int p = knots.degree();
  const auto begin = knots.knots().begin();
  const int span = static_cast<int>(std::lower_bound(begin + p, begin + knots.basis_count() + 1, u) - begin) - 1;
  std::vector<double> new_knots(begin, begin + span + 1);
  new_knots.insert(new_knots.end(), static_cast<std::size_t>(p) + 1, u);
  Eigen::MatrixXd coefficients = spline.coefficients.leftCols(span + 1);
  cut_from_right(knots, span, u, coefficients.rightCols(p + 1));
  return {KnotVector(p, std::move(new_knots)), std::move(coefficients)};
}

}  // namespace

BSpline refine_knots(const BSpline& spline, std::span<const double> new_knots) {
  require_consistent(spline);
  require_insertable(spline.knots, new_knots);
  if (new_knots.empty()) return spline;
  const std::span<const double> old = spline.knots.knots();
  std::vector<double> merged;
  merged.reserve(old.size() + new_knots.size());
  std::merge(old.begin(), old.end(), new_knots.begin(), new_knots.end(), std::back_inserter(merged));
  BSpline refined{KnotVector(spline.knots.degree(), std::move(merged)), {}};

  const int p = spline.knots.degree();
  const KnotVector& knots = refined.knots;
  Eigen::MatrixXd& points = refined.coefficients;
  points.resize(spline.coefficients.rows(), knots.basis_count());
  // From the right: i and k are the last knots, old and new, not yet placed. The p + 1 knots at and beyond each end
  // of the domain keep all indices in range, but for coefficients whose support ends before the domain begins.
  int i = static_cast<int>(old.size()) - 1;
  int k = static_cast<int>(knots.knots().size()) - 1;
  for (std::size_t j = new_knots.size(); j-- > 0; --k) {
    for (; new_knots[j] <= old[static_cast<std::size_t>(i)]; --i, --k)
      if (i - p - 1 >= 0) points.col(k - p - 1) = spline.coefficients.col(i - p - 1);
    if (k - p - 1 >= 0) points.col(k - p - 1) = points.col(k - p);
    for (int l = std::max(1, p - k + 1); l <= p; ++l) {
      const int target = k - p + l - 1;
      if (knots[k + l] == new_knots[j])
        points.col(target) = points.col(target + 1);
      else
        blend_columns(points, target, target, target + 1, new_knots[j], spline.knots[i - p + l], knots[k + l]);
    }
  }
  points.leftCols(std::max(0, k - p)) = spline.coefficients.leftCols(std::max(0, i - p));
  return refined;
}

BSpline clamp(const BSpline& spline) {
  return restrict_to(spline, spline.knots.domain());
}

BSpline restrict_to(const BSpline& spline, Interval piece) {
  require_consistent(spline);
  require_piece(spline.knots, piece);
  if (spline.knots.is_clamped() && piece.first == spline.knots.domain().first &&
      piece.last == spline.knots.domain().last)
    return spline;
  return without_right_part(without_left_part(spline, piece.first), piece.last);
}

BSpline extend(const BSpline& spline, Interval domain) {
  BSpline result = clamp(spline);
  const Interval own = result.knots.domain();
  if (!(std::isfinite(domain.first) && std::isfinite(domain.last) && domain.first <= own.first &&
        own.last <= domain.last)) {
    throw GeometryError(fmt::format("B-spline: the domain [{}, {}] to extend to does not contain [{}, {}]",
                                    domain.first, domain.last, own.first, own.last));
  }
  const int p = result.knots.degree();
  if (domain.first < own.first) {
    cut_from_left(result.knots, p, domain.first, result.coefficients.leftCols(p + 1));
    std::vector<double> knots(result.knots.knots().begin(), result.knots.knots().end());
    std::fill_n(knots.begin(), p + 1, domain.first);
    result.knots = KnotVector(p, std::move(knots));
  }
  if (own.last < domain.last) {
    cut_from_right(result.knots, result.knots.basis_count() - 1, domain.last, result.coefficients.rightCols(p + 1));
    std::vector<double> knots(result.knots.knots().begin(), result.knots.knots().end());
    std::fill_n(knots.end() - p - 1, p + 1, domain.last);
    result.knots = KnotVector(p, std::move(knots));
  }
  return result;
}

BSpline reverse(const BSpline& spline) {
  require_consistent(spline);
  const Interval domain = spline.knots.domain();
  const std::span<const double> old = spline.knots.knots();
  std::vector<double> knots(old.size());
  // Measured from the nearer end of the domain, so that its ends are exchanged exactly.
  const auto mirrored = [&](double u) {
    return u < domain.middle() ? domain.last - (u - domain.first) : domain.first + (domain.last - u);
  };
  std::transform(old.rbegin(), old.rend(), knots.begin(), mirrored);
  for (std::size_t i = 1; i < knots.size(); ++i) knots[i] = std::max(knots[i], knots[i - 1]);
  return {KnotVector(spline.knots.degree(), std::move(knots)), spline.coefficients.rowwise().reverse()};
}

std::vector<BezierSegment> bezier_segments(const BSpline& spline) {
  require_consistent(spline);
  const int p = spline.knots.degree();
  std::vector<BezierSegment> segments;
  for (const int span : nonempty_spans(spline.knots)) {
    BezierSegment segment{{spline.knots[span], spline.knots[span + 1]},
                          spline.coefficients.middleCols(span - p, p + 1)};
    cut_to_bezier(spline.knots, span, segment.coefficients);
    segments.push_back(std::move(segment));
  }
  return segments;
}

std::vector<ExtractionOperator> extraction_operators(const KnotVector& knots) {
  const int p = knots.degree();
  std::vector<ExtractionOperator> operators;
  for (const int span : nonempty_spans(knots)) {
    // The Bézier coefficients of function i are row i: extract the identity.
    ExtractionOperator extraction{{knots[span], knots[span + 1]}, span - p, Eigen::MatrixXd::Identity(p + 1, p + 1)};
    cut_to_bezier(knots, span, extraction.matrix);
    operators.push_back(std::move(extraction));
  }
  return operators;
}

}  // namespace isorim::geometry
