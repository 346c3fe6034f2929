#include "io/case/curve_builder.h"

#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/transforms.h"

namespace isorim::io {

using geometry::AffineMap;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::Point;
using geometry::Points;
using geometry::Vector;

void refuse(const KeyPlace& where, std::string_view message) {
  Complaints complaints;
  complaints.add(where, message);
  complaints.throw_if_any();
  throw InputError(std::string(message));
}

namespace {

double radians(double degrees) {
  return degrees * (std::numbers::pi / 180.0);
}

template <int Dim>
Point<Dim> point_or_origin(const Coordinates& coordinates) {
  return coordinates.values.empty() ? Point<Dim>(Point<Dim>::Zero()) : point_of<Dim>(coordinates);
}

template <int Dim>
AffineMap<Dim> scale_map(const NumberArray& scale) {
  if (scale.columns != 1 || (scale.values.size() != 1 && scale.values.size() != Dim)) {
    refuse(scale.where, fmt::format("found {} factors; expected 1 or {}", scale.values.size(), Dim));
  }
  Vector<Dim> factors;
  for (int i = 0; i < Dim; ++i) factors(i) = scale.values.size() == 1 ? scale.values[0] : scale.values[std::size_t(i)];
  return located(scale.where, [&] { return geometry::scaling<Dim>(factors); });
}

template <int Dim>
AffineMap<Dim> rotation_map(const RotationKeys& keys) {
  const Point<Dim> point = point_or_origin<Dim>(keys.point);
  if constexpr (Dim == 2) {
    if (keys.axis) refuse(keys.where, "found an \"axis\"; a shape of the plane turns about a point");
    return geometry::rotation(point, radians(keys.angle));
  } else {
    const Eigen::Vector3d axis = keys.axis.value_or(Eigen::Vector3d::UnitZ());
    return located(keys.where, [&] { return geometry::rotation(geometry::Axis{point, axis}, radians(keys.angle)); });
  }
}

template <int Dim>
AffineMap<Dim> transform_map(const TransformKeys& keys) {
  AffineMap<Dim> map;
  if (keys.scale) map = geometry::compose(scale_map<Dim>(*keys.scale), map);
  if (keys.mirror) {
    const Point<Dim> point = point_or_origin<Dim>(keys.mirror->point);
    const Vector<Dim> normal = point_of<Dim>(keys.mirror->normal);
    map = geometry::compose(located(keys.mirror->where, [&] { return geometry::mirroring<Dim>(point, normal); }), map);
  }
  if (keys.rotate) map = geometry::compose(rotation_map<Dim>(*keys.rotate), map);
  if (keys.translate) map = geometry::compose(geometry::translation<Dim>(point_of<Dim>(*keys.translate)), map);
  return map;
}

void refuse_count(const KeyPlace& where, std::size_t found, int expected) {
  refuse(where, fmt::format("found {} coordinates; expected {}", found, expected));
}

template <int Dim>
geometry::HomogeneousPoints<Dim> homogeneous_points(const std::vector<Coordinates>& coordinates) {
  geometry::HomogeneousPoints<Dim> points(Dim + 1, static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].values.size() != Dim + 1) {
      refuse_count(coordinates[i].where, coordinates[i].values.size(), Dim + 1);
    }
    for (int k = 0; k <= Dim; ++k) points(k, static_cast<Eigen::Index>(i)) = coordinates[i].values[std::size_t(k)];
  }
  return points;
}

template <int Dim>
geometry::HomogeneousPoints<Dim> control_points(const NurbsCurveKeys& keys) {
  if (!keys.homogeneous.empty()) return homogeneous_points<Dim>(keys.homogeneous);
  const Points<Dim> points = points_of<Dim>(keys.points);
  geometry::HomogeneousPoints<Dim> result(Dim + 1, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double weight = keys.weights.empty() ? 1.0 : keys.weights[std::size_t(i)];
    result.col(i).template head<Dim>() = weight * points.col(i);
    result(Dim, i) = weight;
  }
  return result;
}

/// One period's points, continued by the first `degree` of them.
template <int Dim>
NurbsCurve<Dim> periodic_curve(const NurbsCurveKeys& keys, const geometry::HomogeneousPoints<Dim>& points) {
  const KnotVector knots = KnotVector::periodic(keys.degree, keys.knots);
  if (knots.basis_count() != points.cols() + keys.degree) {
    throw GeometryError(fmt::format("periodic: {} breakpoints need {} control points, but there are {}",
                                    keys.knots.size(), knots.basis_count() - keys.degree, points.cols()));
  }
  geometry::HomogeneousPoints<Dim> continued(Dim + 1, knots.basis_count());
  for (Eigen::Index i = 0; i < continued.cols(); ++i) continued.col(i) = points.col(i % points.cols());
  return {knots, continued};
}

bool has_three_coordinates(const NurbsCurveKeys& keys) {
  return keys.homogeneous.empty() ? keys.points.front().values.size() == 3
                                  : keys.homogeneous.front().values.size() == 4;
}

std::vector<NurbsCurve<2>> curves_of(const geometry::Boundary<2>& boundary) {
  std::vector<NurbsCurve<2>> curves;
  for (const auto& patch : boundary.patches) curves.push_back(patch.shape);
  return curves;
}

struct PlaneCurveBuilder {
  using Curves = std::vector<NurbsCurve<2>>;

