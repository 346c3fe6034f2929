#include "geometry/intersection/plane_section.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/swept_solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/intersection/section_measures.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/random_splines.h"
#include "tests/geometry/refusals.h"
#include "tests/geometry/trimming/face_measures.h"
#include "tests/geometry/tspline/extracted_surfaces.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::Random;
using testing::refusal;
using testing::section_area;

constexpr double pi = std::numbers::pi;

Vector3 random_direction(Random& random) {
  while (true) {
    const Vector3 d(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    if (d.norm() < 1.0 && d.norm() > 0.1) return d.normalized();
  }
}

/// Every point of the section lies on the plane and (as it is evaluated there) on its patch; loops are closed but for
/// the gaps that they report, and turn as they should.
void expect_sound(const Boundary<3>& boundary, const PlaneSection& section, double size) {
  const auto check = [&](const SectionCurve& curve) {
    for (std::size_t i = 0; i < curve.pieces.size(); ++i) {
      const SectionPiece& piece = curve.pieces[i];
      ASSERT_LT(piece.patch, static_cast<int>(boundary.patches.size()));
      for (const double t : {0.0, 0.13, 0.5, 0.71, 1.0}) {
        const SectionPointJet jet = evaluate_jet(piece, t);
        EXPECT_NEAR((jet.place.point - section.frame.origin).dot(section.frame.normal), 0.0, 2e-14 * size);
        EXPECT_NEAR(jet.derivative.dot(section.frame.normal), 0.0, 1e-11 * size);
        if (piece.element >= 0) continue;
        const SurfaceShape& shape = boundary.patches[static_cast<std::size_t>(piece.patch)].shape;
        EXPECT_LE((evaluate(surface_of(shape), jet.place.uv) - jet.place.point).norm(), 1e-14 * size);
      }
    }
  };
  for (const SectionLoop& loop : section.loops) {
    check(loop.curve);
    EXPECT_TRUE(loop.curve.is_closed);
    EXPECT_EQ(section_area(loop.curve) < 0.0, loop.is_hole);
    EXPECT_EQ(loop.parent >= 0, loop.is_hole);
  }
  for (const SectionCurve& chain : section.chains) check(chain);
  for (const SectionCurve& curve : section.touching) check(curve);
  for (const SectionPoint& point : section.isolated)
    EXPECT_NEAR((point.point - section.frame.origin).dot(section.frame.normal), 0.0, 2e-13 * size);
}

PlaneSection cut(const Boundary<3>& boundary, const Point3& point, const Vector3& normal) {
  const PlaneCutter cutter(boundary);
  const PlaneSection section = cutter.section(plane_frame(point, normal));
  expect_sound(boundary, section, cutter.size());
  EXPECT_EQ(section.shift, 0.0);
  return section;
}

/// Loops, touching curves, isolated points, double points, faces in the plane, open chains.
struct Counts {
  std::size_t loops = 0;
  std::size_t touching = 0;
  std::size_t isolated = 0;
  std::size_t double_points = 0;
  std::size_t coplanar = 0;
  std::size_t chains = 0;
  bool operator==(const Counts&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.loops << " loops, " << c.touching << " touching, " << c.isolated << " isolated, " << c.double_points
             << " double, " << c.coplanar << " coplanar, " << c.chains << " chains";
}
Counts counts(const PlaneSection& s) {
  return {s.loops.size(),         s.touching.size(), s.isolated.size(),
          s.double_points.size(), s.coplanar.size(), s.chains.size()};
}

TEST(PlaneFrame, IsThatOfTheDrawing) {
  const PlaneFrame waterline = plane_frame({1, 2, 3}, {0, 0, 2});
  EXPECT_EQ(waterline.to_plane({4, 5, 3}), Point2(4, 5));
  const PlaneFrame frame = plane_frame({7, 0, 0}, Vector3::UnitX());
  EXPECT_EQ(frame.to_plane({7, 5, 6}), Point2(5, 6));
  const PlaneFrame oblique = plane_frame({1, 1, 1}, {1, 2, 3});
  EXPECT_NEAR((oblique.axis_x.cross(oblique.axis_y) - oblique.normal).norm(), 0.0, 1e-15);
  EXPECT_NEAR((oblique.to_space(oblique.to_plane({1, 1, 1})) - Point3(1, 1, 1)).norm(), 0.0, 1e-15);
  EXPECT_THAT(refusal([] { plane_frame({0, 0, 0}, {0, 0, 0}); }), HasSubstr("normal"));
}

TEST(PlaneSection, OfSpheresIsACircle) {
  Random random(1);
  for (const Boundary<3>& ball : {sphere(1.0, {0.3, 0.2, 0.1}), six_patch_sphere(1.0, {0.3, 0.2, 0.1})}) {
    for (int k = 0; k < 25; ++k) {
      const Vector3 normal = random_direction(random);
      const double height = random.real(-0.999, 0.999);
      const PlaneSection section = cut(ball, Point3(0.3, 0.2, 0.1) + height * normal, normal);
      ASSERT_EQ(counts(section), (Counts{.loops = 1}));
      EXPECT_NEAR(section_area(section), pi * (1.0 - height * height), 1e-13);
      for (const SectionPiece& piece : section.loops[0].curve.pieces)
        for (const double t : {0.0, 0.4, 1.0})
          EXPECT_NEAR((evaluate_jet(piece, t).place.point - Point3(0.3, 0.2, 0.1)).norm(), 1.0, 1e-14);
    }
  }
}

TEST(PlaneSection, TouchesSpheresInAPoint) {
  Random random(2);
  for (const Boundary<3>& ball : {sphere(1.0), six_patch_sphere(1.0)}) {
    std::vector<Vector3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1, 1, 0}, {1, 1, 1}, {-1, 1, 1}};
    for (int k = 0; k < 20; ++k) normals.push_back(random_direction(random));
    for (const Vector3& normal : normals) {
      const Vector3 n = normal.normalized();
      const PlaneSection section = cut(ball, n, n);
      ASSERT_EQ(counts(section), (Counts{.isolated = 1})) << n.transpose();
      EXPECT_LE((section.isolated[0].point - n).norm(), 1e-7);
      EXPECT_TRUE(cut(ball, 1.001 * n, n).is_empty());
    }
  }
}

