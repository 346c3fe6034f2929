#include "io/iges/nurbs_records.h"

#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io::iges {

using geometry::Direction;
using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

double cartesian_coordinate(double product, double weight) {
  const double quotient = product / weight;
  if (!std::isfinite(quotient)) {
    throw GeometryError(fmt::format("the control point {} / {} is too far away for a file", product, weight));
  }
  double best = quotient;
  // The quotient is rounded, so a neighbour may multiply back better.
  for (const double candidate : {std::nextafter(quotient, -std::numeric_limits<double>::infinity()),
                                 std::nextafter(quotient, std::numeric_limits<double>::infinity())}) {
    if (std::abs(weight * candidate - product) < std::abs(weight * best - product)) best = candidate;
  }
  return best;
}

namespace {

/// Two points that are closer than this, relative to the largest coordinate, count as one where flags are found.
constexpr double flag_tolerance = 1e-12;

void add_knots(Record& record, const KnotVector& knots) {
  for (const double knot : knots.knots()) record.real(knot);
}

template <int Dim>
void add_net(Record& record, const geometry::HomogeneousPoints<Dim>& net) {
  for (Eigen::Index i = 0; i < net.cols(); ++i) record.real(net(Dim, i));
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    for (int d = 0; d < Dim; ++d) record.real(cartesian_coordinate(net(d, i), net(Dim, i)));
    if (Dim == 2) record.real(0.0);
  }
}

void add_range(Record& record, const Interval& range) {
  record.real(range.first).real(range.last);
}

/// The unit normal of a plane that holds all points; of straight ones any that will do.
std::optional<Vector3> common_normal(const Points<3>& points) {
  const Point3 origin = points.col(0);
  const double tolerance = flag_tolerance * points.cwiseAbs().maxCoeff();
  Eigen::Index farthest = 0;
  const double length = (points.colwise() - origin).colwise().norm().maxCoeff(&farthest);
  if (!(length > tolerance)) return std::nullopt;
  const Vector3 along = (points.col(farthest) - origin) / length;
  Vector3 widest = Vector3::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector3 cross = along.cross(points.col(i) - origin);
    if (cross.norm() > widest.norm()) widest = cross;
  }
  if (widest.norm() <= tolerance) widest = along.unitOrthogonal();
  const Vector3 normal = widest.normalized();
  const double off_plane = (normal.transpose() * (points.colwise() - origin)).cwiseAbs().maxCoeff();
  if (off_plane > tolerance) return std::nullopt;
  return normal;
}

Vector3 unit_z() {
  return Vector3::UnitZ();
}
std::optional<Vector3> normal_of(const NurbsCurve<3>& curve) {
  return common_normal(curve.control_points());
}
std::optional<Vector3> normal_of(const NurbsCurve<2>& /*curve*/) {
  return unit_z();
}

template <int Dim>
bool is_closed(const NurbsCurve<Dim>& curve) {
  const Interval domain = curve.domain();
  const double size = curve.control_points().cwiseAbs().maxCoeff();
  return (evaluate(curve, domain.first) - evaluate(curve, domain.last)).norm() <= flag_tolerance * size;
}

/// Both sides that the direction leads from and to are the same curve, with the same weights up to a factor.
bool is_closed(const NurbsSurface<3>& surface, Direction direction) {
  const auto sides = boundary_curves(surface);
  const auto& from = direction == Direction::u ? sides[3] : sides[0];
  const auto& to = direction == Direction::u ? sides[1] : sides[2];
  const double size = surface.control_points().cwiseAbs().maxCoeff();
  const Eigen::VectorXd a = from.weights() / from.weights()(0);
  const Eigen::VectorXd b = to.weights() / to.weights()(0);
  return (a - b).cwiseAbs().maxCoeff() <= flag_tolerance * a.maxCoeff() &&
         (from.control_points() - to.control_points()).cwiseAbs().maxCoeff() <= flag_tolerance * size;
}

template <int Dim>
Record record_of(const NurbsCurve<Dim>& curve) {
  const KnotVector& knots = curve.knots();
  const std::optional<Vector3> normal = normal_of(curve);
  Record record = EntityList::parameters(126);
  record.integer(knots.basis_count() - 1).integer(knots.degree());
  record.integer(normal ? 1 : 0).integer(is_closed(curve) ? 1 : 0).integer(curve.is_polynomial() ? 1 : 0).integer(0);
  add_knots(record, knots);
  add_net<Dim>(record, curve.homogeneous());
  add_range(record, curve.domain());
  for (const double n : normal.value_or(Vector3::Zero())) record.real(n);
  return record;
}

}  // namespace

Record curve_record(const NurbsCurve<3>& curve) {
  return record_of(curve);
}

Record curve_record(const NurbsCurve<2>& curve) {
  return record_of(curve);
}

Record surface_record(const NurbsSurface<3>& surface) {
  Record record = EntityList::parameters(128);
  record.integer(surface.count_u() - 1).integer(surface.count_v() - 1);
  record.integer(surface.knots_u().degree()).integer(surface.knots_v().degree());
  record.integer(is_closed(surface, Direction::u) ? 1 : 0).integer(is_closed(surface, Direction::v) ? 1 : 0);
  record.integer(surface.is_polynomial() ? 1 : 0).integer(0).integer(0);
  add_knots(record, surface.knots_u());
  add_knots(record, surface.knots_v());
  add_net<3>(record, surface.homogeneous());
  add_range(record, surface.knots_u().domain());
  add_range(record, surface.knots_v().domain());
  return record;
}

}  // namespace isorim::io::iges
