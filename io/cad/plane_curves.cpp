#include "io/cad/plane_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

using geometry::HomogeneousPoints;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point3;
using geometry::Points;
using geometry::SurfaceShape;
using geometry::Vector3;

const HomogeneousPoints<3>& net_of(const NurbsCurve<3>& curve) {
  return curve.homogeneous();
}
const HomogeneousPoints<3>& net_of(const geometry::Patch<3>& patch) {
  const auto* extracted = std::get_if<geometry::ExtractedSurface>(&patch.shape);
  return extracted ? extracted->homogeneous() : geometry::surface_of(patch.shape).homogeneous();
}

/// Of curves, or of the surfaces of patches.
template <class Range>
Points<3> all_control_points(const Range& shapes) {
  Eigen::Index count = 0;
  for (const auto& shape : shapes) count += net_of(shape).cols();
  Points<3> points(3, count);
  Eigen::Index column = 0;
  for (const auto& shape : shapes) {
    const HomogeneousPoints<3>& net = net_of(shape);
    points.middleCols(column, net.cols()) = net.topRows<3>().array().rowwise() / net.row(3).array();
    column += net.cols();
  }
  return points;
}

double diagonal(const Points<3>& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// A normal of the plane through the point, the one farthest from it, and the one farthest from the line of both.
Vector3 normal_of(const Points<3>& points) {
  const Point3 first = points.col(0);
  Eigen::Index second = 0;
  (points.colwise() - first).colwise().squaredNorm().maxCoeff(&second);
  const Vector3 along = points.col(second) - first;
  Vector3 normal = Vector3::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector3 candidate = along.cross(points.col(i) - first);
    if (candidate.squaredNorm() > normal.squaredNorm()) normal = candidate;
  }
  if (!(normal.norm() > 1e-12 * along.squaredNorm())) {
    throw GeometryError("the curves lie on one straight line; expected curves round an area");
  }
  return normal.normalized();
}

DrawingPlane plane_with_normal(const Vector3& normal, const Point3& point) {
  DrawingPlane plane;
  plane.x_axis = Vector3::UnitZ().cross(normal).normalized();
  Eigen::Index largest = 0;
  plane.x_axis.cwiseAbs().maxCoeff(&largest);
  if (plane.x_axis(largest) < 0.0) plane.x_axis = -plane.x_axis;
  plane.y_axis = normal.cross(plane.x_axis).normalized();
  if (plane.y_axis.z() < 0.0) plane.y_axis = -plane.y_axis;
  plane.origin = point.dot(normal) * normal;
  return plane;
}

/// The plane z = const if the points lie in one to the tolerance, else that through three of them.
DrawingPlane plane_of(const Points<3>& points, double tolerance) {
  DrawingPlane plane;
  const double size = diagonal(points);
  const double lowest = points.row(2).minCoeff();
  const double highest = points.row(2).maxCoeff();
  if (highest - lowest <= tolerance * size) {
    plane.origin.z() = 0.5 * (lowest + highest);
    plane.deviation = 0.5 * (highest - lowest);
  } else {
    const Vector3 normal = normal_of(points);
    plane = plane_with_normal(normal, points.col(0));
    plane.deviation = (normal.transpose() * (points.colwise() - plane.origin)).cwiseAbs().maxCoeff();
  }
  plane.size = size;
  return plane;
}

/// How far the control points lie from the affine map of the parameters that fits three corners.
struct AffineFit {
  Point3 origin;
  Vector3 along_u;
  Vector3 along_v;
  double deviation = 0.0;
  double size = 0.0;

  explicit AffineFit(const NurbsSurface<3>& surface) {
    const Points<3> net = surface.control_points();
    // Where linear functions have their control values.
    const std::vector<double> u = surface.knots_u().greville_abscissae();
    const std::vector<double> v = surface.knots_v().greville_abscissae();
    const auto nu = static_cast<Eigen::Index>(u.size());
    const auto last = static_cast<Eigen::Index>(net.cols()) - nu;
    along_u = (net.col(nu - 1) - net.col(0)) / (u.back() - u.front());
    along_v = (net.col(last) - net.col(0)) / (v.back() - v.front());
    origin = net.col(0) - u.front() * along_u - v.front() * along_v;
    size = diagonal(net);
    for (Eigen::Index i = 0; i < net.cols(); ++i) {
      const Point3 fitted =
          origin + u[static_cast<std::size_t>(i % nu)] * along_u + v[static_cast<std::size_t>(i / nu)] * along_v;
      deviation = std::max(deviation, (net.col(i) - fitted).norm());
    }
  }

  NurbsCurve<3> image(const NurbsCurve<2>& pcurve) const {
    const HomogeneousPoints<2>& net = pcurve.homogeneous();
    HomogeneousPoints<3> mapped(4, net.cols());
    mapped.topRows<3>() = along_u * net.row(0) + along_v * net.row(1) + origin * net.row(2);
    mapped.row(3) = net.row(2);
    return {pcurve.knots(), mapped};
  }
};

}  // namespace

DrawingPlane drawing_plane(std::span<const NurbsCurve<3>> curves, double tolerance) {
  const DrawingPlane plane = plane_of(all_control_points(curves), tolerance);
  if (plane.deviation <= tolerance * plane.size) return plane;
  throw GeometryError(
      fmt::format("the curves lie in no plane: one leaves that of the others by {:.3g}; expected at "
                  "most {:.3g}",
                  plane.deviation, tolerance * plane.size));
}

bool is_flat(const geometry::Boundary<3>& boundary, double tolerance) {
  if (boundary.patches.empty()) return false;
  const DrawingPlane plane = plane_of(all_control_points(boundary.patches), tolerance);
  return plane.deviation <= tolerance * plane.size;
}

NurbsCurve<2> project(const NurbsCurve<3>& curve, const DrawingPlane& plane) {
  const HomogeneousPoints<3>& net = curve.homogeneous();
  HomogeneousPoints<2> projected(3, net.cols());
  projected.row(2) = net.row(3);
  if (plane.x_axis == Vector3::UnitX() && plane.y_axis == Vector3::UnitY()) {
    projected.topRows<2>() = net.topRows<2>();
  } else {
    const Points<3> offsets = net.topRows<3>() - plane.origin * net.row(3);
    projected.row(0) = plane.x_axis.transpose() * offsets;
    projected.row(1) = plane.y_axis.transpose() * offsets;
  }
  return {curve.knots(), projected};
}

std::vector<NurbsCurve<3>> flat_face_edges(const SurfaceShape& face) {
  const NurbsSurface<3>& surface = geometry::surface_of(face);
  const AffineFit fit(surface);
  if (!surface.is_polynomial() || fit.deviation > 1e-12 * fit.size) {
    throw GeometryError(
        fmt::format("its surface is {}; expected a plane whose points are linear in the parameters",
                    surface.is_polynomial() ? fmt::format("{:.3g} off one", fit.deviation) : std::string("rational")));
  }
  std::vector<NurbsCurve<3>> edges;
  for (const geometry::TrimLoop& loop : geometry::trim_loops(face)) {
    for (const NurbsCurve<2>& pcurve : loop.curves) {
      NurbsCurve<3> edge = fit.image(pcurve);
      if (diagonal(edge.control_points()) > 1e-12 * fit.size) edges.push_back(std::move(edge));
    }
  }
  return edges;
}

}  // namespace isorim::io
