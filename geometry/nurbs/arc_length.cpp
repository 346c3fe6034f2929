#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/curve.h"
#include "geometry/spline/kronrod_rule.h"

namespace isorim::geometry {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The length over one interval.
struct PieceLength {
  Interval piece;
  double value = 0.0;
  double error = 0.0;

  friend bool operator<(const PieceLength& a, const PieceLength& b) { return a.error < b.error; }
};

template <int Dim>
PieceLength piece_length(const NurbsCurve<Dim>& curve, Interval piece) {
  const double half = 0.5 * piece.length();
  const auto speed = [&](double x) { return evaluate_jet(curve, piece.middle() + half * x).du.norm(); };
  double kronrod = 0.0;
  double gauss = 0.0;
  for (const KronrodNode& rule : kronrod_nodes) {
    const double value = rule.node == 0.0 ? speed(0.0) : speed(rule.node) + speed(-rule.node);
    kronrod += rule.kronrod_weight * value;
    gauss += rule.gauss_weight * value;
  }
  return {piece, half * kronrod, half * std::abs(kronrod - gauss)};
}

void require_tolerance(double tolerance) {
  if (!(tolerance >= 0.0)) throw GeometryError(fmt::format("arc length: tolerance {} is negative", tolerance));
}

/// `piece` cut at the breakpoints inside it.
std::vector<Interval> smooth_pieces(const KnotVector& knots, Interval piece) {
  std::vector<Interval> pieces;
  double start = piece.first;
  for (const double u : knots.breakpoints()) {
    if (u <= start) continue;
    if (u >= piece.last) break;
    pieces.push_back({start, u});
    start = u;
  }
  if (start < piece.last) pieces.push_back({start, piece.last});
  return pieces;
}

/// The two halves of a piece. The two rules may agree by chance, so that their difference falls short of the error:
/// the error of a half is never taken as less than half of what halving changed.
template <int Dim>
std::array<PieceLength, 2> halves_of(const NurbsCurve<Dim>& curve, const PieceLength& whole) {
  const double middle = whole.piece.middle();
  std::array<PieceLength, 2> halves{piece_length(curve, {whole.piece.first, middle}),
                                    piece_length(curve, {middle, whole.piece.last})};
  const double change = 0.5 * std::abs(whole.value - (halves[0].value + halves[1].value));
  for (PieceLength& half : halves) half.error = std::max(half.error, change);
  return halves;
}

/// Bisects the piece with the largest error until the sum of the errors meets the tolerance or is rounding.
template <int Dim>
ArcLength adaptive_length(const NurbsCurve<Dim>& curve, Interval piece, double tolerance) {
  constexpr int most_bisections = 2000;
  std::priority_queue<PieceLength> open;
  std::vector<PieceLength> closed;
  double value = 0.0;
  double error = 0.0;
  const auto add = [&](const PieceLength& length) {
    open.push(length);
    value += length.value;
    error += length.error;
  };
  for (const Interval& smooth : smooth_pieces(curve.knots(), piece))
    for (const PieceLength& half : halves_of(curve, piece_length(curve, smooth))) add(half);
  for (int i = 0; i < most_bisections && !open.empty() && error > tolerance * value; ++i) {
    const PieceLength worst = open.top();
    open.pop();
    const double middle = worst.piece.middle();
    const bool is_rounding = worst.error <= 4.0 * epsilon * worst.value;
    if (is_rounding || middle <= worst.piece.first || middle >= worst.piece.last) {
      closed.push_back(worst);
      continue;
    }
    value -= worst.value;
    error -= worst.error;
    for (const PieceLength& half : halves_of(curve, worst)) add(half);
  }
  // Summed anew, in the order of size: the running sums have gathered rounding.
  for (; !open.empty(); open.pop()) closed.push_back(open.top());
  std::sort(closed.begin(), closed.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  ArcLength total;
  for (const PieceLength& length : closed) {
    total.value += length.value;
    total.error += length.error;
  }
  total.error += 8.0 * epsilon * total.value;
  return total;
}

}  // namespace

template <int Dim>
ArcLength arc_length(const NurbsCurve<Dim>& curve, Interval piece, double tolerance) {
  require_tolerance(tolerance);
  const Interval domain = curve.domain();
  if (!(piece.first <= piece.last && domain.contains(piece.first) && domain.contains(piece.last)))
    throw GeometryError(fmt::format("arc length: [{}, {}] is no interval inside the domain [{}, {}]", piece.first,
                                    piece.last, domain.first, domain.last));
  return adaptive_length(curve, piece, tolerance);
}

template <int Dim>
double parameter_at_length(const NurbsCurve<Dim>& curve, double length, double tolerance) {
  require_tolerance(tolerance);
  if (std::isnan(length)) throw GeometryError("arc length: the length asked for is nan");
  const Interval domain = curve.domain();
  if (length <= 0.0) return domain.first;
  double before = 0.0;
  for (const Interval& segment : smooth_pieces(curve.knots(), domain)) {
    const double whole = adaptive_length(curve, segment, tolerance).value;
    if (before + whole <= length) {
      before += whole;
      continue;
    }
    // Newton's method on the length from `low`, kept inside the bracket.
    double low = segment.first;
    double high = segment.last;
    double rest = length - before;
    double u = low + (high - low) * (rest / whole);
    for (int i = 0; i < 100 && low < u && u < high; ++i) {
      const double excess = adaptive_length(curve, {low, u}, tolerance).value - rest;
      const double step = -excess / evaluate_jet(curve, u).du.norm();
      if (std::abs(excess) <= tolerance * length || std::abs(step) <= epsilon * std::abs(u)) return u;
      if (excess < 0.0) {
        low = u;
        rest = -excess;
      } else {
        high = u;
      }
      const double next = u + step;
      u = low < next && next < high ? next : low + 0.5 * (high - low);
    }
    return u;
  }
  return domain.last;
}

#define ISORIM_INSTANTIATE(Dim)                                            \
  template ArcLength arc_length(const NurbsCurve<Dim>&, Interval, double); \
  template double parameter_at_length(const NurbsCurve<Dim>&, double, double)
ISORIM_INSTANTIATE(2);
ISORIM_INSTANTIATE(3);
#undef ISORIM_INSTANTIATE

}  // namespace isorim::geometry
