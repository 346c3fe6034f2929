#include "geometry/hull/hull_lines.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "geometry/boundary.h"

namespace isorim::geometry {
namespace {

Boundary<3> open_boundary(std::span<const NurbsSurface<3>> port) {
  Boundary<3> boundary;
  for (std::size_t k = 0; k < port.size(); ++k) boundary.patches.push_back({"port_" + std::to_string(k + 1), port[k]});
  return boundary;
}

HullLine cut(const PlaneCutter& cutter, double at, const PlaneFrame& frame, double fit_tolerance) {
  const PlaneSection section = cutter.section(frame);
  HullLine line{at, section.frame, section.chains, {}};
  for (const SectionLoop& loop : section.loops) line.curves.push_back(loop.curve);
  for (const SectionCurve& curve : section.touching) line.curves.push_back(curve);
  for (const SectionCurve& curve : line.curves)
    line.splines.push_back(fit_section(curve, {.tolerance = fit_tolerance * cutter.size()}));
  return line;
}

PlaneFrame frame_of(const Point3& origin, const Vector3& axis_x, const Vector3& axis_y, const Vector3& normal) {
  return {origin, axis_x, axis_y, normal};
}

}  // namespace

HullLines hull_lines(std::span<const NurbsSurface<3>> port, const LinePlanes& planes, double fit_tolerance) {
  const PlaneCutter cutter(open_boundary(port));
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  const Vector3 z = Vector3::UnitZ();
  HullLines lines;
  for (const double at : planes.stations)
    lines.stations.push_back(cut(cutter, at, frame_of(Point3(at, 0.0, 0.0), y, z, x), fit_tolerance));
  for (const double at : planes.waterlines)
    lines.waterlines.push_back(cut(cutter, at, frame_of(Point3(0.0, 0.0, at), x, y, z), fit_tolerance));
  for (const double at : planes.buttocks)
    lines.buttocks.push_back(cut(cutter, at, frame_of(Point3(0.0, at, 0.0), x, z, -y), fit_tolerance));
  for (const DiagonalPlane& plane : planes.diagonals) {
    const Vector3 down(0.0, std::cos(plane.angle), -std::sin(plane.angle));
    const Vector3 normal(0.0, std::sin(plane.angle), std::cos(plane.angle));
    lines.diagonals.push_back(
        cut(cutter, plane.height, frame_of(Point3(0.0, 0.0, plane.height), x, down, normal), fit_tolerance));
  }
  return lines;
}

}  // namespace isorim::geometry
