#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/corner_cutting.h"

namespace isorim::geometry {

namespace {

/// The inner knots (first and last one left out) of the clamped spline's elevation by one degree: every multiplicity
/// one higher.
std::vector<double> elevated_inner_knots(const KnotVector& knots) {
  std::vector<double> result;
  for (std::size_t i = 1; i + 1 < knots.knots().size(); ++i) {
    result.push_back(knots.knots()[i]);
    if (knots.knots()[i] != knots.knots()[i + 1] || i + 2 == knots.knots().size()) result.push_back(result.back());
  }
  return result;
}

/// Elevation by one degree of a continuous, clamped spline.
///
/// With q = p + 1, coefficient j of the result is the mean of the q blossoms f(T_j, .., T_{j+q-1} without one) (T the
/// elevated inner knots). Leaving out every q-th knot of T leaves one knot vector that refines the given one and
/// holds one of these blossoms for each j, so the result is the mean of q refinements: convex combinations
/// throughout (Prautzsch & Piper, CAGD 8, 1991, section 3).
BSpline elevate_once(const BSpline& spline) {
  const int p = spline.knots.degree();
  const int q = p + 1;
  const std::vector<double> inner = elevated_inner_knots(spline.knots);
  const std::span<const double> old = spline.knots.knots();
  const Eigen::Index count = static_cast<Eigen::Index>(inner.size()) + 1 - q;
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(spline.coefficients.rows(), count);
  for (int omitted = 0; omitted < q; ++omitted) {
    std::vector<double> thinned;
    for (std::size_t i = 0; i < inner.size(); ++i)
      if (static_cast<int>(i % static_cast<std::size_t>(q)) != omitted) thinned.push_back(inner[i]);
    std::vector<double> extra;
    std::set_difference(thinned.begin(), thinned.end(), old.begin() + 1, old.end() - 1, std::back_inserter(extra));
    const BSpline refined = refine_knots(spline, extra);
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index omitted_before = (j + q - 1 - omitted) / q;
      mean.col(j) += (refined.coefficients.col(j - omitted_before) - mean.col(j)) / (omitted + 1);
    }
  }
  std::vector<double> knots{inner.front()};
  knots.insert(knots.end(), inner.begin(), inner.end());
  knots.push_back(inner.back());
  return {KnotVector(q, std::move(knots)), std::move(mean)};
}

/// Where the spline may jump: the ends of the domain and inner knots of multiplicity p + 1.
std::vector<double> continuous_pieces(const KnotVector& knots) {
  std::vector<double> ends;
  const Interval domain = knots.domain();
  for (const double u : knots.breakpoints())
    if (u == domain.first || u == domain.last || knots.multiplicity(u) > knots.degree()) ends.push_back(u);
  return ends;
}

}  // namespace

BSpline elevate_degree(const BSpline& spline, int times) {
  require_consistent(spline);
  if (times < 0 || times > KnotVector::max_degree - spline.knots.degree())
    throw GeometryError(fmt::format("degree elevation: degree {} cannot be raised by {}; expected 0 to {}",
                                    spline.knots.degree(), times, KnotVector::max_degree - spline.knots.degree()));
  if (times == 0) return clamp(spline);

  const int degree = spline.knots.degree() + times;
  const std::vector<double> ends = continuous_pieces(spline.knots);
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, ends.front());
  Eigen::MatrixXd coefficients(spline.coefficients.rows(), 0);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    BSpline piece = restrict_to(spline, {ends[i - 1], ends[i]});
    for (int t = 0; t < times; ++t) piece = elevate_once(piece);
    const std::span<const double> piece_knots = piece.knots.knots();
    knots.insert(knots.end(), piece_knots.begin() + degree + 1, piece_knots.end());
    const Eigen::Index before = coefficients.cols();
    coefficients.conservativeResize(Eigen::NoChange, before + piece.coefficients.cols());
    coefficients.rightCols(piece.coefficients.cols()) = piece.coefficients;
  }
  return {KnotVector(degree, std::move(knots)), std::move(coefficients)};
}

}  // namespace isorim::geometry
