#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "quadrature/element_sums.h"
#include "quadrature/gauss_legendre.h"

/// Regions of the unit cell, and integrals over them by brute force.
namespace isorim::quadrature::testing {

using Curve = geometry::HomogeneousPoints<2>;
using geometry::Point2;

inline Curve line(const Point2& from, const Point2& to) {
  Curve net(3, 2);
  net << from, to, 1.0, 1.0;
  return net;
}

/// The arc of less than half a turn from one angle to another, as a rational quadratic.
inline Curve arc(const Point2& centre, double radius, double from, double to) {
  const double weight = std::cos(0.5 * (to - from));
  const auto at = [&](double angle, double r) { return Point2(centre + r * Point2(std::cos(angle), std::sin(angle))); };
  Curve net(3, 3);
  net.col(0) << at(from, radius), 1.0;
  net.col(1) << weight * at(0.5 * (from + to), radius / weight), weight;
  net.col(2) << at(to, radius), 1.0;
  return net;
}

inline geometry::TrimmedRegion polygon(const std::vector<Point2>& corners) {
  geometry::TrimmedRegion region;
  for (std::size_t i = 0; i < corners.size(); ++i)
    region.curves.push_back(line(corners[i], corners[(i + 1) % corners.size()]));
  return region;
}

inline geometry::TrimmedRegion whole_cell() {
  return polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
}

/// Appends a circle in `arcs` exact arcs, counter-clockwise, or clockwise as a hole.
inline void add_circle(geometry::TrimmedRegion& region, const Point2& centre, double radius, int arcs, int sense) {
  const double step = sense * 2.0 * std::numbers::pi / arcs;
  for (int i = 0; i < arcs; ++i) region.curves.push_back(arc(centre, radius, i * step, (i + 1) * step));
}

/// A closed curve r(angle) about a centre as `pieces` cubics that follow its points and tangents (Hermite).
inline void add_blob(geometry::TrimmedRegion& region, const Point2& centre, double radius, double waviness, int waves,
                     int pieces, int sense, double phase = 0.0) {
  const auto r = [&](double angle) { return radius * (1.0 + waviness * std::cos(waves * angle + phase)); };
  const auto slope = [&](double angle) { return -radius * waviness * waves * std::sin(waves * angle + phase); };
  const double step = sense * 2.0 * std::numbers::pi / pieces;
  for (int i = 0; i < pieces; ++i) {
    Curve net(3, 4);
    for (const int end : {0, 1}) {
      // The last piece ends where the first begins, bit for bit.
      const double angle = ((i + end) % pieces) * step;
      const Point2 radial(std::cos(angle), std::sin(angle));
      const Point2 point = centre + r(angle) * radial;
      const Point2 tangent = slope(angle) * radial + r(angle) * Point2(-radial[1], radial[0]);
      net.col(3 * end) << point, 1.0;
      net.col(1 + end) << point + (end == 0 ? 1.0 : -1.0) * step / 3.0 * tangent, 1.0;
    }
    region.curves.push_back(net);
  }
}

/// Values and derivatives of a homogeneous net, 4 x (p + 1)(q + 1), by de Casteljau's algorithm.
struct NetJet {
  geometry::Point3 point;
  geometry::Vector3 normal;
};

inline NetJet evaluate_net(const double* net, int p, int q, double u, double v) {
  const auto reduce = [](std::vector<Eigen::Vector4d> row, double s, int steps) {
    for (int step = 0; step < steps; ++step) {
      for (std::size_t i = 0; i + 1 < row.size(); ++i) row[i] = (1.0 - s) * row[i] + s * row[i + 1];
      row.pop_back();
    }
    return row;
  };
  std::vector<Eigen::Vector4d> values;
  std::vector<Eigen::Vector4d> derivatives;
  for (int j = 0; j <= q; ++j) {
    std::vector<Eigen::Vector4d> row;
    for (int i = 0; i <= p; ++i) row.emplace_back(Eigen::Map<const Eigen::Vector4d>(net + 4 * (j * (p + 1) + i)));
    const auto ends = reduce(row, u, p - 1);
    values.emplace_back((1.0 - u) * ends[0] + u * ends[1]);
    derivatives.emplace_back(p * (ends[1] - ends[0]));
  }
  const auto ends = reduce(values, v, q - 1);
  const Eigen::Vector4d x = (1.0 - v) * ends[0] + v * ends[1];
  const Eigen::Vector4d xv = q * (ends[1] - ends[0]);
  const Eigen::Vector4d xu = reduce(derivatives, v, q)[0];
  const geometry::Point3 point = x.head<3>() / x[3];
  const geometry::Vector3 du = (xu.head<3>() - xu[3] * point) / x[3];
  const geometry::Vector3 dv = (xv.head<3>() - xv[3] * point) / x[3];
  return {point, {du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2], du[0] * dv[1] - du[1] * dv[0]}};
}

