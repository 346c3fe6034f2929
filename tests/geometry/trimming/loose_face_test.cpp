#include "geometry/trimming/loose_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"
#include "tests/geometry/refusals.h"
#include "tests/geometry/trimming/face_measures.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using testing::face_area;
using ::testing::HasSubstr;
using testing::refusal;

LoosePiece model(const NurbsCurve<3>& curve, int edge = -1) {
  return {std::nullopt, curve, edge};
}

LoosePiece parameter(const NurbsCurve<2>& curve, int edge = -1) {
  return {curve, std::nullopt, edge};
}

LoosePiece line3(const Point3& from, const Point3& to) {
  return model(line_segment<3>(from, to));
}

LoosePiece line2(const Point2& from, const Point2& to) {
  return parameter(line_segment<2>(from, to));
}

/// A circle about z, counter-clockwise seen from above, starting at the angle `from`.
NurbsCurve<3> circle_at(double height, double radius, double from = 0.0) {
  return transform(embed(circular_arc(radius, Point2::Zero(), from, from + 2.0 * pi)),
                   translation<3>(Vector3(0, 0, height)));
}

/// An arc of the great circle at longitude `angle`, between two latitudes.
NurbsCurve<3> meridian(double angle, double from, double to) {
  const NurbsCurve<3> arc =
      transform(embed(unit_arc(from, to)), rotation(Axis{Point3::Zero(), Vector3::UnitX()}, pi / 2));
  return transform(arc, rotation(Axis{}, angle));
}

NurbsSurface<3> surface_named(const Boundary<3>& boundary, const std::string& name) {
  const auto patch =
      std::find_if(boundary.patches.begin(), boundary.patches.end(), [&](const Patch<3>& p) { return p.name == name; });
  return surface_of(patch->shape);
}

NurbsSurface<3> unit_sphere() {
  return surface_named(sphere(1.0), "sphere");
}

NurbsSurface<3> tube(double height) {
  return surface_named(cylinder(1.0, height), "side");
}

/// The rectangle [0, a] x [0, b] in the plane z = 0, over itself.
NurbsSurface<3> plane(double a, double b) {
  Points<3> points(3, 4);
  points << 0, a, 0, a,  //
      0, 0, b, b,        //
      0, 0, 0, 0;
  return NurbsSurface<3>::from_points(KnotVector(1, {0, 0, a, a}), KnotVector(1, {0, 0, b, b}), points);
}

LooseLoop reversed(const LooseLoop& loop) {
  LooseLoop result = loop;
  std::reverse(result.pieces.begin(), result.pieces.end());
  for (LoosePiece& piece : result.pieces) {
    if (piece.pcurve) piece.pcurve = reverse(*piece.pcurve);
    if (piece.model_curve) piece.model_curve = reverse(*piece.model_curve);
  }
  return result;
}

LooseFace face_of(NurbsSurface<3> surface, std::vector<LooseLoop> loops, LoopSides sides = LoopSides::left) {
  return {std::move(surface), std::move(loops), sides, false};
}

/// Loops closed and inside is what TrimmedSurface checks; this is what its curves must be besides.
void expect_edges_match(const AssembledFace& face) {
  const auto* trimmed = std::get_if<TrimmedSurface>(&face.shape);
  if (trimmed == nullptr) {
    EXPECT_TRUE(face.edges.empty());
    return;
  }
  ASSERT_EQ(face.edges.size(), trimmed->loops().size());
  for (std::size_t i = 0; i < face.edges.size(); ++i)
    EXPECT_EQ(face.edges[i].size(), trimmed->loops()[i].curves.size());
}

double assembled_area(const LooseFace& face) {
  const AssembledFace assembled = assemble_face(face);
  expect_edges_match(assembled);
  return face_area(assembled.shape);
}

bool is_whole(const AssembledFace& face) {
  return std::holds_alternative<NurbsSurface<3>>(face.shape);
}

// Planes.

LooseLoop rectangle3(double x0, double y0, double x1, double y1) {
  const Point3 a(x0, y0, 0), b(x1, y0, 0), c(x1, y1, 0), d(x0, y1, 0);
  return {{line3(a, b), line3(b, c), line3(c, d), line3(d, a)}};
}

