#include "geometry/propeller/mould_lines.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/nurbs/surface.h"
#include "geometry/propeller/propeller.h"
#include "geometry/propeller/series.h"

namespace isorim::geometry {
namespace {

/// The reference screw: Ka 4-60, P/D 0.9, 500 mm.
SeriesBlade reference_blade() {
  SeriesBlade blade;
  blade.diameter = 500.0;
  blade.pitch_ratio = RadialLaw(0.9);
  return blade;
}

/// The first blade's patches, outside a hub of 50 mm.
Boundary<3> blade_on_hub() {
  Propeller screw;
  screw.sections = series_sections(reference_blade());
  screw.hub = Hub{50.0};
  Boundary<3> boundary = propeller(screw);
  std::erase_if(boundary.patches, [](const auto& patch) { return !patch.name.starts_with("blade_1"); });
  return boundary;
}

PlaneSection section_at(const Boundary<3>& boundary, double height) {
  return plane_section(boundary, plane_frame(Point3(0.0, 0.0, height), Vector3::UnitZ()));
}

/// Where the curve u = constant crosses the plane, by bisection of v.
Point2 crossing(const NurbsSurface<3>& surface, double u, double height) {
  Interval v = surface.knots_v().domain();
  for (int k = 0; k < 80; ++k) (evaluate(surface, {u, v.middle()}).z() < height ? v.first : v.last) = v.middle();
  return evaluate(surface, {u, v.middle()}).head<2>();
}

TEST(MouldLines, HalfWidthsOfHubsArePythagoras) {
  EXPECT_DOUBLE_EQ(*hub_half_width(50.0, 40.0), 30.0);
  EXPECT_DOUBLE_EQ(*hub_half_width(50.0, -30.0), 40.0);
  EXPECT_FALSE(hub_half_width(50.0, 50.0));
  EXPECT_FALSE(hub_half_width(50.0, 60.0));
}

TEST(MouldLines, PartingLinesRunFromTheTrailingToTheLeadingEdge) {
  const Boundary<3> boundary = blade_on_hub();
  const NurbsSurface<3>& surface = surface_of(boundary.patches.at(0).shape);
  const Interval u = surface.knots_u().domain();
  for (const double height : {60.0, 100.0, 150.0, 200.0, 230.0}) {
    const auto line = parting_line(section_at(boundary, height), boundary, 0, 1e-4);
    ASSERT_TRUE(line) << height;
    EXPECT_LT((line->from - crossing(surface, u.first, height)).norm(), 1e-6) << height;
    // The farthest of many curves u = constant, in the thesis's range.
    double farthest = 0.0;
    for (int k = 1; k < 6000; ++k) {
      const double part = 0.2 + 0.6 * k / 6000.0;
      farthest = std::max(farthest, crossing(surface, u.first + part * u.length(), height).norm());
    }
    EXPECT_NEAR(line->to.norm(), farthest, 1e-3) << height;
  }
}

TEST(MouldLines, SectionsBeyondTheEdgesHaveTheirEndsInTheirPlace) {
  // Above 237.3 mm the planes leave the blade through its tip before they reach its edges.
  const Boundary<3> boundary = blade_on_hub();
  const PlaneSection section = section_at(boundary, 245.0);
  const auto line = parting_line(section, boundary, 0, 1e-3);
  ASSERT_TRUE(line);
  const double half_width = std::sqrt(250.0 * 250.0 - 245.0 * 245.0);
  EXPECT_NEAR(std::abs(line->from.y()), half_width, 0.2);
  EXPECT_NEAR(std::abs(line->to.y()), half_width, 0.2);
  EXPECT_LT(line->from.y() * line->to.y(), 0.0);
}

TEST(MouldLines, RootsEndWhereTheSurfaceMeetsTheHub) {
  const Boundary<3> boundary = blade_on_hub();
  const auto extent = root_extent(boundary.patches.at(0).shape, 50.0);
  ASSERT_TRUE(extent);
  // The surface's own points on the cylinder, by bisection along v.
  const NurbsSurface<3>& surface = surface_of(boundary.patches.at(0).shape);
  const Interval u = surface.knots_u().domain();
  double least = 1e9;
  double greatest = -1e9;
  for (int k = 0; k <= 20000; ++k) {
    const double at = u.first + u.length() * k / 20000.0;
    Interval v = surface.knots_v().domain();
    for (int step = 0; step < 60; ++step)
      (evaluate(surface, {at, v.middle()}).tail<2>().norm() < 50.0 ? v.first : v.last) = v.middle();
    const double x = evaluate(surface, {at, v.middle()}).x();
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
  EXPECT_NEAR(extent->first, least, 1e-5);
  EXPECT_NEAR(extent->last, greatest, 1e-5);
  EXPECT_FALSE(root_extent(boundary.patches.at(0).shape, 60.0));
}

}  // namespace
}  // namespace isorim::geometry
