#include "solver/hydrostatics/hydrostatics.h"

#include <cmath>
#include <limits>

namespace isorim::solver {
namespace {

using geometry::Point3;
using geometry::Vector3;
using quadrature::Estimate;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Estimate quotient(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  return {value, (a.error + std::abs(value) * b.error) / std::abs(b.value) + epsilon * std::abs(value)};
}

Estimate quotient(const Estimate& a, double b) {
  return quotient(a, Estimate{b, 0.0});
}

Estimate sum(const Estimate& a, const Estimate& b) {
  return {a.value + b.value, a.error + b.error};
}

void set_centres(const ShipFrame& frame, Hydrostatics& result) {
  const ImmersedBody& body = result.immersed;
  const Point3& centre = body.centre_of_buoyancy;
  result.lcb = {centre.x(), body.centre_error.x()};
  result.tcb = {centre.y(), body.centre_error.y()};
  result.vcb = {centre.z() - frame.baseline, body.centre_error.z() + epsilon * std::abs(frame.baseline)};
  const WaterplaneProperties& plane = body.waterplane;
  const auto error_along = [&](int axis) {
    return std::abs(body.axes.forward[axis]) * plane.centroid_error[0] +
           std::abs(body.axes.port[axis]) * plane.centroid_error[1];
  };
  result.lcf = {plane.centroid.x(), error_along(0)};
  result.tcf = {plane.centroid.y(), error_along(1)};
}

void set_metacentres(const ShipFrame& frame, Hydrostatics& result) {
  const ImmersedBody& body = result.immersed;
  const WaterplaneProperties& plane = body.waterplane;
  result.it = {plane.second_moments(1, 1), plane.second_moments_error(1, 1)};
  result.il = {plane.second_moments(0, 0), plane.second_moments_error(0, 0)};
  result.itl = {plane.second_moments(0, 1), plane.second_moments_error(0, 1)};
  if (!(body.volume.value > 0.0)) return;
  result.bmt = quotient(result.it, body.volume);
  result.bml = quotient(result.il, body.volume);
  const Point3 keel(frame.origin.x(), frame.origin.y(), frame.baseline);
  const Vector3& up = body.axes.up;
  const Estimate kb{up.dot(body.centre_of_buoyancy - keel), up.cwiseAbs().dot(body.centre_error)};
  result.kmt = sum(kb, result.bmt);
  result.kml = sum(kb, result.bml);
}

void set_extents(const FloatingBody& body, const WettedPart& part, const HydrostaticOptions& options,
                 Hydrostatics& result) {
  const auto extent = [&](const Vector3& axis) {
    return farthest(body, part.waterline, axis) + farthest(body, part.waterline, -axis);
  };
  if (result.immersed.waterplane.area.value > 0.0 && !part.waterline.empty()) {
    result.waterline_length = extent(Vector3::UnitX());
    result.waterline_beam = extent(Vector3::UnitY());
  }
  result.length = options.length ? options.length : result.waterline_length;
  result.beam = options.beam ? options.beam : result.waterline_beam;
}

void set_coefficients(Hydrostatics& result) {
  const double draught = result.attitude.draught;
  const Estimate& volume = result.immersed.volume;
  if (!result.length || !result.beam) return;
  const double area = *result.length * *result.beam;
  if (area > 0.0) result.cwp = quotient(result.immersed.waterplane.area, area);
  if (!(area > 0.0) || !(draught > 0.0) || !std::isfinite(draught)) return;
  result.cb = quotient(volume, area * draught);
  result.cm = quotient(result.midship_area, *result.beam * draught);
  if (result.midship_area.value > result.midship_area.error)
    result.cp =
        quotient(volume, {*result.length * result.midship_area.value, *result.length * result.midship_area.error});
}

}  // namespace

ShipFrame default_frame(const FloatingBody& body) {
  return {body.lowest(Vector3::UnitZ()), body.box().middle().head<2>()};
}

Vector3 up_direction(double trim, double heel) {
  return {std::sin(trim), std::cos(trim) * std::sin(heel), std::cos(trim) * std::cos(heel)};
}

WaterPlane water_plane(const ShipFrame& frame, const Attitude& attitude) {
  const Vector3 up = up_direction(attitude.trim, attitude.heel);
  return {up, up.dot(Point3(frame.origin.x(), frame.origin.y(), frame.baseline + attitude.draught))};
}

Attitude attitude_of(const ShipFrame& frame, const WaterPlane& plane) {
  const Vector3& up = plane.up;
  const double rest = plane.offset - up.x() * frame.origin.x() - up.y() * frame.origin.y();
  return {rest / up.z() - frame.baseline, std::atan2(up.x(), std::hypot(up.y(), up.z())), std::atan2(up.y(), up.z())};
}

Hydrostatics hydrostatics(const FloatingBody& body, const StationSection& midship, const ShipFrame& frame,
                          const Attitude& attitude, const HydrostaticOptions& options) {
  const WaterPlane plane = water_plane(frame, attitude);
  const WettedPart part = body.wetted(plane, WettedScope::moments_and_area, FloatingBody::Waterline::collect);
  Hydrostatics result;
  result.attitude = attitude;
  result.immersed = immersed_body(body, plane, part);
  const int area = WettedLayout::area;
  result.wetted_surface = {part.sums.value[area], part.sums.error[area] + 4.0 * epsilon * part.sums.magnitude[area]};
  set_centres(frame, result);
  set_metacentres(frame, result);
  set_extents(body, part, options, result);
  result.midship_area = immersed_section(midship, plane).area;
  set_coefficients(result);
  result.cut_elements = part.cut_elements;
  result.immersed_elements = part.immersed_elements;
  result.unfinished = part.sums.unfinished;
  return result;
}

}  // namespace isorim::solver
