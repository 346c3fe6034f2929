#pragma once

#include "geometry/intersection/plane_section.h"
#include "tests/geometry/measures.h"

/// Areas and lengths of sections by Gauss rules.
namespace isorim::geometry::testing {

/// Counter-clockwise positive.
inline double section_area(const SectionCurve& curve) {
  static const GaussRule rule = gauss_rule(20);
  double sum = 0.0;
  for (const NurbsCurve<2>& part : curve.plane_curves.curves) {
    const std::vector<double> breaks = part.knots().breakpoints();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const double length = breaks[i + 1] - breaks[i];
        const CurveJet<2> jet = evaluate_jet(part, breaks[i] + length * rule.nodes[k]);
        sum += 0.5 * length * rule.weights[k] * (jet.point.x() * jet.du.y() - jet.point.y() * jet.du.x());
      }
  }
  return sum;
}

inline double section_area(const PlaneSection& section) {
  double sum = 0.0;
  for (const SectionLoop& loop : section.loops) sum += section_area(loop.curve);
  return sum;
}

inline double piece_length(const SectionPiece& piece) {
  static const GaussRule rule = gauss_rule(20);
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k)
    sum += rule.weights[k] * evaluate_jet(piece, rule.nodes[k]).derivative.norm();
  return sum;
}

}  // namespace isorim::geometry::testing
