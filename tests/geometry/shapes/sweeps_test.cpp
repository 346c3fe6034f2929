#include "geometry/shapes/sweeps.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/fill.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/swept_solids.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::Measures;
using testing::measures;
using testing::refusal;
constexpr double pi = std::numbers::pi;

/// Closed, with outward natural normals, and of the right measures.
void expect_solid(const Boundary<3>& solid, double area, double volume, double tolerance = 1e-12) {
  const Measures found = measures(solid);
  EXPECT_NEAR(found.boundary, area, tolerance * area);
  EXPECT_NEAR(found.content, volume, tolerance * volume);
  const OrientedBoundary<3> oriented = orient(solid);
  EXPECT_NO_THROW(require_closed(oriented));
  for (std::size_t i = 0; i < solid.patches.size(); ++i) {
    EXPECT_EQ(oriented.boundary.patches[i].orientation, 1) << solid.patches[i].name;
    EXPECT_EQ(solid.patches[i].orientation, 1) << solid.patches[i].name;
  }
}

/// Positive Jacobian at inner points, and the area once.
void expect_filled(const Boundary<2>& region) {
  const std::vector<NurbsSurface<2>> patches = fill(region);
  double area = 0.0;
  const testing::GaussRule rule = testing::gauss_rule(16);
  for (const NurbsSurface<2>& patch : patches) {
    const std::vector<double> vs = patch.knots_v().breakpoints();
    for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        for (std::size_t l = 0; l < rule.nodes.size(); ++l) {
          const double dv = vs[j + 1] - vs[j];
          const SurfaceJet<2> jet = evaluate_jet(patch, Point2(rule.nodes[k], vs[j] + dv * rule.nodes[l]));
          const double jacobian = jet.du.x() * jet.dv.y() - jet.du.y() * jet.dv.x();
          ASSERT_GT(jacobian, 0.0);
          area += jacobian * dv * rule.weights[k] * rule.weights[l];
        }
      }
    }
  }
  const double expected = measures(orient(region).boundary).content;
  EXPECT_NEAR(area, expected, 1e-13 * expected);
}