/// The circle just below the point of contact is found however small it is.
TEST(PlaneSection, FindsTheSmallestCircles) {
  const Vector3 oblique = Vector3(0.3, 0.5, 0.8).normalized();
  for (const Vector3& n : {Vector3(0, 0, 1), Vector3(1, 0, 0), oblique}) {
    for (const double depth : {1e-3, 1e-6, 1e-9, 1e-11}) {
      const PlaneSection section = cut(sphere(1.0), (1.0 - depth) * n, n);
      ASSERT_EQ(counts(section), (Counts{.loops = 1})) << depth;
      EXPECT_NEAR(section_area(section) / (pi * depth * (2.0 - depth)), 1.0, 1e-14 / depth + 1e-8);
    }
  }
}

/// Planes d inside and outside of those that touch along a curve or in a point.
TEST(PlaneSection, TellsTheSidesOfTangentPlanes) {
  struct Contact {
    std::string name;
    Boundary<3> solid;
    Point3 point;
    Vector3 outward;
    Counts inside;
    Counts outside;
    /// Of the section d inside, to lowest order.
    std::function<double(double)> area;
  };
  const Vector3 x(1, 0, 0);
  const Vector3 z(0, 0, 1);
  const Vector3 oblique = Vector3(0.3, 0.5, 0).normalized();
  const double tilt = std::asin(0.25);
  // Each neighbourhood of an inner point of contact is a saddle; the area is that of both parts of the tube.
  const auto strip = [](double d) { return 4.0 * std::sqrt(2.0 * d); };
  const std::vector<Contact> contacts{
      {"torus top", torus(2.0, 0.5), 0.5 * z, z, {.loops = 2}, {}, [](double d) { return 8.0 * pi * std::sqrt(d); }},
      {"torus outside",
       torus(2.0, 0.5),
       2.5 * x,
       x,
       {.loops = 1},
       {},
       [](double d) { return 2.0 * pi * d * std::sqrt(0.5 * 2.5); }},
      {"torus outside, oblique",
       torus(2.0, 0.5),
       2.5 * oblique,
       oblique,
       {.loops = 1},
       {},
       [](double d) { return 2.0 * pi * d * std::sqrt(0.5 * 2.5); }},
      {"torus inside", torus(2.0, 0.5), 1.5 * x, x, {.loops = 2}, {.loops = 1}, nullptr},
      {"torus bitangent",
       torus(2.0, 0.5),
       {0, 0, 0},
       {std::sin(tilt), 0, std::cos(tilt)},
       {.loops = 1},
       {.loops = 1},
       nullptr},
      {"cylinder", cylinder(1.0, 2.0), x, x, {.loops = 1}, {}, strip},
      {"cylinder, oblique", cylinder(1.0, 2.0), oblique, oblique, {.loops = 1}, {}, strip},
      {"cap", cylinder(1.0, 2.0), 2.0 * z, z, {.loops = 1}, {}, [](double) { return pi; }},
      {"rim", cylinder(1.0, 2.0), {1, 0, 2}, {1, 0, 1}, {.loops = 1}, {}, nullptr},
  };
  for (const Contact& contact : contacts) {
    const Vector3 n = contact.outward.normalized();
    for (const double d : {1e-6, 1e-9}) {
      SCOPED_TRACE(fmt::format("{} {}", contact.name, d));
      const PlaneSection inside = cut(contact.solid, contact.point - d * n, n);
      EXPECT_EQ(counts(inside), contact.inside);
      if (contact.area) {
        EXPECT_NEAR(section_area(inside) / contact.area(d), 1.0, 2e-6);
      }
      EXPECT_EQ(counts(cut(contact.solid, contact.point + d * n, n)), contact.outside);
    }
    // So near that it may count as touching, or be moved: what is found has no open curves.
    const PlaneCutter cutter(contact.solid);
    for (const double d : {1e-12, -1e-12, 1e-13, -1e-13, 0.0}) {
      const PlaneSection section = cutter.section(plane_frame(contact.point - d * n, n));
      EXPECT_TRUE(section.chains.empty()) << contact.name << d;
      EXPECT_LE(std::abs(section.shift), 4.1e-11 * cutter.size());
    }
  }
}

