#include "geometry/trimming/lifted_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct SurfaceTangents {
  Point3 point;
  Vector3 du;
  Vector3 dv;
};

SurfaceTangents surface_tangents(const NurbsSurface<3>& surface, const Point2& uv) {
  const LocalBasis<1> u = local_basis<1>(surface.knots_u(), uv[0]);
  const LocalBasis<1> v = local_basis<1>(surface.knots_v(), uv[1]);
  Eigen::Matrix<double, 4, 2> values = Eigen::Matrix<double, 4, 2>::Zero();
  Eigen::Vector4d across = Eigen::Vector4d::Zero();
  for (Eigen::Index j = 0; j < v.table.rows(); ++j) {
    const Eigen::Index first = u.first + (v.first + j) * surface.count_u();
    const Eigen::Matrix<double, 4, 2> row =
        surface.homogeneous().middleCols(first, u.table.rows()).lazyProduct(u.table);
    values += v.table(j, 0) * row;
    across += v.table(j, 1) * row.col(0);
  }
  SurfaceTangents result;
  const double weight = values(3, 0);
  result.point = values.col(0).head<3>() / weight;
  result.du = (values.col(1).head<3>() - values(3, 1) * result.point) / weight;
  result.dv = (across.head<3>() - across(3) * result.point) / weight;
  return result;
}

struct PlaneTangent {
  Point2 point;
  Vector2 derivative;
};

PlaneTangent plane_tangent(const NurbsCurve<2>& curve, double t) {
  const LocalBasis<1> basis = local_basis<1>(curve.knots(), t);
  const Eigen::Matrix<double, 3, 2> value =
      curve.homogeneous().middleCols(basis.first, basis.table.rows()).lazyProduct(basis.table);
  PlaneTangent result;
  result.point = value.col(0).head<2>() / value(2, 0);
  result.derivative = (value.col(1).head<2>() - value(2, 1) * result.point) / value(2, 0);
  return result;
}

/// (u, v) -> linear (u, v) + translation.
struct AffineSurface {
  Eigen::Matrix<double, 3, 2> linear;
  Point3 translation;
};

/// A polynomial surface is an affine image of its parameters exactly if its control points are the images of their
/// Greville abscissae.
std::optional<AffineSurface> as_affine(const NurbsSurface<3>& surface) {
  if (!surface.is_polynomial()) return std::nullopt;
  const std::vector<double> us = surface.knots_u().greville_abscissae();
  const std::vector<double> vs = surface.knots_v().greville_abscissae();
  const double weight = surface.homogeneous()(3, 0);
  const auto control_point = [&](std::size_t i, std::size_t j) -> Point3 {
    return surface.homogeneous().col(static_cast<Eigen::Index>(i + j * us.size())).head<3>() / weight;
  };
  AffineSurface map;
  const Point3 corner = control_point(0, 0);
  map.linear.col(0) = (control_point(us.size() - 1, 0) - corner) / (us.back() - us.front());
  map.linear.col(1) = (control_point(0, vs.size() - 1) - corner) / (vs.back() - vs.front());
  map.translation = corner - map.linear * Vector2(us.front(), vs.front());
  const double largest = surface.homogeneous().topRows<3>().cwiseAbs().maxCoeff() / weight +
                         map.linear.col(0).norm() * std::max(std::abs(us.front()), std::abs(us.back())) +
                         map.linear.col(1).norm() * std::max(std::abs(vs.front()), std::abs(vs.back()));
  for (std::size_t j = 0; j < vs.size(); ++j) {
    for (std::size_t i = 0; i < us.size(); ++i) {
      const Point3 image = map.linear * Vector2(us[i], vs[j]) + map.translation;
      if ((image - control_point(i, j)).cwiseAbs().maxCoeff() > 4.0 * epsilon * largest) return std::nullopt;
    }
  }
  return map;
}

/// The isoparametric curve between two parameters, run through as a pcurve over `domain` does.
NurbsCurve<3> isoparametric_segment(const NurbsSurface<3>& surface, Direction direction, double value, double from,
                                    double to, Interval domain) {
  NurbsCurve<3> curve = isoparametric_curve(surface, direction, value);
  const Interval whole = curve.domain();
  const Interval part{std::clamp(std::min(from, to), whole.first, whole.last),
                      std::clamp(std::max(from, to), whole.first, whole.last)};
  if (part.first != whole.first || part.last != whole.last) curve = restrict_to(curve, part);
  if (to < from) curve = reverse(curve);
  return reparametrise(curve, domain);
}