Points<2> columns(const std::vector<Point2>& points) {
  Points<2> result(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

Boundary<2> with_holes(Boundary<2> region, const std::vector<Boundary<2>>& holes) {
  for (const Boundary<2>& hole : holes) {
    for (Patch<2> patch : hole.patches) {
      patch.name += fmt::format("_hole_{}", region.patches.size());
      region.patches.push_back(patch);
    }
  }
  return region;
}

/// A closed cubic B-spline through a wavy ring: far from convex.
NurbsCurve<2> amoeba(int lobes, double depth) {
  const int count = 8 * lobes;
  std::vector<double> breakpoints;
  for (int i = 0; i <= count; ++i) breakpoints.push_back(static_cast<double>(i) / count);
  const KnotVector knots = KnotVector::periodic(3, breakpoints);
  Points<2> points(2, knots.basis_count());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double t = 2.0 * pi * static_cast<double>(i % count) / count;
    const double r = 2.0 + depth * std::cos(lobes * t);
    points.col(i) << r * std::cos(t + 0.4 * std::cos(lobes * t)), r * std::sin(t + 0.4 * std::cos(lobes * t));
  }
  return clamp(NurbsCurve<2>::from_points(knots, points));
}

TEST(Fill, CoversStarShapedLoopsWithOneFanACurve) {
  EXPECT_EQ(fill(disc(2.0, Point2(3, 4))).size(), 1U);
  EXPECT_EQ(fill(rectangle(Vector2(2, 1))).size(), 4U);
  expect_filled(disc(2.0, Point2(3, 4)));
  expect_filled(elliptic_disc(Vector2(10.0, 0.1), Point2(1, 1), 1.0));
  expect_filled(polygon(columns({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})));
  expect_filled(ellipse_segment({Vector2(1, 1), Point2(0, 0), 0.0, 0.0, 0.3}));
  expect_filled(ellipse_sector({Vector2(1, 1), Point2(0, 0), 0.0, 0.0, 1.7 * pi}));
}

TEST(Fill, CoversConcaveRegionsOnce) {
  expect_filled(polygon(
      columns({{0, 0}, {5, 0}, {5, 5}, {0, 5}, {0, 2}, {3, 2}, {3, 3}, {1, 3}, {1, 4}, {4, 4}, {4, 1}, {0, 1}})));
  expect_filled({{{"amoeba", amoeba(3, 0.8)}}});
  expect_filled({{{"amoeba", amoeba(5, 1.5)}}});
  const std::vector<std::vector<NurbsCurve<2>>> crescent{
      {circular_arc(1.0, Point2(0, 0), 0.5, 2.0 * pi - 0.5),
       circular_arc(0.8, Point2(1.0 * std::cos(0.5) + std::sqrt(0.64 - std::pow(std::sin(0.5), 2)) * -1.0, 0.0),
                    std::atan2(std::sin(0.5), std::sqrt(0.64 - std::pow(std::sin(0.5), 2))),
                    2.0 * pi - std::atan2(std::sin(0.5), std::sqrt(0.64 - std::pow(std::sin(0.5), 2))))}};
  expect_filled(region(crescent));
}

TEST(Fill, CoversRegionsWithHolesAndIslandsOnce) {
  expect_filled(with_holes(disc(1.0), {disc(0.5)}));
  expect_filled(with_holes(disc(1.0), {disc(0.97)}));
  expect_filled(with_holes(rectangle(Vector2(4, 4)),
                           {disc(0.5, Point2(1, 3)), disc(0.5, Point2(1, 1)), disc(0.5, Point2(3, 1))}));
  expect_filled(with_holes(rectangle(Vector2(10, 10)),
                           {disc(4.0, Point2(5, 5)), disc(2.0, Point2(5, 5)), disc(1.0, Point2(5.3, 5))}));
  expect_filled(with_holes(rectangle(Vector2(4, 4)), {polygon(columns({{1, 1}, {3, 1}, {2, 3}}))}));
  expect_filled(
      with_holes({{{"amoeba", amoeba(4, 1.0)}}}, {disc(0.4), elliptic_disc(Vector2(0.1, 0.05), Point2(0.7, 0))}));
}

TEST(Fill, RefusesLoopsThatTouch) {
  EXPECT_THAT(refusal([] { fill(with_holes(rectangle(Vector2(2, 2)), {disc(1.0, Point2(1, 1))})); }),
              HasSubstr("loops that touch or run very close"));
}

TEST(Extrude, GivesPrismsWithHoles) {
  const Boundary<2> plate = with_holes(rectangle(Vector2(4, 3)), {disc(0.5, Point2(1, 1)), disc(0.25, Point2(3, 2))});
  const double base = 12.0 - 0.3125 * pi;
  for (const Vector3& by : {Vector3(0, 0, 2), Vector3(0, 0, -2)}) {
    expect_solid(extrude(plate, by), 2.0 * base + 2.0 * (14.0 + 1.5 * pi), 2.0 * base);
  }
  EXPECT_NEAR(measures(extrude(plate, Vector3(1, 2, 3))).content, 3.0 * base, 1e-12);
  EXPECT_EQ(extrude(plate, Vector3(0, 0, 1)).patches[0].name, "bottom");
  EXPECT_EQ(extrude(disc(1.0), Vector3(0, 0, 1)).patches[2].name, "end_cap");
}

TEST(Revolve, GivesTheSphereOfTheThesisAboutAnAxisParallelToX) {
  AffineMap<3> place;
  place.linear << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  place.translation << 0.5, 0.5, 0.5;
  const NurbsCurve<3> half = transform(embed(circular_arc(1.0, Point2(0, 0), 0.0, pi)), place);
  for (const double sign : {1.0, -1.0}) {
    const Axis axis{Point3(7.0, 0.5, 0.5), Vector3(3.0 * sign, 0, 0)};
    const Boundary<3> solid = revolve_solid(std::vector{half}, axis);
    ASSERT_EQ(solid.patches.size(), 1U);
    expect_solid(solid, 4.0 * pi, 4.0 / 3.0 * pi);
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) {
        const Point3 x = evaluate(surface_of(solid.patches[0].shape), Point2(i / 20.0, j / 20.0));
        ASSERT_NEAR((x - Point3(0.5, 0.5, 0.5)).norm(), 1.0, 3e-15);
      }
    }
  }
}