TEST(LooseFace, ModelCurvesOnAPlaneBecomeTheirAffineImages) {
  const NurbsCurve<3> circle = transform(embed(circle_curve(0.5)), translation<3>(Vector3(2, 1, 0)));
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {{{model(circle, 7)}}}));
  const TrimmedSurface& trimmed = std::get<TrimmedSurface>(face.shape);
  const NurbsCurve<2>& image = trimmed.loops().at(0).curves.at(0);
  EXPECT_EQ(image.knots(), circle.knots());
  EXPECT_EQ(image.weights(), circle.weights());
  EXPECT_LT((image.control_points() - circle.control_points().topRows<2>()).norm(), 1e-14);
  EXPECT_EQ(face.edges, (std::vector<std::vector<int>>{{7}}));
  EXPECT_EQ(face.repairs.inverted_pieces, 1);
  EXPECT_NEAR(face_area(face.shape), pi / 4, 1e-13);
}

TEST(LooseFace, HolesAreFoundWhateverTheOrientationOfTheLoops) {
  const LooseLoop outer = rectangle3(0.5, 0.5, 3.5, 2.5);
  const LooseLoop hole = rectangle3(1, 1, 2, 2);
  const LooseLoop island = rectangle3(1.25, 1.25, 1.75, 1.75);
  for (int turns = 0; turns < 4; ++turns)
    for (const LoopSides sides : {LoopSides::outer_first, LoopSides::nested, LoopSides::left}) {
      const LooseLoop first = turns % 2 == 0 ? outer : reversed(outer);
      const LooseLoop second = turns / 2 == 0 ? reversed(hole) : hole;
      EXPECT_NEAR(assembled_area(face_of(plane(4, 3), {first, second}, sides)), 5.0, 1e-13);
      EXPECT_NEAR(assembled_area(face_of(plane(4, 3), {island, second, first}, LoopSides::nested)), 5.25, 1e-13);
    }
}

TEST(LooseFace, TheNaturalBoundaryIsTheOuterLoop) {
  LooseFace face = face_of(plane(4, 3), {rectangle3(1, 1, 2, 2)}, LoopSides::outer_first);
  face.natural_outer_boundary = true;
  EXPECT_NEAR(assembled_area(face), 11.0, 1e-13);
}

TEST(LooseFace, HolesMayTouchTheOuterLoopAndEachOther) {
  const std::vector<LooseLoop> loops{rectangle3(0, 0, 4, 3), rectangle3(0, 1, 1, 2), rectangle3(1, 1, 2, 2)};
  EXPECT_NEAR(assembled_area(face_of(plane(4, 3), loops, LoopSides::outer_first)), 10.0, 1e-13);
}

TEST(LooseFace, PiecesInDisorderAreChained) {
  LooseLoop loop = rectangle3(1, 1, 3, 2);
  std::swap(loop.pieces[1], loop.pieces[2]);
  loop.pieces[3].model_curve = reverse(*loop.pieces[3].model_curve);
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {loop}));
  EXPECT_NEAR(face_area(face.shape), 2.0, 1e-13);
  EXPECT_EQ(face.repairs.notes.size(), 2u);
  EXPECT_EQ(face.repairs.reversed_loops, 0);
}

TEST(LooseFace, AFirstPieceThatRunsAgainstTheOthersDoesNotTurnTheLoop) {
  LooseLoop loop = rectangle3(1, 1, 3, 2);
  loop.pieces[0].model_curve = reverse(*loop.pieces[0].model_curve);
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {loop}));
  EXPECT_NEAR(face_area(face.shape), 2.0, 1e-13);
  EXPECT_EQ(face.repairs.reversed_loops, 0);
}

TEST(LooseFace, LoopsAroundTheDomainGiveTheWholeSurface) {
  EXPECT_TRUE(is_whole(assemble_face(face_of(plane(4, 3), {rectangle3(0, 0, 4, 3)}))));
  EXPECT_TRUE(is_whole(assemble_face({plane(4, 3), {}, LoopSides::left, false})));
  EXPECT_FALSE(is_whole(assemble_face(face_of(plane(4, 3), {rectangle3(0, 0, 4, 3 - 1e-9)}))));
}

TEST(LooseFace, GivenParameterCurvesKeepTheirBits) {
  const NurbsCurve<2> circle = circle_curve(0.7, Point2(2.1, 1.3));
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {{{parameter(circle)}}}));
  const NurbsCurve<2>& kept = std::get<TrimmedSurface>(face.shape).loops().at(0).curves.at(0);
  EXPECT_EQ(kept.homogeneous(), circle.homogeneous());
  EXPECT_EQ(kept.knots(), circle.knots());
  EXPECT_EQ(face.repairs.inverted_pieces, 0);
  EXPECT_EQ(face.repairs.shifted_curves, 0);
}

