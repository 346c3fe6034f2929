#include "geometry/shapes/transforms.h"

#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/shapes/checks.h"
#include "geometry/shapes/curves.h"

namespace isorim::geometry {

template <int Dim>
AffineMap<Dim> translation(const Vector<Dim>& by) {
  checks::finite("translation", "by", by);
  AffineMap<Dim> map;
  map.translation = by;
  return map;
}

AffineMap<2> rotation(const Point2& centre, double angle) {
  checks::finite("rotation", "centre", centre);
  checks::finite("rotation", "angle", angle);
  const CosineSine turn = cosine_sine(angle);
  AffineMap<2> map;
  map.linear << turn.cosine, -turn.sine, turn.sine, turn.cosine;
  map.translation = centre - map.linear * centre;
  return map;
}

AffineMap<3> rotation(const Axis& axis, double angle) {
  checks::finite("rotation", "axis point", axis.point);
  checks::finite("rotation", "angle", angle);
  const Vector3 k = checks::unit<3>("rotation", "axis direction", axis.direction);
  const CosineSine turn = cosine_sine(angle);
  Eigen::Matrix3d cross;
  cross << 0.0, -k.z(), k.y(), k.z(), 0.0, -k.x(), -k.y(), k.x(), 0.0;
  AffineMap<3> map;
  map.linear = turn.cosine * Eigen::Matrix3d::Identity() + turn.sine * cross + (1.0 - turn.cosine) * k * k.transpose();
  map.translation = axis.point - map.linear * axis.point;
  return map;
}

template <int Dim>
AffineMap<Dim> scaling(const Vector<Dim>& factors, const Point<Dim>& centre) {
  checks::finite("scaling", "factors", factors);
  checks::finite("scaling", "centre", centre);
  for (int i = 0; i < Dim; ++i) {
    if (factors(i) == 0.0) throw GeometryError(fmt::format("scaling: factors[{}] is 0", i));
  }
  AffineMap<Dim> map;
  map.linear = factors.asDiagonal();
  map.translation = centre - map.linear * centre;
  return map;
}

template <int Dim>
AffineMap<Dim> mirroring(const Point<Dim>& point, const Vector<Dim>& normal) {
  checks::finite("mirror", "point", point);
  const Vector<Dim> n = checks::unit<Dim>("mirror", "normal", normal);
  AffineMap<Dim> map;
  map.linear -= 2.0 * n * n.transpose();
  map.translation = 2.0 * n.dot(point) * n;
  return map;
}

template <int Dim>
AffineMap<Dim> compose(const AffineMap<Dim>& outer, const AffineMap<Dim>& inner) {
  AffineMap<Dim> map;
  map.linear = outer.linear * inner.linear;
  map.translation = outer.linear * inner.translation + outer.translation;
  return map;
}

template <int Dim>
Boundary<Dim> transform(const Boundary<Dim>& boundary, const AffineMap<Dim>& map) {
  checks::finite("transform", "linear part", map.linear);
  checks::finite("transform", "translation", map.translation);
  const double determinant = map.linear.determinant();
  const double size = map.linear.template lpNorm<Eigen::Infinity>();
  if (std::abs(determinant) <= 1e-30 * std::pow(size, Dim)) {
    throw GeometryError(fmt::format("transform: the map is singular (determinant {})", determinant));
  }
  Boundary<Dim> result;
  result.patches.reserve(boundary.patches.size());
  for (const Patch<Dim>& patch : boundary.patches) {
    result.patches.push_back(
        {patch.name, transform(patch.shape, map), determinant < 0 ? -patch.orientation : patch.orientation});
  }
  return result;
}

template AffineMap<2> translation<2>(const Vector<2>&);
template AffineMap<3> translation<3>(const Vector<3>&);
template AffineMap<2> scaling<2>(const Vector<2>&, const Point<2>&);
template AffineMap<3> scaling<3>(const Vector<3>&, const Point<3>&);
template AffineMap<2> mirroring<2>(const Point<2>&, const Vector<2>&);
template AffineMap<3> mirroring<3>(const Point<3>&, const Vector<3>&);
template AffineMap<2> compose<2>(const AffineMap<2>&, const AffineMap<2>&);
template AffineMap<3> compose<3>(const AffineMap<3>&, const AffineMap<3>&);
template Boundary<2> transform<2>(const Boundary<2>&, const AffineMap<2>&);
template Boundary<3> transform<3>(const Boundary<3>&, const AffineMap<3>&);

}  // namespace isorim::geometry