TEST(Revolve, KeepsCollapsedEdgesExactlyOnAnyAxis) {
  const Axis axis{Point3(0.1, 0.2, 0.3), Vector3(1, 2, 3)};
  const Vector3 k = axis.direction.normalized();
  const Vector3 e = k.cross(Vector3(1, 0, 0)).normalized();
  const NurbsCurve<3> line = line_segment<3>(axis.point + 0.7 * k, axis.point + 2.0 * k + 1.5 * e);
  const NurbsSurface<3> cone = revolve(line, axis, 2.0 * pi);
  for (int i = 0; i <= 20; ++i) {
    EXPECT_LE((evaluate(cone, Point2(i / 20.0, 0.0)) - (axis.point + 0.7 * k)).norm(), 3e-16);
  }
}

TEST(Revolve, PartialTurnsGetCaps) {
  const Boundary<2> ring = with_holes(rectangle(Vector2(2, 2), Point2(1, 0)), {disc(0.5, Point2(2, 1))});
  const double section = 4.0 - 0.25 * pi;
  const Axis axis{Point3(0, 0, 0), Vector3(0, 2, 0)};
  for (const double angle : {0.3, 0.5 * pi, 2.5, 5.9}) {
    expect_solid(revolve(ring, axis, angle), 2.0 * section + angle * 2.0 * (8.0 + pi), angle * 2.0 * section);
  }
  expect_solid(revolve(ring, axis), 2.0 * pi * 2.0 * (8.0 + pi), 2.0 * pi * 2.0 * section);
}

TEST(Revolve, ProfilesThatEndOnTheAxisClose) {
  const NurbsCurve<3> half = embed(circular_arc(1.0, Point2(0, 0), -0.5 * pi, 0.5 * pi));
  const Axis axis{Point3(0, 5, 0), Vector3(0, 1, 0)};
  expect_solid(revolve_solid(std::vector{half}, axis, 1.0), 2.0 + pi, 2.0 / 3.0);
  expect_solid(revolve_solid(std::vector{reverse(half)}, axis), 4.0 * pi, 4.0 / 3.0 * pi);
  // A side on the axis sweeps nothing.
  const Boundary<2> square = rectangle(Vector2(1, 2));
  const Boundary<3> solid = revolve(square, axis);
  EXPECT_EQ(solid.patches.size(), 3U);
  expect_solid(solid, 6.0 * pi, 2.0 * pi);
  expect_solid(revolve(square, axis, 0.5 * pi), 1.5 * pi + 4.0, 0.5 * pi);
}

TEST(Revolve, GivesTheFlywheelOfTheThesis) {
  const Points<2> points =
      columns({{0, 0}, {20, 0}, {20, 15}, {25, 15}, {25, 40}, {15, 40}, {15, 20}, {10, 20}, {10, 10}, {0, 10}, {0, 0}});
  const Boundary<3> solid =
      revolve(Boundary<2>{{{"side", polyline<2>(points)}}}, Axis{Point3(0, -5, 0), Vector3(1, 0, 0)});
  expect_solid(solid, 5850.0 * pi, 23125.0 * pi);
}