TEST(LooseFace, CurvesBeyondTheDomainAreClipped) {
  const double beyond = 2e-4;
  const LooseLoop loop{{line2({1, -beyond}, {3, -beyond}), line2({3, -beyond}, {3, 2}), line2({3, 2}, {1, 2}),
                        line2({1, 2}, {1, -beyond})}};
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {loop}));
  EXPECT_NEAR(face_area(face.shape), 4.0, 1e-13);
  EXPECT_EQ(face.repairs.shifted_curves, 3);
  FaceOptions generous;
  generous.largest_deviation = 1.0;
  // Half a disc of radius 1 about (2, 0.6) reaches down to -0.4.
  const LooseLoop low{{line2({3, 0.6}, {1, 0.6}), parameter(circular_arc(1.0, Point2(2, 0.6), pi, 2 * pi))}};
  const double segment = std::acos(0.6) - 0.6 * 0.8;
  EXPECT_NEAR(face_area(assemble_face(face_of(plane(4, 3), {low}), generous).shape), pi / 2 - segment, 1e-12);
}

TEST(LooseFace, AParameterCurveFarFromItsModelCurveIsComputedAnew) {
  LooseLoop loop = rectangle3(1, 1, 3, 2);
  loop.pieces[0].pcurve = line_segment<2>(Point2(1, 0.5), Point2(3, 0.5));
  loop.pieces[1].pcurve = line_segment<2>(Point2(3, 1), Point2(3 + 1e-5, 2));
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {loop}));
  EXPECT_NEAR(face_area(face.shape), 2.0 + 0.5e-5, 1e-9);
  EXPECT_EQ(face.repairs.inverted_pieces, 3);
  EXPECT_NEAR(face.repairs.largest_disagreement, 0.5, 1e-12);
  ASSERT_EQ(face.repairs.notes.size(), 1u);
  EXPECT_THAT(face.repairs.notes[0], HasSubstr("loop 1, piece 1: the parameter curve lies 0.5 off the curve in space"));
}

TEST(LooseFace, SmallGapsAreBridgedAndReported) {
  const double gap = 1e-4;
  const LooseLoop loop{{line3({1, 1, 0}, {3, 1, 0}), line3({3, 1 + gap, 0}, {3, 2, 0}), line3({3, 2, 0}, {1, 2, 0}),
                        line3({1, 2, 0}, {1, 1, 0})}};
  const AssembledFace face = assemble_face(face_of(plane(4, 3), {loop}));
  EXPECT_NEAR(face_area(face.shape), 2.0, 1e-12);
  EXPECT_NEAR(face.repairs.largest_bridge, gap, 1e-15);
}

TEST(LooseFace, PointsAmongThePiecesAreLeftOut) {
  LooseLoop loop = rectangle3(1, 1, 3, 2);
  const Points<3> point = Point3(3, 1, 0).replicate(1, 2);
  loop.pieces.insert(loop.pieces.begin() + 1, model(NurbsCurve<3>::from_points(KnotVector::bezier(1), point)));
  EXPECT_NEAR(assembled_area(face_of(plane(4, 3), {loop})), 2.0, 1e-13);
}

TEST(LooseFace, ALoopOfSeveralClosedChainsIsTakenApart) {
  LooseLoop loop = rectangle3(0.5, 0.5, 3.5, 2.5);
  for (const LoosePiece& piece : reversed(rectangle3(1, 1, 2, 2)).pieces) loop.pieces.push_back(piece);
  EXPECT_NEAR(assembled_area(face_of(plane(4, 3), {loop})), 5.0, 1e-13);
}

// Cylinders.

TEST(LooseFace, TwoCirclesBoundABandOfACylinder) {
  for (const double start : {0.0, 0.3, 2.0, pi})
    for (const LoopSides sides : {LoopSides::left, LoopSides::outer_first, LoopSides::nested}) {
      const LooseLoop low{{model(circle_at(0.5, 1.0, start))}};
      const LooseLoop high = reversed({{model(circle_at(1.5, 1.0, -start))}});
      EXPECT_NEAR(assembled_area(face_of(tube(2.0), {low, high}, sides)), 2 * pi, 1e-12);
      EXPECT_NEAR(assembled_area(face_of(tube(2.0), {high, low}, sides)), 2 * pi, 1e-12);
      // Both the wrong way round, or only one where the file does not promise a side.
      EXPECT_NEAR(assembled_area(face_of(tube(2.0), {reversed(low), reversed(high)}, sides)), 2 * pi, 1e-12);
      if (sides != LoopSides::left) {
        EXPECT_NEAR(assembled_area(face_of(tube(2.0), {low, reversed(high)}, sides)), 2 * pi, 1e-12);
      }
    }
}

