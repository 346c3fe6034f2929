#include "geometry/hull/fairness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/hull/hull_lines.h"

namespace isorim::geometry {
namespace {

constexpr std::array<double, 5> gauss_points{-0.906179845938664, -0.5384693101056831, 0.0, 0.5384693101056831,
                                             0.906179845938664};
constexpr std::array<double, 5> gauss_weights{0.23692688505618908, 0.47862867049936647, 0.5688888888888889,
                                              0.47862867049936647, 0.23692688505618908};
/// Samples of a line between two of its own.
constexpr int samples = 400;

/// k1^2 + k2^2 times the area element: (k1 + k2)^2 - 2 k1 k2 from the fundamental forms.
double bending_density(const SurfaceJet<3>& jet) {
  const Vector3 normal = jet.du.cross(jet.dv);
  const double area = normal.norm();
  if (!(area > 1e-9 * jet.du.norm() * jet.dv.norm())) return 0.0;
  const Vector3 n = normal / area;
  const double e = jet.du.dot(jet.du);
  const double f = jet.du.dot(jet.dv);
  const double g = jet.dv.dot(jet.dv);
  const double l = jet.duu.dot(n);
  const double m = jet.duv.dot(n);
  const double k = jet.dvv.dot(n);
  const double determinant = area * area;
  const double sum = (e * k - 2.0 * f * m + g * l) / determinant;
  const double product = (l * k - m * m) / determinant;
  return (sum * sum - 2.0 * product) * area;
}

double bending_energy(const NurbsSurface<3>& surface) {
  const std::vector<double> us = surface.knots_u().breakpoints();
  const std::vector<double> vs = surface.knots_v().breakpoints();
  double energy = 0.0;
  for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      const double half_u = 0.5 * (us[i + 1] - us[i]);
      const double half_v = 0.5 * (vs[j + 1] - vs[j]);
      for (std::size_t b = 0; b < gauss_points.size(); ++b) {
        for (std::size_t a = 0; a < gauss_points.size(); ++a) {
          const Point2 uv(us[i] + half_u * (1.0 + gauss_points[a]), vs[j] + half_v * (1.0 + gauss_points[b]));
          energy += half_u * half_v * gauss_weights[a] * gauss_weights[b] * bending_density(evaluate_jet(surface, uv));
        }
      }
    }
  }
  return energy;
}

/// Of the plane curve's curvature, sampled; what is below `least` has no sign.
int sign_changes(const NurbsCurve<2>& curve, double least) {
  const Interval domain = curve.knots().domain();
  int changes = 0;
  int last = 0;
  for (int k = 0; k <= samples; ++k) {
    const CurveJet<2> jet = evaluate_jet(curve, domain.first + domain.length() * k / samples);
    const double speed = jet.du.norm();
    if (!(speed > 0.0)) continue;
    const double curvature = (jet.du.x() * jet.duu.y() - jet.du.y() * jet.duu.x()) / (speed * speed * speed);
    if (std::abs(curvature) <= least) continue;
    const int sign = curvature > 0.0 ? 1 : -1;
    if (last != 0 && sign != last) ++changes;
    last = sign;
  }
  return changes;
}

int sign_changes(const std::vector<HullLine>& lines, double least) {
  int changes = 0;
  for (const HullLine& line : lines) {
    for (const SectionSpline& spline : line.splines) changes += sign_changes(spline.curve, least);
  }
  return changes;
}

}  // namespace

HullFairness measure_fairness(const OffsetTable& table, std::span<const NurbsSurface<3>> bands) {
  HullFairness fairness;
  for (const NurbsSurface<3>& band : bands) fairness.bending_energy += bending_energy(band);
  LinePlanes planes;
  planes.stations = table.stations;
  planes.waterlines = table.waterlines;
  const HullLines lines = hull_lines(bands, planes);
  fairness.station_sign_changes = sign_changes(lines.stations, 2e-6 / table.beam);
  fairness.waterline_sign_changes = sign_changes(lines.waterlines, 1e-6 / table.length);
  return fairness;
}

double largest_offset_distance(std::span<const HullSection> sections, std::span<const NurbsSurface<3>> bands) {
  double largest = 0.0;
  for (const HullSection& section : sections) {
    for (Eigen::Index i = 0; i < section.points.cols(); ++i) {
      double nearest = std::numeric_limits<double>::max();
      for (const NurbsSurface<3>& band : bands)
        nearest = std::min(nearest, closest_point<3>(band, section.points.col(i)).distance);
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

}  // namespace isorim::geometry
