#include "geometry/fitting/section_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Of the area vector of sides a and b that meet in a point, whose coordinates are known to half a unit in their last
/// place.
template <int Dim>
double area_rounding(const Point<Dim>& here, const Vector<Dim>& a, const Vector<Dim>& b) {
  return 2.0 * epsilon * here.cwiseAbs().maxCoeff() * (a.norm() + b.norm());
}

template <int Dim>
void require_section(const Points<Dim>& points) {
  if (points.cols() < 3)
    throw GeometryError(fmt::format("section: {} points given; expected 3 or more", points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) throw GeometryError(fmt::format("section: point {} is not finite", i));
    if (points.col(i) == points.col((i + 1) % points.cols()))
      throw GeometryError(fmt::format("section: points {} and {} are the same", i, (i + 1) % points.cols()));
  }
}

/// Twice the area of the parallelogram of two sides, with its direction.
Vector3 area_vector(const Vector2& a, const Vector2& b) {
  return {0.0, 0.0, a[0] * b[1] - a[1] * b[0]};
}
Vector3 area_vector(const Vector3& a, const Vector3& b) {
  return a.cross(b);
}

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values, double mean) {
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace

template <int Dim>
std::vector<double> circle_radii(const Points<Dim>& points) {
  require_section(points);
  const Eigen::Index count = points.cols();
  std::vector<double> radii(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    const Point<Dim> here = points.col(i);
    const Vector<Dim> a = here - points.col((i + count - 1) % count);
    const Vector<Dim> b = points.col((i + 1) % count) - here;
    const double twice_area = area_vector(a, b).norm();
    radii[static_cast<std::size_t>(i)] = twice_area <= area_rounding<Dim>(here, a, b)
                                             ? std::numeric_limits<double>::infinity()
                                             : a.norm() * b.norm() * (a + b).norm() / (2.0 * twice_area);
  }
  return radii;
}

RadiusStatistics radius_statistics(std::span<const double> radii) {
  std::vector<double> finite;
  std::copy_if(radii.begin(), radii.end(), std::back_inserter(finite), [](double r) { return std::isfinite(r); });
  if (finite.size() < 2)
    throw GeometryError(
        fmt::format("section: {} points have a finite radius of curvature; expected 2 or more", finite.size()));
  RadiusStatistics statistics;
  statistics.mean = mean_of(finite);
  statistics.deviation = deviation_of(finite, statistics.mean);
  return statistics;
}

std::vector<double> curvature_weights(std::span<const double> radii) {
  std::vector<double> weights(radii.size(), 1.0);
  if (std::count_if(radii.begin(), radii.end(), [](double r) { return std::isfinite(r); }) < 2) return weights;
  const double largest_radius = radius_statistics(radii).largest();
  double largest = 0.0;
  for (const double r : radii)
    if (r < largest_radius) largest = std::max(largest, largest_radius / r);
  if (largest == 0.0) return weights;
  for (std::size_t i = 0; i < radii.size(); ++i)
    weights[i] = radii[i] < largest_radius ? largest_radius / radii[i] : largest;
  return weights;
}

template <int Dim>
std::vector<double> interior_angles(const Points<Dim>& points) {
  require_section(points);
  const Eigen::Index count = points.cols();
  std::vector<double> angles(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector<Dim> a = points.col((i + count - 1) % count) - points.col(i);
    const Vector<Dim> b = points.col((i + 1) % count) - points.col(i);
    angles[static_cast<std::size_t>(i)] = std::atan2(area_vector(a, b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
  }
  return angles;
}

AngleStatistics angle_statistics(std::span<const double> angles) {
  AngleStatistics statistics;
  statistics.mean = mean_of(angles);
  statistics.deviation = deviation_of(angles, statistics.mean);
  return statistics;
}

std::vector<int> aligned_points(std::span<const double> angles) {
  const double threshold = angle_statistics(angles).threshold();
  std::vector<int> aligned;
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (angles[i] > threshold) aligned.push_back(static_cast<int>(i));
  return aligned;
}

template <int Dim>
int curvature_inversions(const Points<Dim>& points) {
  require_section(points);
  const Eigen::Index count = points.cols();
  Vector3 area = Vector3::Zero();
  for (Eigen::Index i = 0; i + 1 < count; ++i)
    area += area_vector(Vector<Dim>(points.col(i) - points.col(0)), Vector<Dim>(points.col(i + 1) - points.col(0)));
  const double size = area.norm();
  const Vector3 axis = size > 0.0 && Dim == 3 ? Vector3(area / size) : Vector3::UnitZ();
  int inversions = 1;
  double before = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector<Dim> a = points.col((i + 1) % count) - points.col(i);
    const Vector<Dim> b = points.col((i + 2) % count) - points.col(i);
    const double turn = area_vector(a, b).dot(axis);
    if (i > 0 && (turn == 0.0 || before == 0.0 || (turn > 0.0) != (before > 0.0))) ++inversions;
    before = turn;
  }
  return inversions;
}

template <int Dim>
int inversion_control_points(const Points<Dim>& points) {
  return std::max(curvature_inversions(points), static_cast<int>(points.cols() / 2));
}

template <int Dim>
int open_inversion_control_points(const Points<Dim>& points) {
  int inversions = 1;
  Vector3 before = Vector3::Zero();
  for (Eigen::Index i = 1; i + 1 < points.cols(); ++i) {
    const Point<Dim> here = points.col(i);
    const Vector<Dim> a = here - points.col(i - 1);
    const Vector<Dim> b = points.col(i + 1) - here;
    const Vector3 turn = area_vector(a, b);
    if (turn.norm() <= area_rounding<Dim>(here, a, b)) continue;
    if (turn.dot(before) < 0.0) ++inversions;
    before = turn;
  }
  return std::max(inversions, static_cast<int>(points.cols() / 2));
}

template std::vector<double> circle_radii(const Points<2>&);
template std::vector<double> circle_radii(const Points<3>&);
template std::vector<double> interior_angles(const Points<2>&);
template std::vector<double> interior_angles(const Points<3>&);
template int curvature_inversions(const Points<2>&);
template int curvature_inversions(const Points<3>&);
template int inversion_control_points(const Points<2>&);
template int inversion_control_points(const Points<3>&);
template int open_inversion_control_points(const Points<2>&);
template int open_inversion_control_points(const Points<3>&);

}  // namespace isorim::geometry