TEST(LooseFace, CirclesAtTheEndsOfACylinderGiveTheWholeSurface) {
  const LooseLoop low{{model(circle_at(0.0, 1.0, 0.4))}};
  const LooseLoop high = reversed({{model(circle_at(2.0, 1.0, 0.0))}});
  const AssembledFace face = assemble_face(face_of(tube(2.0), {low, high}));
  EXPECT_TRUE(is_whole(face));
  EXPECT_EQ(face.repairs.reversed_loops, 0);
}

TEST(LooseFace, SeamsUsedTwiceCloseALoop) {
  const NurbsCurve<3> up = line_segment<3>(Point3(1, 0, 0.5), Point3(1, 0, 1.5));
  const LooseLoop loop{
      {model(circle_at(0.5, 1.0), 1), model(up, 2), model(reverse(circle_at(1.5, 1.0)), 3), model(reverse(up), 2)}};
  for (std::size_t first = 0; first < 4; ++first) {
    LooseLoop turned = loop;
    std::rotate(turned.pieces.begin(), turned.pieces.begin() + static_cast<std::ptrdiff_t>(first), turned.pieces.end());
    const AssembledFace face = assemble_face(face_of(tube(2.0), {turned}));
    EXPECT_NEAR(face_area(face.shape), 2 * pi, 1e-12);
    ASSERT_EQ(face.edges.size(), 1u);
    std::vector<int> edges = face.edges[0];
    std::sort(edges.begin(), edges.end());
    EXPECT_EQ(edges, (std::vector<int>{1, 2, 2, 3}));
  }
}

TEST(LooseFace, ACylinderCutObliquely) {
  // z = 2 + x / 2 on the unit cylinder.
  NurbsCurve<3> rim = embed(circle_curve(1.0));
  AffineMap<3> shear;
  shear.linear(2, 0) = 0.5;
  shear.translation.z() = 2.0;
  rim = transform(rim, shear);
  for (const double start : {0.0, 1.0}) {
    const LooseLoop low{{model(circle_at(0.0, 1.0, start))}};
    const AssembledFace face = assemble_face(face_of(tube(3.0), {low, reversed({{model(rim)}})}));
    EXPECT_NEAR(face_area(face.shape), 4 * pi, 1e-11);
    EXPECT_LT(face.repairs.largest_deviation, 1e-14);
    EXPECT_TRUE(face.repairs.notes.empty());
  }
}

/// A polygon through points of the unit cylinder where y = r cos t, z = 1 + r sin t, turned about the axis by `angle`.
/// Its sides lie inside the cylinder by up to 2e-4.
NurbsCurve<3> hole_in_cylinder(double angle, double radius) {
  const int n = 48;
  Points<3> points(3, n + 1);
  for (int i = 0; i <= n; ++i) {
    const double t = 2 * pi * (i % n) / n;
    const double y = radius * std::cos(t);
    points.col(i) = rotation(Axis{}, angle)(Point3(std::sqrt(1 - y * y), y, 1 + radius * std::sin(t)));
  }
  return polyline<3>(points);
}

TEST(LooseFace, AHoleAcrossTheSeam) {
  const LooseLoop low{{model(circle_at(0.0, 1.0))}};
  const LooseLoop high = reversed({{model(circle_at(2.0, 1.0))}});
  const NurbsCurve<3> up = line_segment<3>(Point3(1, 0, 0), Point3(1, 0, 2));
  const LooseLoop with_seam{
      {model(circle_at(0.0, 1.0)), model(up), model(reverse(circle_at(2.0, 1.0))), model(reverse(up))}};
  // The same hole away from the seam is the reference: the surface looks the same everywhere but for its parameters.
  const LooseLoop away = reversed({{model(hole_in_cylinder(0.7, 0.3))}});
  const double reference = assembled_area(face_of(tube(2.0), {low, high, away}));
  EXPECT_NEAR(reference, 4 * pi - pi * 0.09 * 1.0115, 2e-3);
  for (const double angle : {0.0, 0.1, -0.25, pi / 2}) {
    const LooseLoop hole = reversed({{model(hole_in_cylinder(angle, 0.3))}});
    for (const LoopSides sides : {LoopSides::left, LoopSides::outer_first}) {
      EXPECT_NEAR(assembled_area(face_of(tube(2.0), {low, high, hole}, sides)), reference, 1e-11) << angle;
      EXPECT_NEAR(assembled_area(face_of(tube(2.0), {with_seam, hole}, sides)), reference, 1e-11) << angle;
    }
  }
}

