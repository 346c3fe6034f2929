#include "io/iges/arc_length_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "io/iges/fitting.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::io::iges {

using geometry::Interval;
using geometry::NurbsCurve;
using geometry::Point3;

namespace {

constexpr int points = 16;
constexpr int deepest_halving = 24;

double speed(const NurbsCurve<3>& curve, double t) {
  return evaluate_jet(curve, t).du.norm();
}

/// By one Gauss rule.
double length_of(const NurbsCurve<3>& curve, const Interval& piece) {
  const quadrature::Rule& rule = quadrature::gauss_legendre(points);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    sum += rule.weights[i] * speed(curve, piece.first + rule.nodes[i] * piece.length());
  return sum * piece.length();
}

/// A curve's length as a function of its parameter, and the other way round. On each of its pieces one Gauss rule gives
/// the length to rounding.
class LengthTable {
 public:
  explicit LengthTable(const NurbsCurve<3>& curve) : curve_(curve), ends_{curve.domain().first}, lengths_{0.0} {
    const std::vector<double> knots = curve.knots().breakpoints();
    // A first guess of the length, against which the pieces are judged.
    double guess = 0.0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) guess += length_of(curve, {knots[i], knots[i + 1]});
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) add({knots[i], knots[i + 1]}, guess, 0);
  }

  double total() const { return lengths_.back(); }

  /// Of the breakpoints strictly inside the domain.
  double length_at(double t) const {
    const std::size_t i = static_cast<std::size_t>(std::ranges::lower_bound(ends_, t) - ends_.begin());
    return lengths_[i];
  }

  /// Newton's method kept inside the piece.
  double parameter_at(double length) const {
    if (length <= 0.0) return ends_.front();
    if (length >= total()) return ends_.back();
    const std::size_t i = static_cast<std::size_t>(std::ranges::upper_bound(lengths_, length) - lengths_.begin()) - 1;
    Interval bracket{ends_[i], ends_[i + 1]};
    const double part = lengths_[i + 1] - lengths_[i];
    double t = bracket.first + bracket.length() * (length - lengths_[i]) / part;
    for (int step = 0; step < 60; ++step) {
      const double excess = lengths_[i] + length_of(curve_, {ends_[i], t}) - length;
      (excess > 0.0 ? bracket.last : bracket.first) = t;
      const double rate = speed(curve_, t);
      double next = rate > 0.0 ? t - excess / rate : bracket.middle();
      if (!(bracket.first <= next && next <= bracket.last)) next = bracket.middle();
      if (std::abs(next - t) <= 2.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t), bracket.length()))
        return next;
      t = next;
    }
    return t;
  }

 private:
  void add(const Interval& piece, double guess, int depth) {
    const double whole = length_of(curve_, piece);
    const double middle = piece.middle();
    const double first = length_of(curve_, {piece.first, middle});
    const double last = length_of(curve_, {middle, piece.last});
    if (std::abs(first + last - whole) > 1e-15 * guess && depth < deepest_halving) {
      add({piece.first, middle}, guess, depth + 1);
      add({middle, piece.last}, guess, depth + 1);
      return;
    }
    ends_.push_back(piece.last);
    lengths_.push_back(lengths_.back() + first + last);
  }

  const NurbsCurve<3>& curve_;
  std::vector<double> ends_;
  std::vector<double> lengths_;
};

bool is_line(const NurbsCurve<3>& curve) {
  return curve.degree() == 1 && curve.homogeneous().cols() == 2 && curve.is_polynomial();
}

/// Whether its IGES parameter runs with its length: circular arcs alone among the curves with angles.
bool is_circular_arc(const ParametrisedCurve& curve, const LengthTable& table) {
  if (curve.parameters.is_identity() || curve.parameters.pieces().front().half_rate == 0.0) return false;
  const Interval range = parameter_range(curve);
  return std::ranges::all_of(std::vector<double>{0.07, 0.21, 0.4, 0.63, 0.77}, [&](double part) {
    const double by_parameter = curve.parameters(range.first + part * range.length());
    const double by_length = table.parameter_at(part * table.total());
    return std::abs(by_parameter - by_length) <= 1e-13 * curve.curve.domain().length();
  });
}

}  // namespace

ParametrisedCurve by_relative_length(const ParametrisedCurve& curve, double tolerance) {
  if (is_line(curve.curve)) return curve;
  const LengthTable table(curve.curve);
  if (!(table.total() > 0.0) || is_circular_arc(curve, table)) return curve;
  std::vector<double> breakpoints{0.0};
  for (const double t : curve.curve.knots().breakpoints()) {
    const double part = table.length_at(t) / table.total();
    if (part > breakpoints.back() && part < 1.0) breakpoints.push_back(part);
  }
  breakpoints.push_back(1.0);
  const FittedCurve<3> fit =
      fit_curve<3>([&](double s) -> Point3 { return evaluate(curve.curve, table.parameter_at(s * table.total())); },
                   breakpoints, {.tolerance = tolerance, .largest_count = 64});
  return {fit.curve, {}, std::max(fit.deviation, curve.deviation), tolerance};
}

}  // namespace isorim::io::iges
