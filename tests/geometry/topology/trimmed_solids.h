#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/bezier/element_table.h"
#include "geometry/boundary.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/trimming/faces.h"

/// Solids bounded by trimmed faces, and what files do to them: surfaces turned round, loops started and cut elsewhere.
namespace isorim::geometry::testing {

/// corner + u a + v b over the unit square.
inline NurbsSurface<3> plane_through(const Point3& corner, const Vector3& a, const Vector3& b) {
  Points<3> points(3, 4);
  points << corner, corner + a, corner + b, corner + a + b;
  return NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), points);
}

inline TrimLoop unit_square() {
  return polygon({Point2(0, 0), Point2(1, 0), Point2(1, 1), Point2(0, 1)});
}

/// [-1, 1] x [-1, 1] x [0, 1] with a hole of radius 0.5 along z; volume 4 - pi / 4. Seven patches, two trimmed.
inline Boundary<3> holed_box(double first_angle = 0.0) {
  Boundary<3> solid = box(Vector3(2, 2, 1), Point3(-1, -1, 0));
  const NurbsCurve<2> rim =
      transform(circle_curve(0.25, Point2(0, 0)),
                AffineMap<2>{Eigen::Rotation2Dd(first_angle).toRotationMatrix(), Point2(0.5, 0.5)});
  for (Patch<3>& patch : solid.patches) {
    const NurbsSurface<3>& surface = surface_of(patch.shape);
    const Vector3 normal = evaluate_jet(surface, Point2(0.5, 0.5)).du.cross(evaluate_jet(surface, Point2(0.5, 0.5)).dv);
    if (std::abs(normal.normalized().z()) < 0.5) continue;
    patch.shape = TrimmedSurface(surface, {unit_square(), TrimLoop{{reverse(rim)}}});
  }
  Boundary<3> pipe = cylinder(0.5, 1.0);
  for (Patch<3>& patch : pipe.patches) {
    if (surface_of(patch.shape).is_polynomial()) continue;
    const NurbsSurface<3>& surface = surface_of(patch.shape);
    const Vector3 across = evaluate(surface, Point2(0, 0)) - evaluate(surface, Point2(0, 1));
    if (std::abs(across.z()) > 0.5) solid.patches.push_back({"hole", surface, -patch.orientation});
  }
  return solid;
}

inline NurbsCurve<2> mapped(const NurbsCurve<2>& pcurve, const AffineMap<2>& map) {
  return transform(pcurve, map);
}

/// The same face on a surface with one parameter reversed, or both swapped.
inline SurfaceShape reversed_face(const SurfaceShape& shape, Direction direction) {
  const NurbsSurface<3> surface = reverse(surface_of(shape), direction);
  if (std::holds_alternative<NurbsSurface<3>>(shape)) return surface;
  const int axis = direction == Direction::u ? 0 : 1;
  const Interval domain = surface.knots(direction).domain();
  AffineMap<2> mirror;
  mirror.linear(axis, axis) = -1.0;
  mirror.translation(axis) = domain.first + domain.last;
  std::vector<TrimLoop> loops;
  for (const TrimLoop& loop : std::get<TrimmedSurface>(shape).loops()) {
    TrimLoop turned = reversed(loop);
    for (NurbsCurve<2>& pcurve : turned.curves) pcurve = mapped(pcurve, mirror);
    loops.push_back(turned);
  }
  return TrimmedSurface(surface, loops);
}

inline SurfaceShape swapped_face(const SurfaceShape& shape) {
  const NurbsSurface<3> surface = swap_directions(surface_of(shape));
  if (std::holds_alternative<NurbsSurface<3>>(shape)) return surface;
  AffineMap<2> swap;
  swap.linear << 0, 1, 1, 0;
  std::vector<TrimLoop> loops;
  for (const TrimLoop& loop : std::get<TrimmedSurface>(shape).loops()) {
    TrimLoop turned = reversed(loop);
    for (NurbsCurve<2>& pcurve : turned.curves) pcurve = mapped(pcurve, swap);
    loops.push_back(turned);
  }
  return TrimmedSurface(surface, loops);
}

