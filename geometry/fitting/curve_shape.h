#pragma once

#include <span>
#include <vector>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/foot_points.h"

namespace isorim::geometry {

/// Length times the integral of the squared curvature over the length, to a relative error of about 1e-6: 4 pi^2 on a
/// circle, whatever its radius.
template <int Dim>
double bending_energy(const SegmentedCurve<Dim>& curve);

/// A part of a plane curve between two successive changes of the sign of its curvature.
struct CurvatureLobe {
  double first = 0.0;
  /// May lie beyond the domain, by less than its length, on a closed curve.
  double last = 0.0;
  /// The largest distance of the lobe from its chord, to a few per cent.
  double height = 0.0;
};
/// All lobes in the order of the curve; of an open curve not those that its ends cut off.
std::vector<CurvatureLobe> curvature_lobes(const SegmentedCurve<2>& curve, bool closed);

/// How often C' x C'' changes its sign; sign changes below 1e-12 of its natural size, and touching zeros, do not count.
int curvature_sign_changes(const SegmentedCurve<2>& curve, bool closed);

/// The part of the quality that is the curve's own.
template <int Dim>
FitQuality<Dim> shape_quality(const SegmentedCurve<Dim>& curve, bool closed);

/// The part of the quality that is the points'.
template <int Dim>
void add_distances(std::span<const double> distances, FitQuality<Dim>& quality);

}  // namespace isorim::geometry
