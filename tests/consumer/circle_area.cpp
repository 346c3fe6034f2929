// The area of a circle, by the installed libraries.

#include <cmath>
#include <cstdio>
#include <numbers>

#include "geometry/bezier/element_table.h"
#include "geometry/boundary.h"
#include "geometry/shapes/curves.h"
#include "solver/properties.h"

int main() {
  const double radius = 2.5;
  isorim::geometry::Boundary<2> boundary;
  boundary.patches.push_back({.name = "circle", .shape = isorim::geometry::circle_curve(radius)});

  const auto properties = isorim::solver::geometric_properties(isorim::geometry::bezier_elements(boundary));
  const isorim::quadrature::Estimate area = properties.domain.value().measure;
  const double exact = std::numbers::pi * radius * radius;
  std::printf("area %.17g (estimated error %.1e), pi r^2 %.17g\n", area.value, area.error, exact);
  return std::abs(area.value - exact) <= 1e-13 * exact ? 0 : 1;
}