/// The section of a cylinder by a plane through its axis' middle is an ellipse of area pi / cos, at any place.
TEST(PlaneSection, OfSolidsFarFromTheOrigin) {
  const Vector3 axis = Vector3(1.0, 2.0, 0.5).normalized();
  const Vector3 normal = Vector3(1.1, 1.7, 0.2).normalized();
  const Boundary<3> lying =
      transform<3>(cylinder(1.0, 8.0, {0.0, 0.0, -4.0}),
                   rotation(Axis{Point3::Zero(), Vector3::UnitZ().cross(axis)}, std::acos(axis.z())));
  for (const double far : {1e2, 1e3, 1e4, 1e5}) {
    const Vector3 place(far, -far, 0.5 * far);
    const Boundary<3> boundary = transform<3>(lying, translation<3>(place));
    const PlaneSection section = plane_section(boundary, plane_frame(place, normal));
    EXPECT_EQ(section.shift, 0.0);
    EXPECT_TRUE(section.chains.empty() && section.isolated.empty() && section.touching.empty());
    ASSERT_EQ(section.loops.size(), 1u) << far;
    // About the origin of the plane's coordinates, which is as far away.
    EXPECT_NEAR(section_area(section.loops[0].curve), pi / axis.dot(normal), 2e-15 * far * far + 1e-13 * far);
    for (const SectionPiece& piece : section.loops[0].curve.pieces)
      for (const double t : {0.0, 0.3, 1.0})
        EXPECT_NEAR((evaluate_jet(piece, t).place.point - place).dot(normal), 0.0, 1e-15 * far);
  }
}

TEST(PlaneSection, OfATorusAtFourHeights) {
  for (const Boundary<3>& ring :
       {torus(2.0, 0.5), sixteen_patch_torus(2.0, 0.5), testing::extracted(torus(2.0, 0.5))}) {
    const Vector3 z(0, 0, 1);
    const PlaneSection middle = cut(ring, {0, 0, 0}, z);
    EXPECT_EQ(counts(middle), (Counts{.loops = 2}));
    EXPECT_NEAR(section_area(middle), 4.0 * pi, 1e-13);
    const PlaneSection above = cut(ring, {0, 0, 0.3}, z);
    EXPECT_EQ(counts(above), (Counts{.loops = 2}));
    EXPECT_NEAR(section_area(above), 3.2 * pi, 1e-13);
    for (const double side : {1.0, -1.0}) {
      const PlaneSection top = cut(ring, {0, 0, side * 0.5}, z);
      ASSERT_EQ(counts(top), (Counts{.touching = 1}));
      EXPECT_TRUE(top.touching[0].is_closed);
      for (const SectionPiece& piece : top.touching[0].pieces)
        EXPECT_NEAR(evaluate_jet(piece, 0.37).place.point.head<2>().norm(), 2.0, 1e-14);
    }
    EXPECT_TRUE(cut(ring, {0, 0, 0.6}, z).is_empty());
  }
}

/// The circle of contact crosses the elements where the knot lines do not know of it: a torus of revolution about an
/// axis in its tube's own frame, its profile turned.
TEST(PlaneSection, FollowsCurvesOfContactThroughElements) {
  Random random(3);
  for (int k = 0; k < 6; ++k) {
    // An elliptic cylinder, tilted: the line of contact with a tangent plane runs across its parameters.
    const AffineMap<3> shear{(Eigen::Matrix3d() << 1, 0, 0.3, 0.2, 1, 0.1, 0, 0.4, 1).finished(), Vector3::Zero()};
    const Boundary<3> solid = transform(cylinder(1.0, 2.0), shear);
    const double angle = random.real(0.0, 2.0 * pi);
    const Vector3 radial(std::cos(angle), std::sin(angle), 0);
    // Normals map by the inverse transpose, here written by tangents.
    const Vector3 normal = (shear.linear * Vector3(-radial.y(), radial.x(), 0)).cross(shear.linear * Vector3(0, 0, 1));
    const PlaneSection section = cut(solid, shear(radial), normal);
    ASSERT_EQ(counts(section), (Counts{.touching = 1})) << angle;
    EXPECT_FALSE(section.touching[0].is_closed);
    const std::vector<SectionPiece>& pieces = section.touching[0].pieces;
    const Point3 from = evaluate_jet(pieces.front(), 0.0).place.point;
    const Point3 to = evaluate_jet(pieces.back(), 1.0).place.point;
    EXPECT_NEAR((to - from).norm(), 2.0 * (shear.linear * Vector3(0, 0, 1)).norm(), 1e-9);
  }
}

