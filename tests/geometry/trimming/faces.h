#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/loop_pieces.h"
#include "geometry/trimming/trimmed_surface.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/random_splines.h"

/// Trimmed faces of every kind, and integrals over their parts by Green's theorem.
namespace isorim::geometry::testing {

/// A plane surface over the breakpoints given, its points the parameters themselves.
inline NurbsSurface<3> plane_surface(int degree, const std::vector<double>& us, const std::vector<double>& vs) {
  const KnotVector ku = KnotVector::clamped(degree, us);
  const KnotVector kv = KnotVector::clamped(degree, vs);
  const std::vector<double> u = ku.greville_abscissae();
  const std::vector<double> v = kv.greville_abscissae();
  Points<3> points(3, ku.basis_count() * kv.basis_count());
  for (int j = 0; j < kv.basis_count(); ++j)
    for (int i = 0; i < ku.basis_count(); ++i)
      points.col(i + j * ku.basis_count()) << u[static_cast<std::size_t>(i)], v[static_cast<std::size_t>(j)], 0.0;
  return NurbsSurface<3>::from_points(ku, kv, points);
}

inline TrimLoop polygon(const std::vector<Point2>& corners) {
  TrimLoop loop;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Points<2> ends(2, 2);
    ends << corners[i], corners[(i + 1) % corners.size()];
    loop.curves.push_back(NurbsCurve<2>::from_points(KnotVector::bezier(1), ends));
  }
  return loop;
}

inline TrimLoop reversed(const TrimLoop& loop) {
  TrimLoop result;
  for (std::size_t i = loop.curves.size(); i-- > 0;) result.curves.push_back(reverse(loop.curves[i]));
  return result;
}

inline TrimLoop transformed(const TrimLoop& loop, const AffineMap<2>& map) {
  TrimLoop result;
  for (const NurbsCurve<2>& curve : loop.curves) result.curves.push_back(transform(curve, map));
  return result;
}

inline TrimLoop circle_loop(double radius, const Point2& centre) {
  return {{circle(radius, centre)}};
}

/// A closed spline about a point, star-shaped at `wander` below 1.
inline TrimLoop blob(Random& random, const Point2& centre, double radius, int degree, double wander = 0.8) {
  const int count = random.integer(4, 12);
  std::vector<double> breakpoints;
  for (int i = 0; i <= count; ++i) breakpoints.push_back(static_cast<double>(i) / count);
  const KnotVector knots = KnotVector::periodic(degree, breakpoints);
  Points<2> points(2, knots.basis_count());
  std::vector<double> weights(static_cast<std::size_t>(knots.basis_count()));
  for (int i = 0; i < knots.basis_count(); ++i) {
    if (i >= count) {
      points.col(i) = points.col(i - count);
      weights[static_cast<std::size_t>(i)] = weights[static_cast<std::size_t>(i - count)];
      continue;
    }
    const double angle = 2.0 * std::numbers::pi * (i + random.real(0.0, wander)) / count;
    const double r = radius * random.real(0.5, 1.0);
    points.col(i) = centre + r * Vector2(std::cos(angle), std::sin(angle));
    weights[static_cast<std::size_t>(i)] = random.real(0.3, 2.0);
  }
  return {{NurbsCurve<2>::from_points(knots, points, weights)}};
}

/// g(u, v) = exp(a (u - u0) + b (v - v0)): its integral over what closed chains of curves enclose, by Green's theorem.
struct Exponential {
  double a = 0.7;
  double b = -0.4;
  Point2 origin = Point2::Zero();

  double in_u(double u) const { return std::exp(a * (u - origin.x())); }
  double in_v(double v) const { return std::exp(b * (v - origin.y())); }
  double operator()(const Point2& uv) const { return in_u(uv.x()) * in_v(uv.y()); }
};

/// The sum of the contributions and of their magnitudes (against which rounding is judged).
struct GreenSum {
  double value = 0.0;
  double magnitude = 0.0;

  GreenSum& operator+=(const GreenSum& other) {
    value += other.value;
    magnitude += other.magnitude;
    return *this;
  }
};

/// The integral of G dv along a piece, G the integral of g over u; the piece's net lies in the unit cell of a
/// rectangle.
inline GreenSum green_integral(const HomogeneousPoints<2>& net, const Exponential& g, Interval u = {},
                               Interval v = {}) {
  static const GaussRule rule = gauss_rule(24);
  const NurbsCurve<2> curve(KnotVector::bezier(static_cast<int>(net.cols()) - 1), net);
  const int parts = net.cols() == 2 && net(2, 0) == net(2, 1) ? 1 : 4;
  GreenSum sum;
  for (int part = 0; part < parts; ++part) {
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const CurveJet<2> jet = evaluate_jet(curve, (part + rule.nodes[k]) / parts);
      const Point2 uv(u.first + u.length() * jet.point.x(), v.first + v.length() * jet.point.y());
      const double term = rule.weights[k] / parts * g(uv) / g.a * v.length() * jet.du.y();
      sum += {term, std::abs(term)};
    }
  }
  return sum;
}

inline GreenSum green_integral(std::span<const TrimLoop> loops, const Exponential& g) {
  GreenSum sum;
  for (const PlanePiece& piece : loop_pieces(loops)) sum += green_integral(piece.net, g);
  return sum;
}

/// Over the kept part of an element.
inline GreenSum green_integral(const ElementTable<3>& table, const BezierElement<3>& element, const Exponential& g) {
  const auto [u, v] = element.domain;
  GreenSum sum;
  if (element.is_cut()) {
    for (const HomogeneousPoints<2>& curve : table.regions[static_cast<std::size_t>(element.region)].curves)
      sum += green_integral(curve, g, u, v);
    return sum;
  }
  const double value = (g.in_u(u.last) - g.in_u(u.first)) / g.a * (g.in_v(v.last) - g.in_v(v.first)) / g.b;
  return {value, std::abs(value)};
}

}  // namespace isorim::geometry::testing
