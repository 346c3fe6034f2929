#pragma once

#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "quadrature/element_shape.h"
#include "quadrature/target_rules.h"
#include "solver/bem/ray_moments.h"

namespace isorim::solver {

/// Where rules for integrals over rays from a target have to look for what makes them hard. Seen from the target a peak
/// of the load makes the moments along the rays peak in its direction, as if there were a singularity where the ray
/// through the peak meets the boundary: of order 1 / distance at the most, and no nearer to the boundary than the peak
/// is wide. So the rules for singular targets serve, with that place in the role of the target.
template <int Dim>
class PeakTargets {
 public:
  /// The table has to outlive this.
  PeakTargets(const geometry::ElementTable<Dim>& table, std::vector<RayPeak<Dim>> peaks);

  /// The nearest to an element among the target itself and its peaks' places.
  quadrature::Target<Dim> on(int element, const quadrature::Target<Dim>& target) const;

 private:
  /// The ray from the target through a peak.
  struct Line {
    geometry::Point<Dim> from;
    geometry::Vector<Dim> direction;
    /// Of the peak, along the unit direction.
    double at = 0.0;
    double width = 0.0;

    geometry::Point<Dim> point(double t) const { return from + t * direction; }
    /// The nearest to a point, not before the peak.
    double nearest(const geometry::Point<Dim>& point) const;
  };

  quadrature::Target<Dim> on_line(int element, const Line& line) const;

  std::vector<quadrature::ElementShape<Dim>> shapes_;
  std::vector<RayPeak<Dim>> peaks_;
};

}  // namespace isorim::solver