/// A ring whose tube is an ellipse, turned against the axis: its highest circle is no knot line.
Boundary<3> tilted_ring() {
  const Boundary<2> tube = elliptic_disc({0.5, 0.3}, {2.0, 0.0}, 0.4);
  const Boundary<3> about_y = revolve(tube, Axis{{0, 0, 0}, {0, 1, 0}});
  return orient(transform(about_y, rotation(Axis{{0, 0, 0}, {1, 0, 0}}, pi / 2))).boundary;
}

TEST(PlaneSection, FindsTheTopOfATiltedRing) {
  const Boundary<3> ring = tilted_ring();
  const double top = std::hypot(0.5 * std::sin(0.4), 0.3 * std::cos(0.4));
  const PlaneSection section = cut(ring, {0, 0, top}, {0, 0, 1});
  ASSERT_EQ(counts(section), (Counts{.touching = 1}));
  EXPECT_TRUE(section.touching[0].is_closed);
  double length = 0.0;
  for (const SectionPiece& piece : section.touching[0].pieces) {
    const double radius = evaluate_jet(piece, 0.61).place.point.head<2>().norm();
    const double expected = 2.0 + (0.25 - 0.09) * std::sin(0.4) * std::cos(0.4) / top;
    EXPECT_NEAR(radius, expected, 1e-7);
    length += testing::piece_length(piece);
  }
  EXPECT_NEAR(length, 2.0 * pi * (2.0 + 0.16 * std::sin(0.4) * std::cos(0.4) / top), 1e-6);
  EXPECT_EQ(counts(cut(ring, {0, 0, top - 1e-6}, {0, 0, 1})), (Counts{.loops = 2}));
  EXPECT_TRUE(cut(ring, {0, 0, top + 1e-6}, {0, 0, 1}).is_empty());
}

/// Villarceau: the plane that touches a torus in two points cuts it in two circles of the major radius, whose centres
/// are two minor radii apart. The region is what lies in one circle but not in both.
TEST(PlaneSection, OfATorusByItsBitangentPlane) {
  const double R = 2.0;
  const double r = 0.5;
  const double lens = 2.0 * R * R * std::acos(r / R) - r * std::sqrt(4.0 * R * R - 4.0 * r * r);
  for (const double angle : {0.0, 0.3, 1.0, 2.5, pi / 4.0}) {
    const Vector3 normal(r * std::cos(angle), r * std::sin(angle), -std::sqrt(R * R - r * r));
    for (const Boundary<3>& ring : {torus(R, r), sixteen_patch_torus(R, r)}) {
      const PlaneSection section = cut(ring, {0, 0, 0}, normal);
      ASSERT_EQ(counts(section), (Counts{.loops = 2, .double_points = 2}));
      EXPECT_NEAR(section_area(section), 2.0 * (pi * R * R - lens), 1e-12);
      const PlaneFrame& frame = section.frame;
      for (const SectionLoop& loop : section.loops)
        for (const SectionPiece& piece : loop.curve.pieces) {
          const Point2 point = frame.to_plane(evaluate_jet(piece, 0.5).place.point);
          const double from_first = std::abs((point - Point2(r, 0)).norm() - R);
          const double from_second = std::abs((point + Point2(r, 0)).norm() - R);
          EXPECT_LE(std::min(from_first, from_second), 1e-12);
        }
    }
  }
}

/// The plane that touches the hole of a torus with R = 2 r from inside: Bernoulli's lemniscate of area 8 r^2. Beside it
/// there are one loop and two.
TEST(PlaneSection, IsALemniscateAtTheInnerTangent) {
  for (const double angle : {0.0, 0.3, pi / 4.0, pi / 2.0, 2.0}) {
    const Vector3 n(std::cos(angle), std::sin(angle), 0);
    for (const Boundary<3>& ring : {torus(1.0, 0.5), sixteen_patch_torus(1.0, 0.5)}) {
      const PlaneSection section = cut(ring, 0.5 * n, n);
      ASSERT_EQ(counts(section), (Counts{.loops = 2, .double_points = 1})) << angle;
      EXPECT_NEAR(section_area(section), 2.0, 1e-12);
      EXPECT_NEAR(section_area(section.loops[0].curve), 1.0, 1e-12);
      EXPECT_LE((section.double_points[0].point - 0.5 * n).norm(), 1e-9);
      EXPECT_EQ(counts(cut(ring, 0.500001 * n, n)), (Counts{.loops = 1}));
      EXPECT_EQ(counts(cut(ring, 0.499999 * n, n)), (Counts{.loops = 2}));
      EXPECT_EQ(counts(cut(ring, 1.5 * n, n)), (Counts{.isolated = 1}));
    }
  }
}