TEST(Revolve, GivesTheRedBloodCellOfTheThesis) {
  // Six rational spans with weights up to 5, an open profile that ends on the y axis.
  HomogeneousPoints<2> net(3, 13);
  const double w = 0.5 * std::numbers::sqrt2;
  const double a = 1.7677669529663689;
  const double b = 1.0606601717798214;
  const double c = 0.3535533905932738;
  net << 0.0, -2.5, -0.75, -w, -1.5, -a, -2.5, -a, -1.5, -w, -0.75, -2.5, 0.0,  //
      -4.5, -5.0, -1.25, -b, -1.5, -b, -0.5, c, 0.5, c, 0.25, 0.0, -0.5,        //
      5.0, 5.0, 1.0, w, 1.0, w, 1.0, w, 1.0, w, 1.0, 5.0, 5.0;
  std::vector<double> knots{0.0};
  for (int i = 0; i <= 6; ++i) knots.insert(knots.end(), 2, i / 6.0);
  knots.push_back(1.0);
  const NurbsCurve<3> profile = embed(NurbsCurve<2>(KnotVector(2, knots), net));
  const Boundary<3> solid = revolve_solid(std::vector{profile}, Axis{Point3(0, 0, 0), Vector3(0, 1, 0)});
  // The values of a 40-digit quadrature.
  const Measures found = measures(solid, 60);
  EXPECT_NEAR(found.content, 30.934183507451133, 1e-11);
  EXPECT_NEAR(found.boundary, 57.657038485113944, 1e-7);
  EXPECT_NO_THROW(require_closed(orient(solid)));
}

TEST(Ruled, JoinsCurvesOfDifferentDegrees) {
  const NurbsCurve<3> arc = embed(circular_arc(1.0, Point2(0, 0), 0.0, pi));
  const NurbsCurve<3> line = line_segment<3>(Point3(1, 0, 2), Point3(-1, 0, 2));
  const NurbsSurface<3> surface = ruled(arc, line);
  for (int i = 0; i <= 10; ++i) {
    const double u = i / 10.0;
    EXPECT_LE((evaluate(surface, Point2(u, 0.0)) - evaluate(arc, u)).norm(), 1e-15);
    EXPECT_LE((evaluate(surface, Point2(u, 1.0)) - evaluate(line, u)).norm(), 1e-15);
  }
}

TEST(MakeCompatible, ChangesNoCurve) {
  const std::vector<NurbsCurve<3>> curves{embed(circle_curve(1.0)),
                                          embed(polyline<2>(columns({{0, 0}, {1, 0}, {1, 1}, {3, 1}}))),
                                          reparametrise(embed(amoeba(3, 0.5)), Interval{2.0, 5.0})};
  const std::vector<NurbsCurve<3>> same = make_compatible<3>(curves);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    EXPECT_EQ(same[k].knots(), same[0].knots());
    const Interval domain = curves[k].domain();
    for (int i = 0; i <= 50; ++i) {
      const Point3 expected = evaluate(curves[k], domain.first + domain.length() * i / 50.0);
      EXPECT_LE((evaluate(same[k], i / 50.0) - expected).norm(), 1e-14);
    }
  }
}

std::vector<NurbsCurve<3>> circles(const std::vector<std::pair<double, double>>& radius_and_height) {
  std::vector<NurbsCurve<3>> result;
  for (const auto& [radius, height] : radius_and_height) {
    result.push_back(transform(embed(circle_curve(radius)), translation<3>(Vector3(0, 0, height))));
  }
  return result;
}

TEST(Loft, ReproducesItsSections) {
  const std::vector<NurbsCurve<3>> sections = circles({{1, 0}, {1.5, 1}, {1.2, 2}, {0.9, 3.2}, {1, 4}});
  for (const int degree : {1, 2, 3, 4, 7}) {
    const NurbsSurface<3> surface = loft(sections, {degree});
    EXPECT_EQ(surface.knots_v().degree(), std::min(degree, 4));
    for (const NurbsCurve<3>& section : sections) {
      for (const double u : {0.0, 0.1, 0.37, 0.5, 0.93}) {
        const Point3 expected = evaluate(section, u);
        // The section is a parameter line: find it by its height, which rises with v.
        double low = 0.0;
        double high = 1.0;
        for (int k = 0; k < 60; ++k) {
          const double middle = 0.5 * (low + high);
          (evaluate(surface, Point2(u, middle)).z() < expected.z() ? low : high) = middle;
        }
        EXPECT_LE((evaluate(surface, Point2(u, high)) - expected).norm(), 1e-13) << degree;
      }
    }
  }
}