/// sum over the curves of int int g(c + t (gamma(s) - c)) t (gamma - c) x gamma' dt ds, by `parts` x `parts` tensor
/// rules of 24 points a curve: the radial integration method with any pole c, independent of what is tested.
template <class Value, class Function>
Value integrate_by_sectors(const geometry::TrimmedRegion& region, const Point2& pole, int parts, Value zero,
                           Function g) {
  const Rule& rule = gauss_legendre(24);
  Value total = zero;
  for (const Curve& net : region.curves) {
    const int degree = static_cast<int>(net.cols()) - 1;
    for (int a = 0; a < parts * rule.size(); ++a) {
      const double s = (a / rule.size() + rule.nodes[static_cast<std::size_t>(a % rule.size())]) / parts;
      Curve row = net;
      for (int count = degree; count > 1; --count) {
        for (int i = 0; i < count; ++i) row.col(i) = ((1.0 - s) * row.col(i) + s * row.col(i + 1)).eval();
      }
      const Eigen::Vector3d x = (1.0 - s) * row.col(0) + s * row.col(1);
      const Eigen::Vector3d dx = degree * (row.col(1) - row.col(0));
      const Point2 d = x.head<2>() / x[2] - pole;
      const Point2 tangent = (dx.head<2>() - dx[2] * (d + pole)) / x[2];
      const double ds = rule.weights[static_cast<std::size_t>(a % rule.size())] / parts;
      const double flux = (d[0] * tangent[1] - d[1] * tangent[0]) * ds;
      if (flux == 0.0) continue;
      for (int b = 0; b < parts * rule.size(); ++b) {
        const double t = (b / rule.size() + rule.nodes[static_cast<std::size_t>(b % rule.size())]) / parts;
        const double dt = rule.weights[static_cast<std::size_t>(b % rule.size())] / parts;
        total += flux * t * dt * g(Point2(pole + t * d));
      }
    }
  }
  return total;
}

/// All sums over a cut element by sectors.
inline ElementSums<3> sums_by_sectors(const geometry::ElementTable<3>& table, std::size_t e, const geometry::Point3& x0,
                                      const Point2& pole, int parts) {
  using Layout = SumLayout<3>;
  const geometry::BezierElement<3>& element = table.elements[e];
  const double* net = table.net(element).data();
  const auto integrand = [&](const Point2& uv) {
    const NetJet jet = evaluate_net(net, element.degree[0], element.degree[1], uv[0], uv[1]);
    const geometry::Vector3 d = jet.point - x0;
    const geometry::Vector3 n = element.orientation * jet.normal;
    ElementSums<3> sums;
    sums[Layout::measure] = n.norm();
    sums[Layout::content] = d.dot(n);
    for (int i = 0; i < 3; ++i) {
      sums[Layout::normal + i] = n[i];
      sums[Layout::first + i] = d.dot(n) * d[i];
      for (int j = i; j < 3; ++j) sums[Layout::second_index(i, j)] = d.dot(n) * d[i] * d[j];
    }
    return sums;
  };
  const geometry::TrimmedRegion& region = table.regions[static_cast<std::size_t>(element.region)];
  const ElementSums<3> zero = ElementSums<3>::Zero();
  return integrate_by_sectors(region, pole, parts, zero, integrand);
}

}  // namespace isorim::quadrature::testing
