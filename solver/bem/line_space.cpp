#include "solver/bem/line_space.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/bezier/bernstein_roots.h"
#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::solver {

using geometry::BezierSegment;
using geometry::BSpline;
using geometry::ExtractionOperator;
using geometry::Interval;
using geometry::KnotVector;

namespace {

/// The same knots, multiplicities kept, for degree p + 1: one function more.
KnotVector one_degree_more(const KnotVector& knots) {
  std::vector<double> more(knots.knots().begin(), knots.knots().end());
  more.insert(more.begin(), more.front());
  more.push_back(more.back());
  return {knots.degree() + 1, std::move(more)};
}

/// n x (2 p + 2): entry (i, p + j - i) is the integral of function i of degree p times function j of degree p + 1.
Eigen::MatrixXd cross_gram(const KnotVector& knots, const KnotVector& above) {
  const int p = knots.degree();
  const quadrature::Rule& rule = quadrature::gauss_legendre(p + 1);
  const quadrature::BernsteinTable& low = quadrature::bernstein_table(p, p + 1);
  const quadrature::BernsteinTable& high = quadrature::bernstein_table(p + 1, p + 1);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(p + 1, p + 2);
  for (int node = 0; node <= p; ++node)
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p + 1; ++b)
        mass(a, b) += rule.weights[static_cast<std::size_t>(node)] * low.values_at(node)[a] * high.values_at(node)[b];

  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(knots.basis_count(), 2 * p + 2);
  const std::vector<ExtractionOperator> ours = extraction_operators(knots);
  const std::vector<ExtractionOperator> theirs = extraction_operators(above);
  for (std::size_t e = 0; e < ours.size(); ++e) {
    const Eigen::MatrixXd local =
        ours[e].domain.length() * ours[e].matrix.lazyProduct(mass).lazyProduct(theirs[e].matrix.transpose());
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p + 1; ++b)
        band(ours[e].first_function + a, p + theirs[e].first_function + b - ours[e].first_function - a) += local(a, b);
  }
  return band;
}

/// The vector orthogonal to all rows. The matrix is totally positive, so elimination needs no pivots (de Boor & Pinkus,
/// Linear Algebra Appl. 85, 1987).
Eigen::VectorXd null_vector(Eigen::MatrixXd band) {
  const Eigen::Index n = band.rows();
  const Eigen::Index p = band.cols() / 2 - 1;
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index i = k + 1; i < std::min(n, k + p + 1); ++i) {
      const double factor = band(i, p + k - i) / band(k, p);
      for (Eigen::Index j = k; j <= k + p + 1; ++j) band(i, p + j - i) -= factor * band(k, p + j - k);
    }
  Eigen::VectorXd x(n + 1);
  x(n) = 1.0;
  for (Eigen::Index i = n; i-- > 0;) {
    double sum = 0.0;
    for (Eigen::Index j = i + 1; j <= std::min(n, i + p + 1); ++j) sum += band(i, p + j - i) * x(j);
    x(i) = -sum / band(i, p);
  }
  return x;
}

/// Zeros of a spline, increasing. Those that two segments share come once.
std::vector<double> zeros(const BSpline& spline) {
  constexpr double same = 1e-8;
  std::vector<double> result;
  for (const BezierSegment& segment : bezier_segments(spline)) {
    const Eigen::RowVectorXd coefficients = segment.coefficients.row(0);
    const double tolerance = 1e-13 * coefficients.cwiseAbs().maxCoeff();
    for (const Interval root : geometry::bernstein_roots(
             std::span<const double>(coefficients.data(), static_cast<std::size_t>(coefficients.size())), tolerance)) {
      const double u = segment.domain.first + root.middle() * segment.domain.length();
      if (result.empty() || u - result.back() > same * segment.domain.length()) result.push_back(u);
    }
  }
  return result;
}

/// Greville's abscissae, the first and the last halfway to their neighbours.
std::vector<double> moved_greville_points(const KnotVector& knots) {
  std::vector<double> points = knots.greville_abscissae();
  const std::size_t n = points.size();
  const double first = 0.5 * (points[0] + points[1]);
  points[n - 1] = 0.5 * (points[n - 2] + points[n - 1]);
  points[0] = first;
  return points;
}

}  // namespace

std::vector<double> gauss_points(const KnotVector& knots) {
  const KnotVector above = one_degree_more(knots);
  const Eigen::VectorXd coefficients = null_vector(cross_gram(knots, above));
  std::vector<double> points;
  if (coefficients.allFinite()) points = zeros({above, coefficients.transpose()});
  // Spans of very unequal length may leave no digits.
  if (points.size() != static_cast<std::size_t>(knots.basis_count())) return moved_greville_points(knots);
  return points;
}