TEST(PlaneSection, OfCylindersIsAnEllipse) {
  Random random(4);
  const Boundary<3> solid = cylinder(1.0, 4.0, {0, 0, -2});
  for (int k = 0; k < 20; ++k) {
    const double slope = random.real(0.0, 1.5);
    const double angle = random.real(0.0, 2.0 * pi);
    const Vector3 normal(slope * std::cos(angle), slope * std::sin(angle), 1.0);
    const PlaneSection section = cut(solid, {0, 0, 0.1}, normal);
    ASSERT_EQ(counts(section), (Counts{.loops = 1}));
    EXPECT_NEAR(section_area(section), pi * std::hypot(1.0, slope), 1e-12);
  }
  // Along a generator, at the rim, through the axis.
  EXPECT_EQ(counts(cut(solid, {1, 0, 0}, {1, 0, 0})), (Counts{.touching = 1}));
  EXPECT_EQ(counts(cut(solid, {1, 0, 2}, {1, 0, 1})), (Counts{.isolated = 1}));
  const Vector3 oblique(std::cos(0.3), std::sin(0.3), 0.7);
  EXPECT_EQ(counts(cut(solid, {std::cos(0.3), std::sin(0.3), 2}, oblique)), (Counts{.isolated = 1}));
  EXPECT_NEAR(section_area(cut(solid, {0, 0, 0}, {1, 0, 0})), 8.0, 1e-13);
}

TEST(PlaneSection, OfAConeIsAConic) {
  const Boundary<3> solid = cone(1.0, 0.0, 2.0);
  EXPECT_EQ(counts(cut(solid, {0, 0, 2}, {0, 0, 1})), (Counts{.isolated = 1}));
  EXPECT_EQ(counts(cut(solid, {1, 0, 0}, {2, 0, 1})), (Counts{.touching = 1}));
  EXPECT_NEAR(section_area(cut(solid, {0, 0, 0}, {1, 0, 0})), 2.0, 1e-13);
  // Parallel to a generator: y^2 = 0.64 + 1.6 x seen from above.
  const PlaneSection parabola = cut(solid, {0.2, 0, 0}, {2, 0, 1});
  EXPECT_EQ(counts(parabola), (Counts{.loops = 1}));
  EXPECT_NEAR(section_area(parabola), std::sqrt(5.0) * 4.0 / 4.8 * std::pow(0.96, 1.5), 1e-12);
  // Parallel to the axis, y = 1/2: z <= 2 - 2 sqrt(x^2 + 1/4), a hyperbola.
  const double a = std::sqrt(0.75);
  const double under = 4.0 * a - 2.0 * (a * 1.0 + 0.25 * std::asinh(2.0 * a));
  const PlaneSection hyperbola = cut(solid, {0, 0.5, 0}, {0, 1, 0});
  EXPECT_NEAR(section_area(hyperbola), under, 1e-12);
}

TEST(PlaneSection, OfABox) {
  const Boundary<3> solid = box({1, 2, 3});
  for (const double z : {0.0, 1.0, 3.0}) {
    const PlaneSection section = cut(solid, {0, 0, z}, {0, 0, 1});
    EXPECT_EQ(counts(section), (Counts{.loops = 1, .coplanar = z == 1.0 ? 0U : 1U}));
    EXPECT_NEAR(section_area(section), 2.0, 1e-14);
  }
  const PlaneSection top = cut(solid, {0, 0, 3}, {0, 0, 1});
  EXPECT_TRUE(top.coplanar[0].looks_along_normal);
  EXPECT_NEAR(section_area(top.coplanar[0].loops[0]), 2.0, 1e-14);
  EXPECT_THAT(top.messages, ::testing::ElementsAre(HasSubstr("lies in the plane")));
  const PlaneSection bottom = cut(solid, {0, 0, 0}, {0, 0, 1});
  EXPECT_FALSE(bottom.coplanar[0].looks_along_normal);
  EXPECT_NEAR(section_area(bottom.coplanar[0].loops[0]), 2.0, 1e-14);
  // An edge, a corner; through two edges; the hexagon through the middle of a cube.
  EXPECT_EQ(counts(cut(solid, {0, 0, 0}, {1, 1, 0})), (Counts{.touching = 1}));
  EXPECT_EQ(counts(cut(solid, {0, 0, 0}, {1, 1, 1})), (Counts{.isolated = 1}));
  EXPECT_EQ(counts(cut(solid, {1, 2, 3}, {1, 1, 1})), (Counts{.isolated = 1}));
  const PlaneSection diagonal = cut(solid, {0, 0, 0}, {2, -1, 0});
  EXPECT_EQ(counts(diagonal), (Counts{.loops = 1}));
  EXPECT_NEAR(section_area(diagonal), 3.0 * std::sqrt(5.0), 1e-14);
  const PlaneSection hexagon = cut(cube(1.0), {0.5, 0.5, 0.5}, {1, 1, 1});
  EXPECT_EQ(hexagon.loops[0].curve.pieces.size(), 6U);
  EXPECT_NEAR(section_area(hexagon), 0.75 * std::sqrt(3.0), 1e-14);
}