TEST(LooseFace, APatchAcrossTheSeam) {
  // A quarter of the tube between two heights, its middle on the seam.
  const auto arc = [](double height) {
    return transform(embed(unit_arc(-pi / 4, pi / 4)), translation<3>(Vector3(0, 0, height)));
  };
  const auto corner = [](double angle, double height) { return Point3(std::cos(angle), std::sin(angle), height); };
  const LooseLoop loop{{model(arc(0.5)), line3(corner(pi / 4, 0.5), corner(pi / 4, 1.5)), model(reverse(arc(1.5))),
                        line3(corner(-pi / 4, 1.5), corner(-pi / 4, 0.5))}};
  for (const LoopSides sides : {LoopSides::left, LoopSides::outer_first, LoopSides::nested}) {
    EXPECT_NEAR(assembled_area(face_of(tube(2.0), {loop}, sides)), pi / 2, 1e-12);
    EXPECT_NEAR(assembled_area(face_of(tube(2.0), {reversed(loop)}, sides)), pi / 2, 1e-12);
  }
}

TEST(LooseFace, ParameterCurvesOnAnotherPeriodAreMovedBack) {
  const LooseLoop loop{{line2({2.25, 0.25}, {2.5, 0.25}), line2({2.5, 0.25}, {2.5, 0.75}),
                        line2({-0.5, 0.75}, {-0.75, 0.75}), line2({0.25, 0.75}, {0.25, 0.25})}};
  const AssembledFace face = assemble_face(face_of(tube(2.0), {loop}));
  EXPECT_NEAR(face_area(face.shape), pi / 2, 1e-12);
  EXPECT_EQ(face.repairs.shifted_curves, 3);
}

TEST(LooseFace, ALoopWithoutItsSeamIsClosedAlongIt) {
  const LooseLoop loop{{model(circle_at(0.5, 1.0)), model(reverse(circle_at(1.5, 1.0)))}};
  EXPECT_NEAR(assembled_area(face_of(tube(2.0), {loop})), 2 * pi, 1e-12);
}

// Poles.

TEST(LooseFace, ACircleOnASphereKeepsWhatLiesOnItsLeft) {
  for (const double start : {0.0, 0.4, pi}) {
    const LooseLoop circle{{model(circle_at(0.5, std::sqrt(0.75), start))}};
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {circle})), pi, 1e-11);
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {reversed(circle)})), 3 * pi, 1e-11);
  }
}

TEST(LooseFace, ASmallCircleOnASphere) {
  // About a point of the equator at several longitudes, the seam among them; a cap of height 0.1.
  const double radius = std::sqrt(1 - 0.81);
  for (const double angle : {0.0, 0.2, pi / 2, 4.0}) {
    NurbsCurve<3> circle = transform(embed(circle_curve(radius)), translation<3>(Vector3(0, 0, 0.9)));
    circle = transform(circle, rotation(Axis{Point3::Zero(), Vector3::UnitY()}, pi / 2));
    circle = transform(circle, rotation(Axis{}, angle));
    const LooseLoop loop{{model(circle)}};
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {loop})), 0.2 * pi, 1e-11) << angle;
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {reversed(loop)})), 3.8 * pi, 1e-11) << angle;
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {reversed(loop)}, LoopSides::outer_first)), 0.2 * pi, 1e-11);
  }
}

TEST(LooseFace, AnOctantOfASphereIsOpenAtThePole) {
  for (const double angle : {0.0, 0.3, 1.5 * pi, 5.5}) {
    const NurbsCurve<3> equator = transform(embed(unit_arc(0, pi / 2)), rotation(Axis{}, angle));
    const LooseLoop loop{
        {model(equator), model(meridian(angle + pi / 2, 0, pi / 2)), model(meridian(angle, pi / 2, 0))}};
    for (const LoopSides sides : {LoopSides::left, LoopSides::outer_first, LoopSides::nested}) {
      EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {loop}, sides)), pi / 2, 1e-11) << angle;
    }
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {reversed(loop)})), 3.5 * pi, 1e-11) << angle;
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {reversed(loop)}, LoopSides::outer_first)), pi / 2, 1e-11);
  }
}

