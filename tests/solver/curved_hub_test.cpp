#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/propeller/propeller.h"
#include "geometry/propeller/series.h"
#include "geometry/shapes/curves.h"
#include "geometry/topology/orientation.h"
#include "quadrature/gauss_legendre.h"
#include "solver/properties.h"

/// Blades on hubs of any profile, their volumes against other ways to the same number.
namespace isorim::solver {
namespace {

using namespace geometry;

using std::numbers::pi;

Propeller screw_on(const std::vector<NurbsCurve<2>>& profile, BladeSeries series, int blades, Hand hand = Hand::right) {
  SeriesBlade blade;
  blade.series = series;
  blade.diameter = 500.0;
  blade.blades = blades;
  blade.area_ratio = 0.6;
  blade.pitch_ratio = RadialLaw(0.9);
  Propeller screw;
  screw.sections = series_sections(blade);
  screw.blades = blades;
  screw.surface.hand = hand;
  screw.hub = hub_by_profile(profile);
  return screw;
}

NurbsCurve<2> polyline_through(const std::vector<Point2>& points) {
  Points<2> matrix(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return polyline<2>(matrix);
}

double volume_of(const Boundary<3>& boundary) {
  PropertyOptions<3> options;
  options.integration.tolerance = 1e-11;
  const auto found = geometric_properties(bezier_elements(boundary), options);
  EXPECT_LE(found.closure_defect, 1e-14);
  return found.domain->measure.value;
}

/// The volume of the screw on its curved hub, and that of the hub and of as many blades cut by another tool.
void expect_volume_of_cut_blades(const Propeller& screw, const ClipTool& tool) {
  const PropellerModel model = propeller_model(screw);
  ASSERT_TRUE(model.feet);
  const Boundary<3> blade = clip(blade_solid(screw.sections, screw.surface), tool);
  const double expected = volume_of(*model.hub) + screw.blades * volume_of(blade);
  EXPECT_NEAR(volume_of(model.boundary), expected, 2e-12 * expected);
}

TEST(CurvedHub, ConicalHubsHaveTheVolumeOfBladesCutByACone) {
  // The first section lies at 50 mm, so that the cone cuts the blades beyond it.
  const std::vector<Point2> points{{-90.0, 70.0}, {110.0, 54.0}};
  const double slope = (points[1] - points[0]).y() / (points[1] - points[0]).x();
  const ConeTool cone{Point3(points[0].x() - points[0].y() / slope, 0.0, 0.0), -Vector3::UnitX(), std::atan(-slope),
                      KeptSide::outside};
  for (const BladeSeries series : {BladeSeries::kaplan, BladeSeries::wageningen_b})
    for (const Hand hand : {Hand::right, Hand::left})
      expect_volume_of_cut_blades(screw_on({polyline_through(points)}, series, 4, hand), cone);
}

TEST(CurvedHub, RoundHubsHaveTheVolumeOfBladesCutByASphere) {
  const std::vector<NurbsCurve<2>> half_circle{circular_arc(95.0, Point2::Zero(), pi, 0.0)};
  const SphereTool ball{Point3::Zero(), 95.0, KeptSide::outside};
  expect_volume_of_cut_blades(screw_on(half_circle, BladeSeries::kaplan, 3), ball);
  expect_volume_of_cut_blades(screw_on(half_circle, BladeSeries::wageningen_b, 5), ball);
}

// The cylinder divided where the blades stand: the same body along the other way.
TEST(CurvedHub, ADividedCylinderIsACylinder) {
  for (const int blades : {3, 5, 7}) {
    const std::vector<NurbsCurve<2>> whole{polyline_through({{-90.0, 50.0}, {95.0, 50.0}})};
    const std::vector<NurbsCurve<2>> divided{polyline_through({{-90.0, 50.0}, {5.0, 50.0}, {95.0, 50.0}})};
    const PropellerModel one = propeller_model(screw_on(whole, BladeSeries::wageningen_b, blades));
    const PropellerModel two = propeller_model(screw_on(divided, BladeSeries::wageningen_b, blades));
    EXPECT_FALSE(one.feet);
    ASSERT_TRUE(two.feet);
    const double volume = volume_of(one.boundary);
    EXPECT_NEAR(volume_of(two.boundary), volume, 2e-12 * volume);
  }
}

/// Of a smooth spline with inner knots.
double smooth_radius(double x) {
  return 62.0 - 0.06 * x - 6e-4 * x * x + (x > 10.0 ? 4e-6 * std::pow(x - 10.0, 3) : 0.0);
}

/// smooth_radius() from -95 to 120 as a cubic spline: by its blossoms, f(a, b, c) of the polynomial on each side.
NurbsCurve<2> smooth_profile() {
  const std::vector<double> knots{-95, -95, -95, -95, 10, 120, 120, 120, 120};
  Points<2> points(2, 5);
  for (std::size_t i = 0; i < 5; ++i) {
    const double a = knots[i + 1];
    const double b = knots[i + 2];
    const double c = knots[i + 3];
    const double sum = (a + b + c) / 3.0;
    double radius = 62.0 - 0.06 * sum - 6e-4 * (a * b + b * c + c * a) / 3.0;
    // Knots not below 10 see the truncated power, whose blossom vanishes where one of them is 10.
    radius += 4e-6 * std::max(0.0, a - 10.0) * std::max(0.0, b - 10.0) * std::max(0.0, c - 10.0);
    points.col(static_cast<Eigen::Index>(i)) << sum, radius;
  }
  return NurbsCurve<2>::from_points(KnotVector(3, knots), points);
}

/// Gauss's rule on an interval: f(place, weight).
template <class Function>
void over(Interval range, int count, const Function& f) {
  const quadrature::Rule& rule = quadrature::gauss_legendre(count);
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    f(range.first + range.length() * rule.nodes[k], range.length() * rule.weights[k]);
  }
}

/// The flux of (0, y, z) / 2, whose divergence is 1, through a surface element along its natural normal.
double flux(const NurbsSurface<3>& surface, const Point2& uv) {
  const SurfaceJet<3> jet = evaluate_jet(surface, uv);
  return 0.5 * Vector3(0.0, jet.point.y(), jet.point.z()).dot(jet.du.cross(jet.dv));
}

/// Beyond a hub of radius R(X), plain Gauss rules on a blade's surface.
struct BruteForce {
  const NurbsSurface<3>& blade;
  std::function<double(double)> radius;