/// Faces of both kinds in one plane: below it the solid spans 0 < x < 2, above it 1 < x < 3.
TEST(PlaneSection, JoinsWhatIsBelowAndAbove) {
  Points<2> outline(2, 8);
  outline << 0, 2, 2, 3, 3, 1, 1, 0, 0, 0, 1, 1, 2, 2, 1, 1;
  const Boundary<3> solid = transform(orient(extrude(polygon(outline), Vector3(0, 0, 1))).boundary,
                                      rotation(Axis{{0, 0, 0}, {1, 0, 0}}, pi / 2));
  const PlaneSection section = cut(solid, {0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(counts(section), (Counts{.loops = 1, .coplanar = 2}));
  EXPECT_NEAR(section_area(section), 3.0, 1e-13);
  EXPECT_NEAR(section_area(cut(solid, {0, 0, 1}, {0, 0, -1})), 3.0, 1e-13);
  EXPECT_NEAR(section_area(cut(solid, {0, 0, 0.999}, {0, 0, 1})), 2.0, 1e-13);
}

/// A surface that is flat in a part of itself: the flat bottom of a hull.
TEST(PlaneSection, FindsFlatPartsOfSurfaces) {
  const std::vector<double> breaks{0.0, 1.0, 2.0, 3.0, 4.0};
  const KnotVector knots = KnotVector::clamped(2, breaks);
  Points<3> points(3, 36);
  const std::array<double, 6> greville{0.0, 0.5, 1.5, 2.5, 3.5, 4.0};
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      const bool flat = i < 4 && j < 4;
      points.col(i + 6 * j) << greville[static_cast<std::size_t>(i)], greville[static_cast<std::size_t>(j)],
          flat ? 0.0 : 0.3;
    }
  const NurbsSurface<3> sheet = NurbsSurface<3>::from_points(knots, knots, points);
  // The flat part is [0, 2] x [0, 2]; the solid lies above.
  const Boundary<3> open{{{"sheet", sheet, -1}}};
  const PlaneSection section = cut(open, {0, 0, 0}, {0, 0, 1});
  ASSERT_EQ(section.loops.size(), 1U);
  EXPECT_EQ(section.coplanar.size(), 4U);
  EXPECT_NEAR(section_area(section), 4.0, 1e-13);
  EXPECT_EQ(counts(cut(open, {0, 0, 1e-3}, {0, 0, 1})), (Counts{.chains = 1}));
}

TEST(PlaneSection, OfDrilledBlocks) {
  const Boundary<3> solid = clip(cube(1.0), CylinderTool{{0.5, 0.5, 0}, {0, 0, 1}, 0.2, KeptSide::outside});
  for (const double z : {0.0, 0.5, 1.0}) {
    const PlaneSection section = cut(solid, {0, 0, z}, {0, 0, 1});
    ASSERT_EQ(counts(section), (Counts{.loops = 2, .coplanar = z == 0.5 ? 0U : 1U}));
    EXPECT_NEAR(section_area(section), 1.0 - 0.04 * pi, 1e-13);
    EXPECT_NE(section.loops[0].is_hole, section.loops[1].is_hole);
  }
  EXPECT_NEAR(section_area(cut(solid, {0.5, 0, 0}, {1, 0, 0})), 0.6, 1e-13);
  const PlaneSection tangent = cut(solid, {0.7, 0, 0}, {1, 0, 0});
  EXPECT_EQ(counts(tangent), (Counts{.loops = 1, .touching = 1}));
  EXPECT_NEAR(section_area(tangent), 1.0, 1e-13);
  const double slope = std::hypot(0.1, 0.2);
  EXPECT_NEAR(section_area(cut(solid, {0.5, 0.5, 0.5}, {0.1, 0.2, 1})), (1.0 - 0.04 * pi) * std::hypot(1.0, slope),
              1e-13);
}

TEST(PlaneSection, NestsIslandsInHoles) {
  Boundary<3> solid = sphere(1.0);
  solid.patches.push_back({"void", sphere(0.8).patches[0].shape, 1});
  solid.patches.push_back({"core", sphere(0.5).patches[0].shape, 1});
  solid = orient(solid).boundary;
  const PlaneSection section = cut(solid, {0, 0, 0.1}, {0.1, 0.2, 1});
  ASSERT_EQ(section.loops.size(), 3U);
  int holes = 0;
  for (const SectionLoop& loop : section.loops) {
    if (!loop.is_hole) continue;
    ++holes;
    EXPECT_GT(section_area(section.loops[static_cast<std::size_t>(loop.parent)].curve), 2.0);
  }
  EXPECT_EQ(holes, 1);
}

TEST(PlaneSection, OfOpenShells) {
  Boundary<3> open = box({1, 2, 3});
  open.patches.pop_back();  // z_max
  const PlaneSection section = cut(open, {0.3, 0, 0}, {1, 0, 0});
  EXPECT_EQ(counts(section), (Counts{.chains = 1}));
  EXPECT_THAT(section.messages, ::testing::ElementsAre(HasSubstr("open curve")));
  EXPECT_EQ(counts(cut(open, {0, 0, 1}, {0, 0, 1})), (Counts{.loops = 1}));
  EXPECT_THAT(refusal([&] { section_region(section); }), HasSubstr("no loops"));
}

TEST(PlaneSection, BridgesGapsAndReportsThem) {
  Boundary<3> solid = cube(1.0);
  for (Patch<3>& patch : solid.patches)
    if (patch.name == "x_max") patch.shape = transform(patch.shape, translation<3>(Vector3(3e-7, 1e-7, 0)));
  const PlaneSection section = plane_section(solid, plane_frame({0, 0, 0.4}, {0, 0, 1}));
  ASSERT_EQ(counts(section), (Counts{.loops = 1}));
  EXPECT_NEAR(section.largest_gap, std::hypot(3e-7, 1e-7), 1e-12);
  EXPECT_THAT(section.messages, ::testing::ElementsAre(HasSubstr("were bridged")));
  EXPECT_NEAR(section_area(section), 1.0 + 3e-7, 1e-12);
  const std::vector<Patch<2>> patches = section_region(section).patches;
  ASSERT_EQ(patches.size(), 6U);
  for (std::size_t i = 0; i < patches.size(); ++i)
    EXPECT_EQ(evaluate(patches[i].shape, 1.0), evaluate(patches[(i + 1) % patches.size()].shape, 0.0));
  // Too wide to be bridged.
  for (Patch<3>& patch : solid.patches)
    if (patch.name == "x_max") patch.shape = transform(patch.shape, translation<3>(Vector3(1e-3, 0, 0)));
  EXPECT_EQ(plane_section(solid, plane_frame({0, 0, 0.4}, {0, 0, 1})).chains.size(), 2U);
  EXPECT_EQ(plane_section(solid, plane_frame({0, 0, 0.4}, {0, 0, 1}), {.gap_tolerance = 2e-3}).loops.size(), 1U);
}

TEST(PlaneSection, KeepsThinPlates) {
  for (const double thickness : {1e-3, 1e-7, 1e-9}) {
    const Boundary<3> plate = box({1, 2, thickness});
    const PlaneSection section = cut(plate, {0.6, 0, 0}, {1, 0.2, 0});
    ASSERT_EQ(counts(section), (Counts{.loops = 1})) << thickness;
    EXPECT_NEAR(section_area(section) / thickness, 2.0 * std::sqrt(1.04), 1e-6);
    const PlaneSection along = cut(plate, {0, 0, 0.5 * thickness}, {0, 0, 1});
    ASSERT_EQ(along.loops.size(), 1U);
    EXPECT_NEAR(section_area(along), 2.0, 1e-13);
  }
}

TEST(PlaneSection, OfExtractedSurfacesIsTheSame) {
  const ExtractedSurface whole = std::get<ExtractedSurface>(testing::extracted(torus(2.0, 0.5)).patches[0].shape);
  Boundary<3> ring{{{"ring", testing::cut_element(testing::cut_element(whole, 2, 0, 0.4), 9, 1, 0.7), 1}}};
  ring = orient(ring).boundary;
  Random random(5);
  for (int k = 0; k < 10; ++k) {
    const Vector3 normal = random_direction(random);
    const Point3 point(random.real(-1, 1), random.real(-1, 1), random.real(-0.4, 0.4));
    const PlaneSection expected = cut(torus(2.0, 0.5), point, normal);
    const PlaneSection section = cut(ring, point, normal);
    ASSERT_EQ(section.loops.size(), expected.loops.size());
    EXPECT_NEAR(section_area(section), section_area(expected), 1e-12);
  }
}

/// Cavalieri: the areas of slices add up to the volume, for solids of every kind and in any direction. Between the
/// heights of corners and tangents Gauss rules would converge fast; over all of them they do so slowly.
TEST(PlaneSection, SlicesAddUpToTheVolume) {
  const Boundary<3> ball = clip(sphere(1.0), CylinderTool{{0.3, 0.1, 0}, {0, 0, 1}, 0.35, KeptSide::outside});
  const double volume = testing::face_measures(ball).content;
  const PlaneCutter cutter(ball);
  // Along x: smooth between the tangents of the hole and of the ball.
  const auto slab = [&](double low, double high) {
    // x = middle + half sin(theta): square roots at the ends become analytic.
    const testing::GaussRule rule = testing::gauss_rule(24);
    double sum = 0.0;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double theta = pi * (rule.nodes[k] - 0.5);
      const double x = 0.5 * (low + high) + 0.5 * (high - low) * std::sin(theta);
      const PlaneSection section = cutter.section(plane_frame({x, 0, 0}, {1, 0, 0}));
      sum += rule.weights[k] * pi * 0.5 * (high - low) * std::cos(theta) * section_area(section);
    }
    return sum;
  };
  EXPECT_NEAR(slab(-1.0, -0.05) + slab(-0.05, 0.65) + slab(0.65, 1.0), volume, 1e-9 * volume);
}