namespace {

/// A stretch between two jumps, or around the seam.
struct Piece {
  KnotVector knots;
  /// B-spline of the space that its first function is.
  int first = 0;
};

/// The pieces of a clamped knot vector, in order.
std::vector<Piece> split_at_jumps(const KnotVector& knots) {
  const int p = knots.degree();
  const std::span<const double> all = knots.knots();
  std::vector<Piece> pieces;
  std::size_t begin = 0;
  for (std::size_t i = static_cast<std::size_t>(p) + 1; i < all.size(); ++i) {
    const bool ends = i + static_cast<std::size_t>(p) < all.size() && all[i] == all[i + static_cast<std::size_t>(p)];
    if (!ends) continue;
    const std::size_t end = i + static_cast<std::size_t>(p) + 1;
    pieces.push_back({KnotVector(p, {all.begin() + static_cast<std::ptrdiff_t>(begin),
                                     all.begin() + static_cast<std::ptrdiff_t>(end)}),
                      static_cast<int>(begin)});
    begin = i;
    i = end - 1;
  }
  return pieces;
}

/// The knots of `second`, moved to follow those of `first` continuously.
KnotVector join_continuously(const KnotVector& first, const KnotVector& second) {
  const int p = first.degree();
  std::vector<double> knots(first.knots().begin(), first.knots().end() - 1);
  const double shift = first.domain().last - second.domain().first;
  for (const double u : second.knots().subspan(static_cast<std::size_t>(p) + 1)) knots.push_back(u + shift);
  return {p, std::move(knots)};
}

/// Element and place of a parameter of the domain.
LinePoint locate(const LineSpace& space, double u) {
  const auto& elements = space.elements;
  const auto behind = std::upper_bound(elements.begin() + 1, elements.end(), u,
                                       [](double value, const auto& e) { return value < e.domain.first; });
  const Interval domain = std::prev(behind)->domain;
  return {static_cast<int>(behind - elements.begin()) - 1, std::clamp((u - domain.first) / domain.length(), 0.0, 1.0)};
}

/// Moves points that lie on inner breakpoints, or nearly so, into an element: the one on the right if they lie on the
/// breakpoint but for the weak influence of the ends.
void move_off_breakpoints(std::vector<double>& points, const KnotVector& knots) {
  constexpr double share_of_gap = 0.25;
  constexpr double undecided = 1e-3;
  const std::vector<double> breakpoints = knots.breakpoints();
  for (std::size_t k = 1; k + 1 < breakpoints.size(); ++k) {
    const double b = breakpoints[k];
    const double after = breakpoints[k + 1] - b;
    const double before = b - breakpoints[k - 1];
    const auto right = std::lower_bound(points.begin(), points.end(), b - undecided * before);
    if (right != points.begin()) {
      const auto left = std::prev(right);
      const double gap = left == points.begin() ? before : b - *std::prev(left);
      *left = std::min(*left, b - std::min(edge_clearance * before, share_of_gap * gap));
    }
    if (right != points.end()) {
      const double gap = std::next(right) == points.end() ? after : *std::next(right) - b;
      *right = std::max(*right, b + std::min(edge_clearance * after, share_of_gap * gap));
    }
  }
}

std::vector<double> points_off_breakpoints(const KnotVector& knots) {
  std::vector<double> points = gauss_points(knots);
  move_off_breakpoints(points, knots);
  return points;
}

/// Points and piece numbers for the functions of a piece of the period's interior, or across the seam.
void place_points(LineSpace& space, const Piece& piece, int number, int skipped) {
  const std::vector<double> points = points_off_breakpoints(piece.knots);
  const Interval domain = space.knots.domain();
  const int count = std::min(space.function_count(), static_cast<int>(points.size()) - skipped);
  for (int i = 0; i < count; ++i) {
    double u = points[static_cast<std::size_t>(skipped + i)];
    while (u < domain.first) u += domain.length();
    while (u >= domain.last) u -= domain.length();
    const std::size_t function = static_cast<std::size_t>((piece.first + i) % space.function_count());
    space.points[function] = locate(space, u);
    space.piece[function] = number;
  }
}

}  // namespace

LineSpace line_space(KnotVector knots, bool periodic) {
  LineSpace space{std::move(knots), periodic, {}, {}, {}};
  space.elements = extraction_operators(space.knots);
  space.points.resize(static_cast<std::size_t>(space.function_count()));
  space.piece.resize(space.points.size());
  std::vector<Piece> pieces = split_at_jumps(space.knots);
  int skipped = 0;
  if (periodic && pieces.size() == 1) {
    // Of three periods the middle one: the ends are far away.
    const KnotVector period = pieces[0].knots;
    pieces[0].knots = join_continuously(join_continuously(period, period), period);
    skipped = period.basis_count() - 1;
  } else if (periodic) {
    pieces.back().knots = join_continuously(pieces.back().knots, pieces.front().knots);
    pieces.erase(pieces.begin());
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) place_points(space, pieces[i], static_cast<int>(i), skipped);
  return space;
}

}  // namespace isorim::solver