/// Cuts the curves of the loops at random places, and starts the loops elsewhere.
inline SurfaceShape recut_loops(const SurfaceShape& shape, std::mt19937& random) {
  std::vector<TrimLoop> loops = trim_loops(shape);
  std::uniform_real_distribution<double> fraction(0.1, 0.9);
  for (TrimLoop& loop : loops) {
    TrimLoop cut;
    for (const NurbsCurve<2>& pcurve : loop.curves) {
      if (random() % 2 == 0) {
        cut.curves.push_back(pcurve);
        continue;
      }
      const Interval domain = pcurve.domain();
      const auto [first, second] = split(pcurve, domain.first + fraction(random) * domain.length());
      cut.curves.push_back(first);
      cut.curves.push_back(second);
    }
    std::ranges::rotate(cut.curves, cut.curves.begin() + static_cast<std::ptrdiff_t>(random() % cut.curves.size()));
    loop = cut;
  }
  return TrimmedSurface(surface_of(shape), loops);
}

/// Patches in another order, surfaces and orientations turned at random, loops cut anew.
inline Boundary<3> as_from_a_file(Boundary<3> boundary, std::mt19937& random) {
  std::ranges::shuffle(boundary.patches, random);
  for (Patch<3>& patch : boundary.patches) {
    if (random() % 2 == 0) patch.shape = reversed_face(patch.shape, Direction::u);
    if (random() % 2 == 0) patch.shape = reversed_face(patch.shape, Direction::v);
    if (random() % 2 == 0) patch.shape = swapped_face(patch.shape);
    if (random() % 2 == 0) patch.shape = recut_loops(patch.shape, random);
    patch.orientation = random() % 2 == 0 ? 1 : -1;
  }
  return boundary;
}

/// Every patch moved and turned a little about its own place: no point by more than `distance`.
inline Boundary<3> shaken(Boundary<3> boundary, double distance, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (Patch<3>& patch : boundary.patches) {
    const Points<3> points = surface_of(patch.shape).control_points();
    const Point3 middle = points.rowwise().mean();
    const double radius = (points.colwise() - middle).colwise().norm().maxCoeff();
    const Vector3 axis = Vector3(unit(random), unit(random), unit(random)).normalized();
    const Vector3 shift = 0.5 * distance * Vector3(unit(random), unit(random), unit(random)).normalized();
    AffineMap<3> map;
    map.linear = Eigen::AngleAxisd(0.5 * distance / radius, axis).toRotationMatrix();
    map.translation = middle - map.linear * middle + shift;
    patch.shape = transform(patch.shape, map);
  }
  return boundary;
}

/// Area and volume, cut elements by radial integration from the corner of their cells.
inline Measures trimmed_measures(const Boundary<3>& boundary, int n = 16) {
  const GaussRule rule = gauss_rule(n);
  const ElementTable<3> table = bezier_elements(boundary);
  Measures sum;
  for (const BezierElement<3>& element : table.elements) {
    const NurbsSurface<3> net(KnotVector::bezier(element.degree[0]), KnotVector::bezier(element.degree[1]),
                              table.net_matrix(element));
    const auto add = [&](const Point2& place, double weight) {
      const SurfaceJet<3> jet = evaluate_jet(net, place);
      const Vector3 normal = element.orientation * jet.du.cross(jet.dv);
      sum.boundary += weight * normal.norm();
      sum.content += weight * jet.point.dot(normal) / 3.0;
    };
    if (!element.is_cut()) {
      for (int k = 0; k < n; ++k) {
        for (int l = 0; l < n; ++l) add(Point2(rule.nodes[k], rule.nodes[l]), rule.weights[k] * rule.weights[l]);
      }
      continue;
    }
    for (const HomogeneousPoints<2>& piece : table.regions[static_cast<std::size_t>(element.region)].curves) {
      const NurbsCurve<2> curve(KnotVector::bezier(static_cast<int>(piece.cols()) - 1), piece);
      for (int k = 0; k < n; ++k) {
        const CurveJet<2> jet = evaluate_jet(curve, rule.nodes[k]);
        const double swept = jet.point.x() * jet.du.y() - jet.point.y() * jet.du.x();
        for (int l = 0; l < n; ++l)
          add(rule.nodes[l] * jet.point, rule.weights[k] * rule.weights[l] * rule.nodes[l] * swept);
      }
    }
  }
  return sum;
}

}  // namespace isorim::geometry::testing