/// Over random planes: all loops closed, areas continuous, and the loops' number stable where no tangency is near.
TEST(PlaneSection, IsSoundForRandomPlanes) {
  Random random(6);
  const std::vector<Boundary<3>> solids{
      clip(cube(1.0, {-0.5, -0.5, -0.5}), SphereTool{{0.2, 0.1, 0.3}, 0.4, KeptSide::outside}),
      clip(torus(0.7, 0.25), PlaneTool{{0, 0.1, 0}, {0.2, 1, 0.1}}), tilted_ring(),
      transform(cone(1.0, 0.4, 1.0), scaling<3>(Vector3(1, 0.5, 0.8)))};
  for (const Boundary<3>& solid : solids) {
    const PlaneCutter cutter(solid);
    for (int k = 0; k < 25; ++k) {
      const Vector3 normal = random_direction(random);
      const Point3 point(random.real(-0.4, 0.4), random.real(-0.4, 0.4), random.real(-0.4, 0.4));
      const PlaneSection section = cutter.section(plane_frame(point, normal));
      expect_sound(solid, section, cutter.size());
      EXPECT_TRUE(section.chains.empty());
      const double step = 1e-7;
      const double below = section_area(cutter.section(plane_frame(point - step * normal, normal)));
      const double above = section_area(cutter.section(plane_frame(point + step * normal, normal)));
      EXPECT_NEAR(below, above, 1e-2 * cutter.size() * std::sqrt(step));
      EXPECT_NEAR(section_area(section), 0.5 * (below + above), 1e-2 * cutter.size() * std::sqrt(step));
    }
  }
}