  /// v where the blade meets the hub, by bisection.
  double foot(double u) const {
    Interval bracket{blade.knots_v().domain().first, 0.5};
    for (int i = 0; i < 60; ++i) {
      const Point3 p = evaluate(blade, Point2(u, bracket.middle()));
      (std::hypot(p.y(), p.z()) < radius(p.x()) ? bracket.first : bracket.last) = bracket.middle();
    }
    return bracket.middle();
  }

  double flux_beyond(double u, double from) const {
    std::vector<double> rows{from};
    for (const double v : blade.knots_v().breakpoints())
      if (v > from) rows.push_back(v);
    double sum = 0.0;
    for (std::size_t row = 0; row + 1 < rows.size(); ++row)
      over({rows[row], rows[row + 1]}, 6, [&](double v, double weight) { sum += weight * flux(blade, {u, v}); });
    return sum;
  }

  /// theta R^2 / 2 dX / du along the foot, with theta the angle about the shaft; v' from F_u + F_v v' = 0.
  double covered_rate(double u, double v) const {
    const SurfaceJet<3> jet = evaluate_jet(blade, Point2(u, v));
    const auto height_rate = [&](const Vector3& d) {
      constexpr double h = 1e-4;
      const double slope = (radius(jet.point.x() + h) - radius(jet.point.x() - h)) / (2.0 * h);
      return (jet.point.y() * d.y() + jet.point.z() * d.z()) / std::hypot(jet.point.y(), jet.point.z()) - slope * d.x();
    };
    const Vector3 along = jet.du - height_rate(jet.du) / height_rate(jet.dv) * jet.dv;
    return 0.5 * std::pow(radius(jet.point.x()), 2) * std::atan2(jet.point.y(), jet.point.z()) * along.x();
  }
};

/// What one blade adds to a hub of radius R(X): the flux through its sides and its tip, less that through what it
/// covers of the hub, int R^2 / 2 dX dtheta, by Green's theorem round the foot.
double volume_beyond(const Boundary<3>& solid, const std::function<double(double)>& radius) {
  const Patch<3>& side = solid.patches.front();
  const BruteForce blade{surface_of(side.shape), radius};
  const std::vector<double> spans = blade.blade.knots_u().breakpoints();
  double through_sides = 0.0;
  double covered = 0.0;
  constexpr int parts = 16;
  for (std::size_t span = 0; span + 1 < spans.size(); ++span)
    for (int part = 0; part < parts; ++part) {
      const double step = (spans[span + 1] - spans[span]) / parts;
      over({spans[span] + part * step, spans[span] + (part + 1) * step}, 8, [&](double u, double weight) {
        const double from = blade.foot(u);
        through_sides += weight * side.orientation * blade.flux_beyond(u, from);
        covered += weight * blade.covered_rate(u, from);
      });
    }
  for (const Patch<3>& patch : solid.patches) {
    if (patch.name != "tip") continue;
    const NurbsSurface<3>& tip = surface_of(patch.shape);
    const std::vector<double> columns = tip.knots_u().breakpoints();
    for (std::size_t i = 0; i + 1 < columns.size(); ++i)
      over({columns[i], columns[i + 1]}, 8, [&](double u, double weight_u) {
        over({0.0, 1.0}, 8, [&](double v, double weight_v) {
          through_sides += patch.orientation * weight_u * weight_v * flux(tip, {u, v});
        });
      });
  }
  return through_sides - std::abs(covered);
}

TEST(CurvedHub, HubsByASplineHaveTheVolumeOfBruteForce) {
  const Propeller screw = screw_on({smooth_profile()}, BladeSeries::kaplan, 4);
  const PropellerModel model = propeller_model(screw);
  ASSERT_TRUE(model.feet);
  const double one = volume_beyond(blade_solid(screw.sections, screw.surface), smooth_radius);
  double hub = 0.0;
  for (const Interval part : {Interval{-95.0, 10.0}, Interval{10.0, 120.0}})
    over(part, 8, [&](double x, double weight) { hub += weight * pi * std::pow(smooth_radius(x), 2); });
  EXPECT_NEAR(volume_of(*model.hub), hub, 1e-12 * hub);
  EXPECT_NEAR(volume_of(model.boundary), hub + 4.0 * one, 1e-9 * hub);
}

}  // namespace
}  // namespace isorim::solver