TEST(Loft, MakesSolids) {
  // Linear between circles: cone frusta, either way round.
  const double frusta = pi * (7.0 / 3.0 + 2.0 * 7.0 / 3.0);
  const Boundary<3> solid = loft_solid(circles({{1, 0}, {2, 1}, {1, 3}}), {1});
  const Measures found = measures(solid);
  EXPECT_NEAR(found.content, frusta, 1e-12);
  EXPECT_NEAR(measures(loft_solid(circles({{1, 3}, {2, 1}, {1, 0}}), {1})).content, frusta, 1e-12);
  ASSERT_EQ(solid.patches.size(), 3U);
  EXPECT_EQ(solid.patches[1].name, "start_cap");
  // A cubic through circles of equal radius is the cylinder.
  EXPECT_NEAR(measures(loft_solid(circles({{1, 0}, {1, 1}, {1, 2.5}, {1, 4}}))).content, 4.0 * pi, 1e-12);
}

TEST(Sweeps, RefuseWhatCannotBeSwept) {
  const NurbsCurve<3> line = line_segment<3>(Point3(1, 0, 0), Point3(1, 1, 0));
  const Boundary<2> square = rectangle(Vector2(1, 1), Point2(1, 1));
  const Axis y{Point3(0, 0, 0), Vector3(0, 1, 0)};
  EXPECT_THAT(refusal([&] {
                revolve(line, Axis{Point3(0, 0, 0), Vector3(0, 0, 0)}, 1.0);
              }),
              HasSubstr("revolve: axis direction is zero"));
  EXPECT_THAT(refusal([&] { revolve(line, y, 0.0); }), HasSubstr("revolve: angle is 0, it must lie in (0, 2 pi]"));
  EXPECT_THAT(refusal([&] { revolve(line, y, -1.0); }), HasSubstr("angle is -1"));
  EXPECT_THAT(refusal([&] { revolve(line, y, 6.3); }), HasSubstr("angle is 6.3"));
  EXPECT_THAT(refusal([&] {
                revolve(line, Axis{Point3(1, 0, 0), Vector3(0, 1, 0)}, 1.0);
              }),
              HasSubstr("the whole curve lies on the axis"));
  EXPECT_THAT(refusal([&] { revolve_solid(std::vector{line}, y); }), HasSubstr("the boundary is not closed"));
  EXPECT_THAT(refusal([&] {
                revolve(square, Axis{Point3(1.5, 0, 0), Vector3(0, 1, 0)});
              }),
              HasSubstr("must lie on one side of the axis"));
  EXPECT_THAT(refusal([&] {
                revolve(square, Axis{Point3(0, 0, 0), Vector3(0, 1, 1)});
              }),
              HasSubstr("must lie in one plane with the axis"));
  EXPECT_THAT(refusal([&] { extrude(line, Vector3(0, 0, 0)); }), HasSubstr("extrude: vector is zero"));
  EXPECT_THAT(refusal([&] { extrude(square, Vector3(1, 0, 0)); }), HasSubstr("parallel to the plane"));
  EXPECT_THAT(refusal([&] { loft(std::vector{line}); }), HasSubstr("1 section(s), at least 2"));
  EXPECT_THAT(refusal([&] { loft(std::vector{line, line}); }), HasSubstr("sections 0 and 1 coincide"));
  EXPECT_THAT(refusal([&] { loft(std::vector{line, line}, {0}); }), HasSubstr("degree is 0"));
}

}  // namespace
}  // namespace isorim::geometry