std::optional<NurbsCurve<3>> isoparametric_lift(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve) {
  if (pcurve.degree() != 1 || pcurve.homogeneous().cols() != 2 || !pcurve.is_polynomial()) return std::nullopt;
  const Interval domain = pcurve.domain();
  const Point2 from = evaluate(pcurve, domain.first);
  const Point2 to = evaluate(pcurve, domain.last);
  for (const Direction direction : {Direction::u, Direction::v}) {
    const int along = direction == Direction::u ? 0 : 1;
    const Interval range = surface.knots(direction).domain();
    // Beyond the domain the surface's end piece goes on, which the isoparametric curve cannot say.
    const bool inside = range.contains(from[along]) && range.contains(to[along]);
    if (from[1 - along] != to[1 - along] || from[along] == to[along] || !inside) continue;
    return isoparametric_segment(surface, direction, from[1 - along], from[along], to[along], domain);
  }
  return std::nullopt;
}

/// A cubic segment over an interval, by end points and derivatives.
struct HermiteSegment {
  Interval domain;
  std::array<Point3, 4> points;

  HermiteSegment(Interval interval, const LiftedJet& from, const LiftedJet& to) : domain(interval) {
    const double third = interval.length() / 3.0;
    points = {from.point, from.point + third * from.tangent, to.point - third * to.tangent, to.point};
  }
  Point3 at(double s) const {
    const double r = 1.0 - s;
    return r * r * r * points[0] + 3.0 * r * r * s * points[1] + 3.0 * r * s * s * points[2] + s * s * s * points[3];
  }
};

/// Hermite segments over one smooth piece of a pcurve.
void append_segments(const NurbsSurface<3>& surface, const NurbsCurve<2>& piece, double tolerance,
                     std::vector<HermiteSegment>& segments) {
  const double shortest = 1e-9 * piece.domain().length();
  std::vector<Interval> waiting{piece.domain()};
  while (!waiting.empty()) {
    const Interval part = waiting.back();
    waiting.pop_back();
    const HermiteSegment segment(part, lifted_jet(surface, piece, part.first), lifted_jet(surface, piece, part.last));
    double distance = 0.0;
    for (const double s : {0.25, 0.5, 0.75}) {
      const Point3 exact = lifted_point(surface, piece, part.first + s * part.length());
      distance = std::max(distance, (segment.at(s) - exact).norm());
    }
    if (distance <= 0.5 * tolerance || part.length() <= shortest) {
      segments.push_back(segment);
      continue;
    }
    waiting.push_back({part.middle(), part.last});
    waiting.push_back({part.first, part.middle()});
  }
}

NurbsCurve<3> joined(const std::vector<HermiteSegment>& segments) {
  std::vector<double> knots(4, segments.front().domain.first);
  Points<3> points(3, 3 * static_cast<Eigen::Index>(segments.size()) + 1);
  points.col(0) = segments.front().points[0];
  for (std::size_t i = 0; i < segments.size(); ++i) {
    knots.insert(knots.end(), 3, segments[i].domain.last);
    for (std::size_t k = 1; k < 4; ++k) points.col(static_cast<Eigen::Index>(3 * i + k)) = segments[i].points[k];
  }
  knots.push_back(segments.back().domain.last);
  return NurbsCurve<3>::from_points(KnotVector(3, std::move(knots)), points);
}

}  // namespace

Point3 lifted_point(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, double t) {
  return evaluate(surface, evaluate(pcurve, t));
}

LiftedJet lifted_jet(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, double t) {
  const PlaneTangent plane = plane_tangent(pcurve, t);
  const SurfaceTangents space = surface_tangents(surface, plane.point);
  return {plane.point, space.point, space.du * plane.derivative[0] + space.dv * plane.derivative[1],
          space.du.cross(space.dv)};
}

std::optional<NurbsCurve<3>> exact_lift(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve) {
  if (std::optional<NurbsCurve<3>> curve = isoparametric_lift(surface, pcurve)) return curve;
  const std::optional<AffineSurface> map = as_affine(surface);
  if (!map) return std::nullopt;
  const HomogeneousPoints<2>& net = pcurve.homogeneous();
  HomogeneousPoints<3> lifted(4, net.cols());
  lifted.topRows<3>() = map->linear * net.topRows<2>() + map->translation * net.row(2);
  lifted.row(3) = net.row(2);
  return NurbsCurve<3>(pcurve.knots(), std::move(lifted));
}

NurbsCurve<3> lift(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, double tolerance) {
  if (!(tolerance > 0.0))
    throw GeometryError(fmt::format("lifting a curve: the tolerance is {}; expected a positive one", tolerance));
  if (std::optional<NurbsCurve<3>> curve = exact_lift(surface, pcurve)) return *std::move(curve);
  std::vector<HermiteSegment> segments;
  for (const BezierSegment& part : bezier_segments({pcurve.knots(), pcurve.homogeneous()})) {
    const KnotVector knots = KnotVector::clamped(pcurve.degree(), std::array{part.domain.first, part.domain.last});
    append_segments(surface, NurbsCurve<2>(knots, part.coefficients), tolerance, segments);
  }
  return joined(segments);
}

}  // namespace isorim::geometry
