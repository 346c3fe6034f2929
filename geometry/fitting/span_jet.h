#pragma once

#include <algorithm>
#include <array>

#include "geometry/spline/knot_vector.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A derivative of one span of a spline, and how it changes with everything that it depends on: parameter, control
/// points and knots. Degree: of the spline, where it is known when compiled; else 0.
template <int Dim, int Degree>
struct SpanJet {
  static constexpr int most = Degree > 0 ? Degree : KnotVector::max_degree;

  Vector<Dim> value;
  /// With respect to u.
  Vector<Dim> du;
  /// With respect to control points 0 .. p of the span.
  std::array<double, most + 1> basis;
  /// With respect to knots 0 .. 2p - 1 around the span, which is [knots[p - 1], knots[p]]; u held.
  std::array<Vector<Dim>, 2 * most> moves;
};

/// The derivative of order `order` (0: the point; at most the degree) at u. control: the p + 1 control points of the
/// span, knots: the 2p around it; degree: used if Degree is 0.
///
/// Differences of control points, then de Boor's algorithm, run forwards, and once backwards to differentiate them: a
/// blend d_i = d_{i-1} + a (d_i - d_{i-1}), a = (u - t_left) / (t_right - t_left), on which the result depends by the
/// factor w moves it by w (d_i - d_{i-1}) da, and passes w (1 - a) and w a on to what it blends. What arrives at the
/// control points are the basis functions. O(p^2) for all 2p knots together.
template <int Dim, int Degree>
void fill_span_jet(int degree, int order, const Vector<Dim>* control, const double* knots, double u,
                   SpanJet<Dim, Degree>& jet) {
  constexpr int most = SpanJet<Dim, Degree>::most;
  const int p = Degree > 0 ? Degree : degree;
  if (p < 1) return;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  // Level r = 1 .. p joins points i - 1 and i, i = r .. p, between knots i - 1 and i + p - r.
  std::array<std::array<Vector<Dim>, most + 1>, most> steps;
  std::array<std::array<double, most + 1>, most> shares;
  std::array<std::array<double, most + 1>, most> inverses;
  std::array<Vector<Dim>, most + 1> net;
  std::copy_n(control, p + 1, net.begin());
  for (int r = 1; r <= p; ++r)
    for (int i = p; i >= r; --i) {
      const double inverse = 1.0 / (knots[i + p - r] - knots[i - 1]);
      const double share = r <= order ? (p - r + 1) * inverse : (u - knots[i - 1]) * inverse;
      const Vector<Dim> step = net[at(i)] - net[at(i - 1)];
      net[at(i)] = r <= order ? Vector<Dim>(share * step) : Vector<Dim>(net[at(i - 1)] + share * step);
      steps[at(r - 1)][at(i)] = step;
      shares[at(r - 1)][at(i)] = share;
      inverses[at(r - 1)][at(i)] = inverse;
    }
  jet.value = net[at(p)];
  jet.du.setZero();
  if (order < p) jet.du = (p - order) * inverses[at(p - 1)][at(p)] * steps[at(p - 1)][at(p)];
  std::fill_n(jet.basis.begin(), p, 0.0);
  std::fill_n(jet.moves.begin(), 2 * p, Vector<Dim>::Zero());
  jet.basis[at(p)] = 1.0;
  for (int r = p; r >= 1; --r)
    for (int i = r; i <= p; ++i) {
      const double weight = jet.basis[at(i)];
      const double share = shares[at(r - 1)][at(i)];
      const Vector<Dim> move = weight * inverses[at(r - 1)][at(i)] * steps[at(r - 1)][at(i)];
      const double kept = r <= order ? 0.0 : weight;
      const double left = r <= order ? -share : 1.0 - share;
      jet.basis[at(i)] = share * weight;
      jet.basis[at(i - 1)] += kept - jet.basis[at(i)];
      jet.moves[at(i - 1)] -= left * move;
      jet.moves[at(i + p - r)] -= share * move;
    }
}

}  // namespace isorim::geometry
