#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

/// Areas and volumes by Gauss-Legendre rules on every knot span: slow, simple, and independent of the product's rules.
namespace isorim::geometry::testing {

struct GaussRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

/// On [0, 1]; Newton on the Legendre recurrence.
inline GaussRule gauss_rule(int n) {
  GaussRule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int k = 0; k < 50; ++k) {
      double p0 = 1.0;
      double p1 = x;
      for (int j = 2; j <= n; ++j) {
        const double p2 = ((2.0 * j - 1.0) * x * p1 - (j - 1.0) * p0) / j;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1.0);
      x -= p1 / slope;
    }
    rule.nodes.push_back(0.5 * (1.0 - x));
    rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

struct Measures {
  /// Length or area of the boundary.
  double boundary = 0.0;
  /// Area or volume; the sign is that of the normals.
  double content = 0.0;
};

inline Measures measures(const Boundary<2>& boundary, int n = 24) {
  const GaussRule rule = gauss_rule(n);
  Measures sum;
  for (const Patch<2>& patch : boundary.patches) {
    const std::vector<double> breaks = patch.shape.knots().breakpoints();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      const double length = breaks[i + 1] - breaks[i];
      for (int k = 0; k < n; ++k) {
        const CurveJet<2> jet = evaluate_jet(patch.shape, breaks[i] + length * rule.nodes[k]);
        const double weight = length * rule.weights[k];
        sum.boundary += weight * jet.du.norm();
        sum.content += 0.5 * weight * patch.orientation * (jet.point.x() * jet.du.y() - jet.point.y() * jet.du.x());
      }
    }
  }
  return sum;
}

inline Measures measures(const Boundary<3>& boundary, int n = 24) {
  const GaussRule rule = gauss_rule(n);
  Measures sum;
  for (const Patch<3>& patch : boundary.patches) {
    const NurbsSurface<3>& surface = std::get<NurbsSurface<3>>(patch.shape);
    const std::vector<double> us = surface.knots_u().breakpoints();
    const std::vector<double> vs = surface.knots_v().breakpoints();
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        const double du = us[i + 1] - us[i];
        const double dv = vs[j + 1] - vs[j];
        for (int k = 0; k < n; ++k) {
          for (int l = 0; l < n; ++l) {
            const SurfaceJet<3> jet =
                evaluate_jet(surface, Point2(us[i] + du * rule.nodes[k], vs[j] + dv * rule.nodes[l]));
            const Vector3 normal = jet.du.cross(jet.dv);
            const double weight = du * dv * rule.weights[k] * rule.weights[l];
            sum.boundary += weight * normal.norm();
            sum.content += weight * patch.orientation * jet.point.dot(normal) / 3.0;
          }
        }
      }
    }
  }
  return sum;
}

}  // namespace isorim::geometry::testing