TEST(LooseFace, ALuneMayBeWiderThanHalfTheSphere) {
  for (const double width : {0.5, 2.0, 4.0, 6.0})
    for (const double angle : {0.0, 0.3, 5.0}) {
      const LooseLoop loop{{model(meridian(angle + width, -pi / 2, pi / 2)), model(meridian(angle, pi / 2, -pi / 2))}};
      EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {loop})), 2 * width, 1e-10) << width << ' ' << angle;
    }
}

TEST(LooseFace, TheSeamOfASphereUsedTwiceGivesTheWholeSphere) {
  const LooseLoop curves{{model(meridian(0, -pi / 2, pi / 2)), model(meridian(0, pi / 2, -pi / 2))}};
  EXPECT_TRUE(is_whole(assemble_face(face_of(unit_sphere(), {curves}))));
  EXPECT_TRUE(is_whole(assemble_face(face_of(unit_sphere(), {curves}, LoopSides::outer_first))));
  const LooseLoop parameters{{line2({1, 0}, {1, 1}), line2({0, 1}, {0, 0})}};
  EXPECT_TRUE(is_whole(assemble_face(face_of(unit_sphere(), {parameters}, LoopSides::outer_first))));
  const LooseLoop short_of_poles{{line2({1, 1e-8}, {1, 1 - 1e-8}), line2({0, 1 - 1e-8}, {0, 1e-8})}};
  EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {short_of_poles}, LoopSides::outer_first)), 4 * pi, 1e-11);
}

TEST(LooseFace, ACircleThroughBothPoles) {
  for (const double angle : {0.0, 0.4, 3.0}) {
    // Starts on the equator and runs through both poles.
    const NurbsCurve<3> great =
        transform(transform(embed(circle_curve(1.0)), rotation(Axis{Point3::Zero(), Vector3::UnitX()}, pi / 2)),
                  rotation(Axis{}, angle));
    const AssembledFace face = assemble_face(face_of(unit_sphere(), {{{model(great)}}}));
    EXPECT_NEAR(face_area(face.shape), 2 * pi, 1e-10);
    // One half of it, not the other: its middle lies on the left.
    const AssembledFace other = assemble_face(face_of(unit_sphere(), {reversed({{model(great)}})}));
    EXPECT_NEAR(face_area(other.shape), 2 * pi, 1e-10);
  }
}

TEST(LooseFace, ACurveThatIsNoParameterLineRunsThroughAPole) {
  // The circle x^2 + y^2 + z^2 = 1, z = 1 - x: through the pole and (1, 0, 0), radius sqrt(1/2); its cap is
  // 2 pi (1 - sqrt(1/2)) large.
  NurbsCurve<3> circle = transform(embed(circle_curve(std::sqrt(0.5))), translation<3>(Vector3(0, 0, std::sqrt(0.5))));
  circle = transform(circle, rotation(Axis{Point3::Zero(), Vector3::UnitY()}, pi / 4));
  for (const double angle : {0.0, 0.5, pi / 2, 3.0}) {
    const LooseLoop loop{{model(transform(circle, rotation(Axis{}, angle)))}};
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {loop})), 2 * pi * (1 - std::sqrt(0.5)), 1e-10) << angle;
    EXPECT_NEAR(assembled_area(face_of(unit_sphere(), {reversed(loop)})), 2 * pi * (1 + std::sqrt(0.5)), 1e-10);
  }
}

TEST(LooseFace, AConeIsKeptTowardsItsApex) {
  const NurbsSurface<3> side = surface_named(cone(1.0, 0.0, 1.0), "side");
  const LooseLoop circle{{model(circle_at(0.5, 0.5, 0.7))}};
  const double expected = pi * 0.5 * std::sqrt(0.5);
  for (const LoopSides sides : {LoopSides::left, LoopSides::outer_first, LoopSides::nested}) {
    EXPECT_NEAR(assembled_area(face_of(side, {circle}, sides)), expected, 1e-11);
    EXPECT_NEAR(assembled_area(face_of(side, {reversed(circle)}, sides)), expected, 1e-11);
  }
  const LooseLoop base{{model(circle_at(0.0, 1.0))}};
  EXPECT_TRUE(is_whole(assemble_face(face_of(side, {base}))));
  EXPECT_NEAR(assembled_area(face_of(side, {base, reversed(circle)})), 3 * expected, 1e-11);
}

