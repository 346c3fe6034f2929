#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/surface.h"
#include "geometry/shapes/sweeps.h"

/// The Wigley hull y = (B/2) (1 - (2x/L)^2) (1 - (z/T)^2), -T <= z <= 0, as one biquadratic element a side and a deck
/// in z = 0 between two parabolas.
namespace isorim::solver::testing {

struct Wigley {
  double length = 10.0;
  double beam = 1.0;
  double draught = 0.625;
};

inline geometry::NurbsSurface<3> wigley_side(const Wigley& hull, double side) {
  // Bernstein coefficients of 1 - xi^2 on [-1, 1] and of 1 - zeta^2 on [-1, 0].
  const double along[3] = {0.0, 2.0, 0.0};
  const double upwards[3] = {0.0, 1.0, 1.0};
  geometry::Points<3> net(3, 9);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      net.col(i + 3 * j) << 0.5 * hull.length * (i - 1), side * 0.5 * hull.beam * along[i] * upwards[j],
          hull.draught * (0.5 * j - 1.0);
  return geometry::NurbsSurface<3>::from_points(geometry::KnotVector::bezier(2), geometry::KnotVector::bezier(2), net);
}

/// Outward normals: on the port side S_u x S_v points to starboard.
inline geometry::Boundary<3> wigley_hull(const Wigley& hull = {}) {
  geometry::Points<3> deck(3, 6);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i)
      deck.col(i + 3 * j) << 0.5 * hull.length * (i - 1), (i == 1 ? 2.0 * j - 1.0 : 0.0) * hull.beam, 0.0;
  const auto deck_surface =
      geometry::NurbsSurface<3>::from_points(geometry::KnotVector::bezier(2), geometry::KnotVector::bezier(1), deck);
  geometry::Boundary<3> boundary;
  boundary.patches.push_back({"port", wigley_side(hull, 1.0), -1});
  boundary.patches.push_back({"starboard", wigley_side(hull, -1.0), 1});
  boundary.patches.push_back({"deck", deck_surface, 1});
  return boundary;
}

}  // namespace isorim::solver::testing