  Curves operator()(const LineKeys& keys) const {
    return {geometry::line_segment<2>(point_of<2>(keys.from), point_of<2>(keys.to))};
  }
  Curves operator()(const PolylineKeys& keys) const { return {geometry::polyline<2>(points_of<2>(keys.points))}; }
  Curves operator()(const ArcKeys& keys) const {
    return {geometry::circular_arc(keys.radius, keys.centre, radians(keys.angles(0)), radians(keys.angles(1)))};
  }
  Curves operator()(const EllipseArcKeys& keys) const {
    return {geometry::ellipse_arc(keys.radii, keys.centre, radians(keys.rotation), radians(keys.angles(0)),
                                  radians(keys.angles(1)))};
  }
  Curves operator()(const NurbsCurveKeys& keys) const { return {nurbs_curve<2>(keys)}; }
  Curves operator()(const CircleKeys& keys) const { return {geometry::circle_curve(keys.radius, keys.centre)}; }
  Curves operator()(const EllipseKeys& keys) const {
    return {geometry::ellipse_curve(keys.radii, keys.centre, radians(keys.rotation))};
  }
  Curves operator()(const RectangleKeys& keys) const { return curves_of(geometry::rectangle(keys.size, keys.corner)); }
  Curves operator()(const PolygonKeys& keys) const { return curves_of(geometry::polygon(points_of<2>(keys.points))); }
};

struct SpaceCurveBuilder {
  using Curves = std::vector<NurbsCurve<3>>;

  Curves operator()(const LineKeys& keys) const {
    if (keys.from.values.size() == 2) return embedded(keys);
    return {geometry::line_segment<3>(point_of<3>(keys.from), point_of<3>(keys.to))};
  }
  Curves operator()(const PolylineKeys& keys) const {
    if (keys.points.front().values.size() == 2) return embedded(keys);
    return {geometry::polyline<3>(points_of<3>(keys.points))};
  }
  Curves operator()(const NurbsCurveKeys& keys) const {
    if (!has_three_coordinates(keys)) return embedded(keys);
    return {nurbs_curve<3>(keys)};
  }
  template <class Keys>
  Curves operator()(const Keys& keys) const {
    return embedded(keys);
  }

 private:
  template <class Keys>
  static Curves embedded(const Keys& keys) {
    Curves curves;
    for (const NurbsCurve<2>& curve : PlaneCurveBuilder{}(keys)) curves.push_back(geometry::embed(curve));
    return curves;
  }
};

template <int Dim, class Builder>
std::vector<NurbsCurve<Dim>> transformed_curves(const CurveKeys& keys) {
  const ShapeKeys& common = common_keys(keys);
  return located(common.where, [&] {
    std::vector<NurbsCurve<Dim>> curves = std::visit(Builder{}, keys);
    if (common.transform.items.empty()) return curves;
    const AffineMap<Dim> map = affine_map<Dim>(common.transform);
    for (NurbsCurve<Dim>& curve : curves) curve = geometry::transform(curve, map);
    return curves;
  });
}

}  // namespace

template <int Dim>
Point<Dim> point_of(const Coordinates& coordinates) {
  if (coordinates.values.size() != Dim) refuse_count(coordinates.where, coordinates.values.size(), Dim);
  return Eigen::Map<const Point<Dim>>(coordinates.values.data());
}

template <int Dim>
Points<Dim> points_of(const std::vector<Coordinates>& coordinates) {
  Points<Dim> points(Dim, static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = point_of<Dim>(coordinates[i]);
  }
  return points;
}

template <int Dim>
AffineMap<Dim> affine_map(const OneOrMany<TransformKeys>& transforms) {
  AffineMap<Dim> map;
  for (const TransformKeys& keys : transforms.items) map = geometry::compose(transform_map<Dim>(keys), map);
  return map;
}

template <int Dim>
NurbsCurve<Dim> nurbs_curve(const NurbsCurveKeys& keys) {
  const geometry::HomogeneousPoints<Dim> points = control_points<Dim>(keys);
  if (keys.periodic) return periodic_curve<Dim>(keys, points);
  return NurbsCurve<Dim>(KnotVector(keys.degree, keys.knots), points);
}

std::vector<NurbsCurve<2>> plane_curves(const CurveKeys& keys) {
  return transformed_curves<2, PlaneCurveBuilder>(keys);
}

std::vector<NurbsCurve<3>> space_curves(const CurveKeys& keys) {
  return transformed_curves<3, SpaceCurveBuilder>(keys);
}

NurbsCurve<3> single_space_curve(const CurveKeys& keys) {
  const std::vector<NurbsCurve<3>> curves = space_curves(keys);
  if (curves.size() == 1) return curves.front();
  return located(common_keys(keys).where, [&] {
    // The sides of one polygon end exactly where the next ones begin.
    return geometry::join<3>(curves, 1e-12 * std::abs(curves.front().control_points().cwiseAbs().maxCoeff()) +
                                         std::numeric_limits<double>::min());
  });
}

template Point<2> point_of<2>(const Coordinates&);
template Point<3> point_of<3>(const Coordinates&);
template Points<2> points_of<2>(const std::vector<Coordinates>&);
template Points<3> points_of<3>(const std::vector<Coordinates>&);
template AffineMap<2> affine_map<2>(const OneOrMany<TransformKeys>&);
template AffineMap<3> affine_map<3>(const OneOrMany<TransformKeys>&);
template NurbsCurve<2> nurbs_curve<2>(const NurbsCurveKeys&);
template NurbsCurve<3> nurbs_curve<3>(const NurbsCurveKeys&);

}  // namespace isorim::io