TEST(LooseFace, ATriangleWithoutItsDegenerateSide) {
  // A bilinear patch with v = 0 drawn to one point.
  Points<3> points(3, 4);
  points << 0, 0, 1, 0,  //
      0, 0, 0, 1,        //
      0, 0, 0, 0;
  const NurbsSurface<3> triangle = NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), points);
  const Point3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const LooseLoop loop{{line3(a, b), line3(b, c), line3(c, a)}};
  for (const LoopSides sides : {LoopSides::left, LoopSides::outer_first}) {
    EXPECT_TRUE(is_whole(assemble_face(face_of(triangle, {loop}, sides))));
    EXPECT_TRUE(is_whole(assemble_face(face_of(triangle, {reversed(loop)}, sides))));
  }
  const LooseLoop half{{line3(a, b), line3(b, 0.5 * (b + c)), line3(0.5 * (b + c), a)}};
  EXPECT_NEAR(assembled_area(face_of(triangle, {half})), 0.25, 1e-13);
  const LooseLoop other{{line3(a, 0.5 * (b + c)), line3(0.5 * (b + c), c), line3(c, a)}};
  EXPECT_NEAR(assembled_area(face_of(triangle, {other})), 0.25, 1e-13);
}

TEST(LooseFace, ASquareTubeWithItsSeamOnACorner) {
  Points<3> corners(3, 5);
  corners << 0, 2, 2, 0, 0,  //
      0, 0, 2, 2, 0,         //
      0, 0, 0, 0, 0;
  const NurbsCurve<3> square = polyline<3>(corners);
  const NurbsSurface<3> side = extrude(square, Vector3(0, 0, 3));
  const auto at_height = [&](double z) { return transform(square, translation<3>(Vector3(0, 0, z))); };
  const NurbsCurve<3> seam = line_segment<3>(Point3(0, 0, 1), Point3(0, 0, 2));
  const LooseLoop with_seam{{model(seam), model(reverse(at_height(2))), model(reverse(seam)), model(at_height(1))}};
  EXPECT_NEAR(assembled_area(face_of(side, {with_seam})), 8.0, 1e-12);
  EXPECT_NEAR(assembled_area(face_of(side, {{{model(at_height(1))}}, {{model(reverse(at_height(2)))}}})), 8.0, 1e-12);
  // A window around the corner of the seam, 1 x 1 on either side of it.
  const Point3 l0(0, 1, 1), l1(0, 1, 2), r0(1, 0, 1), r1(1, 0, 2), c0(0, 0, 1), c1(0, 0, 2);
  const LooseLoop window{{line3(l0, c0), line3(c0, r0), line3(r0, r1), line3(r1, c1), line3(c1, l1), line3(l1, l0)}};
  EXPECT_NEAR(assembled_area(face_of(side, {window})), 2.0, 1e-12);
  EXPECT_NEAR(
      assembled_area(face_of(side, {{{model(at_height(0))}}, {{model(reverse(at_height(3)))}}, reversed(window)})),
      22.0, 1e-12);
}

// Tori.

NurbsSurface<3> unit_torus() {
  return surface_named(torus(1.0, 0.5), "torus");
}

/// About the tube at a longitude, counter-clockwise seen along the direction of rising longitude.
NurbsCurve<3> tube_circle(double longitude, double from = 0.0) {
  return transform(transform(embed(circular_arc(0.5, Point2(1, 0), from, from + 2 * pi)),
                             rotation(Axis{Point3::Zero(), Vector3::UnitX()}, pi / 2)),
                   rotation(Axis{}, longitude));
}

TEST(LooseFace, TheSeamsOfATorusGiveTheWholeTorus) {
  const NurbsCurve<3> around = circle_at(0.0, 1.5);
  const NurbsCurve<3> tube_seam = tube_circle(0.0);
  const LooseLoop loop{{model(around), model(tube_seam), model(reverse(around)), model(reverse(tube_seam))}};
  EXPECT_TRUE(is_whole(assemble_face(face_of(unit_torus(), {loop}))));
  EXPECT_TRUE(is_whole(assemble_face(face_of(unit_torus(), {loop}, LoopSides::outer_first))));
}