/// Where a waterline and a buttock meet, both say the same point.
TEST(PlaneSection, PerpendicularSectionsAgree) {
  const Boundary<3> hull = transform(sphere(1.0), scaling<3>(Vector3(5.0, 1.0, 0.7)));
  const PlaneCutter cutter(hull);
  const PlaneFrame waterplane = plane_frame({0, 0, -0.2}, {0, 0, 1});
  const PlaneFrame buttock = plane_frame({0, 0.35, 0}, {0, 1, 0});
  const auto meeting = [](const PlaneSection& section, const PlaneFrame& other) {
    std::vector<Point3> points;
    for (const SectionPiece& piece : section.loops.at(0).curve.pieces) {
      const auto height = [&](double t) {
        return (evaluate_jet(piece, t).place.point - other.origin).dot(other.normal);
      };
      for (int k = 0; k < 20; ++k) {
        double low = k / 20.0;
        double high = (k + 1) / 20.0;
        if ((height(low) > 0.0) == (height(high) > 0.0)) continue;
        const bool rises = height(high) > 0.0;
        for (int i = 0; i < 60; ++i) {
          const double middle = 0.5 * (low + high);
          ((height(middle) > 0.0) == rises ? high : low) = middle;
        }
        points.push_back(evaluate_jet(piece, low).place.point);
      }
    }
    std::ranges::sort(points, {}, [](const Point3& p) { return p.x(); });
    return points;
  };
  const std::vector<Point3> on_waterline = meeting(cutter.section(waterplane), buttock);
  const std::vector<Point3> on_buttock = meeting(cutter.section(buttock), waterplane);
  ASSERT_EQ(on_waterline.size(), 2U);
  std::vector<Point3> below;
  for (const Point3& point : on_buttock) below.push_back(point);
  ASSERT_EQ(below.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LE((on_waterline[i] - below[i]).norm(), 1e-13);
}

TEST(PlaneSection, RefusesNothing) {
  EXPECT_THAT(refusal([] { plane_section({}, plane_frame({0, 0, 0}, {0, 0, 1})); }), HasSubstr("no patches"));
}

}  // namespace
}  // namespace isorim::geometry
