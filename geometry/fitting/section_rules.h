#pragma once

#include <span>
#include <vector>

#include "geometry/vocabulary.h"

/// The rules by which L. R. Pereira (dissertation, Universidade Federal de Uberlândia, 2014, section 5.3 and its
/// program) judges the points of a closed section, each with its neighbours before and after it, cyclically. All need
/// 3 points or more, of which consecutive ones differ; else GeometryError.
namespace isorim::geometry {

/// The radius of the circle through each point and its neighbours; infinite if they lie on a line to rounding.
template <int Dim>
std::vector<double> circle_radii(const Points<Dim>& points);

/// Mean and standard deviation (divisor count - 1) of the finite radii.
struct RadiusStatistics {
  double mean = 0.0;
  double deviation = 0.0;

  /// Above this radius points count as lying on a line (eq. 5.5).
  double largest() const { return mean + deviation; }
};
RadiusStatistics radius_statistics(std::span<const double> radii);

/// The quotient largest() / r for radii below largest(); the largest such quotient for all others (eq. 5.6 and what
/// follows it). All 1 if fewer than two radii are finite or none is below largest().
std::vector<double> curvature_weights(std::span<const double> radii);

/// The interior angle at each point, in degrees: 180 on a line (eq. 5.8).
template <int Dim>
std::vector<double> interior_angles(const Points<Dim>& points);

/// Mean and standard deviation (divisor count - 1) of the angles.
struct AngleStatistics {
  double mean = 0.0;
  double deviation = 0.0;

  /// Above this angle points count as aligned with their neighbours.
  double threshold() const { return mean + 0.5 * deviation; }
};
AngleStatistics angle_statistics(std::span<const double> angles);

/// The points whose angle exceeds the threshold, fit to start a curve from (section 5.3.3).
std::vector<int> aligned_points(std::span<const double> angles);

/// One more than the number of times that the turn of three successive points changes its sign or is zero, along the
/// sequence that starts with the turn of the first three: the count of the published program. In space the turn is
/// measured along the area vector of the closed polygon.
template <int Dim>
int curvature_inversions(const Points<Dim>& points);

/// The number of control points: the curvature inversions, but at least half the number of points (section 5.3.4).
template <int Dim>
int inversion_control_points(const Points<Dim>& points);

/// The same for an open sequence, whose ends are no neighbours and may coincide. Turns that are rounding are none, so
/// points on a line count as having no inversion.
template <int Dim>
int open_inversion_control_points(const Points<Dim>& points);

}  // namespace isorim::geometry
