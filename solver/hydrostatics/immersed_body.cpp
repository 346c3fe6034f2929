#include "solver/hydrostatics/immersed_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace isorim::solver {
namespace {

using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using quadrature::Estimate;
using Layout = WettedLayout;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Values of linear functions of the sums, and their errors.
class LinearSums {
 public:
  explicit LinearSums(const WettedSums& sums)
      : value_(sums.value), error_(sums.error + 4.0 * epsilon * sums.magnitude) {}

  /// int n_j dS and the like, contracted with vectors: int (a.y) (b.y) (c.n) dS, int (a.y) (c.n) dS, int c.n dS.
  Estimate normal(const Vector3& c) const {
    Estimate sum;
    for (int j = 0; j < 3; ++j) add(Layout::normal + j, c[j], sum);
    return sum;
  }
  Estimate first(const Vector3& a, const Vector3& c) const {
    Estimate sum;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) add(Layout::first_index(i, j), a[i] * c[j], sum);
    return sum;
  }
  Estimate second(const Vector3& a, const Vector3& b, const Vector3& c) const {
    Estimate sum;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) add(index(i, k, j), a[i] * b[k] * c[j], sum);
    return sum;
  }
  /// int y.n dS and int (a.y) (y.n) dS.
  Estimate radial() const {
    Estimate sum;
    for (int j = 0; j < 3; ++j) add(Layout::first_index(j, j), 1.0, sum);
    return sum;
  }
  Estimate radial(const Vector3& a) const {
    Estimate sum;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) add(index(i, j, j), a[i], sum);
    return sum;
  }

 private:
  static int index(int a, int b, int j) { return Layout::second_index(std::min(a, b), std::max(a, b), j); }
  void add(int k, double factor, Estimate& sum) const {
    sum.value += factor * value_[k];
    sum.error += std::abs(factor) * error_[k];
  }

  WettedArray value_;
  WettedArray error_;
};

/// a + factor b.
Estimate plus(const Estimate& a, double factor, const Estimate& b) {
  return {a.value + factor * b.value, a.error + std::abs(factor) * b.error};
}

Estimate scaled(const Estimate& a, double factor) {
  return {factor * a.value, std::abs(factor) * a.error};
}

/// h: of the pole over the body's middle, along up.
void set_volume(const LinearSums& sums, const Point3& middle, double h, ImmersedBody& result) {
  const Vector3& up = result.axes.up;
  result.volume = scaled(plus(sums.radial(), -h, sums.normal(up)), 1.0 / 3.0);
  const Point3 pole = middle + h * up;
  result.centre_of_buoyancy = pole;
  if (!(result.volume.value > 0.0)) return;
  for (int i = 0; i < 3; ++i) {
    const Vector3 axis = Vector3::Unit(i);
    // int (y - h up)_i (y - h up).n dS
    Estimate moment = plus(sums.radial(axis), -h, sums.first(axis, up));
    moment = plus(moment, -h * up[i], plus(sums.radial(), -h, sums.normal(up)));
    const double offset = 0.25 * moment.value / result.volume.value;
    result.centre_of_buoyancy[i] = pole[i] + offset;
    result.centre_error[i] = (0.25 * moment.error + std::abs(offset) * result.volume.error) / result.volume.value +
                             epsilon * std::abs(pole[i]);
  }
}

void set_waterplane(const LinearSums& sums, const Point3& middle, double h, ImmersedBody& result) {
  const WaterAxes& axes = result.axes;
  WaterplaneProperties& plane = result.waterplane;
  plane.area = scaled(sums.normal(axes.up), -1.0);
  plane.centroid = middle + h * axes.up;
  if (!(plane.area.value > plane.area.error)) {
    plane.area.value = std::max(0.0, plane.area.value);
    return;
  }
  const std::array<Vector3, 2> along{axes.forward, axes.port};
  Vector2 offset;
  Vector2 first_error;
  for (std::size_t i = 0; i < 2; ++i) {
    const Estimate first = scaled(sums.first(along[i], axes.up), -1.0);
    const auto k = static_cast<Eigen::Index>(i);
    offset[k] = first.value / plane.area.value;
    first_error[k] = first.error;
    plane.centroid_error[k] = (first.error + std::abs(offset[k]) * plane.area.error) / plane.area.value;
    plane.centroid += offset[k] * along[i];
  }
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (Eigen::Index k = 0; k < 2; ++k) {
      const Estimate about_middle =
          scaled(sums.second(along[static_cast<std::size_t>(i)], along[static_cast<std::size_t>(k)], axes.up), -1.0);
      plane.second_moments(i, k) = about_middle.value - plane.area.value * offset[i] * offset[k];
      plane.second_moments_error(i, k) = about_middle.error + std::abs(offset[i]) * first_error[k] +
                                         std::abs(offset[k]) * first_error[i] +
                                         std::abs(offset[i] * offset[k]) * plane.area.error;
    }
  }
}

}  // namespace

WaterAxes water_axes(const Vector3& up) {
  const double across = std::hypot(up.y(), up.z());
  const double sin_heel = across > 0.0 ? up.y() / across : 0.0;
  const double cos_heel = across > 0.0 ? up.z() / across : 1.0;
  return {{across, -up.x() * sin_heel, -up.x() * cos_heel}, {0.0, cos_heel, -sin_heel}, up};
}

ImmersedBody immersed_body(const FloatingBody& body, const WaterPlane& plane, const WettedPart& part) {
  const LinearSums sums(part.sums);
  const Point3& middle = body.reference();
  const double h = plane.offset + part.shift - plane.up.dot(middle);
  ImmersedBody result;
  result.axes = water_axes(plane.up);
  set_volume(sums, middle, h, result);
  set_waterplane(sums, middle, h, result);
  // What the moved plane may cost.
  result.volume.error += std::abs(part.shift) * result.waterplane.area.value;
  const double area = part.sums.value[Layout::area];
  if (area > 0.0)
    result.closure_defect =
        std::hypot(sums.normal(result.axes.forward).value, sums.normal(result.axes.port).value) / area;
  return result;
}

}  // namespace isorim::solver