TEST(LooseFace, TheSidesOfATorusMayComeInTheWrongOrder) {
  // All four corners are one point in space, so only the parameters tell; bits tell the sides apart.
  const double end = 1 - 1e-10;
  const LooseLoop loop{
      {line2({end, 0}, {end, 1}), line2({0, 0}, {end, 0}), line2({0, 1}, {0, 0}), line2({end, 1}, {0, 1})}};
  const AssembledFace face = assemble_face(face_of(unit_torus(), {loop}, LoopSides::outer_first));
  const TrimmedSurface& trimmed = std::get<TrimmedSurface>(face.shape);
  ASSERT_EQ(trimmed.loops().at(0).curves.size(), 4u);
  for (const LoosePiece& piece : loop.pieces)
    EXPECT_EQ(std::count_if(trimmed.loops()[0].curves.begin(), trimmed.loops()[0].curves.end(),
                            [&](const NurbsCurve<2>& c) { return c.homogeneous() == piece.pcurve->homogeneous(); }),
              1);
  EXPECT_EQ(face.repairs.shifted_curves, 0);
  EXPECT_EQ(face.repairs.reversed_loops, 0);
}

TEST(LooseFace, BandsOfATorus) {
  // The upper half, bounded by the outer and the inner equator; and the outer and the inner half.
  const LooseLoop outer{{model(circle_at(0.0, 1.5, 0.3))}};
  const LooseLoop inner{{model(circle_at(0.0, 0.5, 1.0))}};
  const double whole = 2 * pi * pi;
  EXPECT_NEAR(assembled_area(face_of(unit_torus(), {outer, reversed(inner)})), whole / 2, 1e-11);
  EXPECT_NEAR(assembled_area(face_of(unit_torus(), {inner, reversed(outer)})), whole / 2, 1e-11);
  const LooseLoop top{{model(circle_at(0.5, 1.0))}};
  const LooseLoop bottom{{model(circle_at(-0.5, 1.0, 2.0))}};
  EXPECT_NEAR(assembled_area(face_of(unit_torus(), {bottom, reversed(top)})), whole / 2 + pi, 1e-11);
  EXPECT_NEAR(assembled_area(face_of(unit_torus(), {top, reversed(bottom)})), whole / 2 - pi, 1e-11);
}

TEST(LooseFace, SectorsOfATorus) {
  // Increasing longitude is on the right of a circle that turns with the tube.
  const double whole = 2 * pi * pi;
  for (const double from : {0.0, 1.0, 6.0}) {
    const LooseLoop start = reversed({{model(tube_circle(from, 0.4))}});
    const LooseLoop end{{model(tube_circle(from + 2.0, 1.4))}};
    EXPECT_NEAR(assembled_area(face_of(unit_torus(), {start, end})), whole * 2.0 / (2 * pi), 1e-11) << from;
    EXPECT_NEAR(assembled_area(face_of(unit_torus(), {reversed(start), reversed(end)})), whole * (1 - 2.0 / (2 * pi)),
                1e-11);
  }
}

// Refusals.

TEST(LooseFace, RefusesWhatIsNoFace) {
  const auto refused = [](LooseFace face) { return refusal([&] { assemble_face(face); }); };
  EXPECT_THAT(refused(face_of(plane(4, 3), {{{LoosePiece{}}}})),
              HasSubstr("loop 1, piece 1 has neither a parameter curve nor a curve in space"));
  EXPECT_THAT(refused(face_of(plane(4, 3), {LooseLoop{}})), HasSubstr("loop 1 has no piece"));

  LooseLoop open = rectangle3(1, 1, 3, 2);
  open.pieces.pop_back();
  EXPECT_THAT(refused(face_of(plane(4, 3), {rectangle3(0, 0, 4, 3), open})),
              HasSubstr("loop 2: piece 3 ends at (1, 2, 0), piece 1 starts at (1, 1, 0), 1 away"));

  LooseLoop off = rectangle3(1, 1, 3, 2);
  off.pieces[1] = line3({3, 1, 0}, {3, 2, 0.25});
  EXPECT_THAT(refused(face_of(plane(4, 3), {off})),
              HasSubstr("loop 1, piece 2: the curve in space lies 0.25 off the surface at (3, 2, 0.25)"));

  const LooseLoop outside{{line2({1, -1}, {3, -1}), line2({3, -1}, {3, 2}), line2({3, 2}, {1, -1})}};
  EXPECT_THAT(refused(face_of(plane(4, 3), {outside})),
              HasSubstr("loop 1, piece 1: the parameter curve leaves the surface by 1"));

  const LooseLoop there_and_back{{line3({1, 1, 0}, {3, 1, 0}), line3({3, 1, 0}, {1, 1, 0})}};
  EXPECT_THAT(refused(face_of(plane(4, 3), {there_and_back})), HasSubstr("bound no part of the surface"));
}

}  // namespace
}  // namespace isorim::geometry
