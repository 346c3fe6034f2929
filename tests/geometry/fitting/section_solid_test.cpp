#include "geometry/fitting/section_solid.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/measures.h"

namespace isorim::geometry {
namespace {

using testing::measures;
constexpr double pi = std::numbers::pi;

NurbsCurve<3> circle_at(double radius, double height, const Point2& centre = Point2::Zero()) {
  return transform(embed(circle_curve(radius, centre)), translation<3>({0.0, 0.0, height}));
}

/// A periodic cubic near an ellipse, with knots of its own.
NurbsCurve<3> wavy(int count, double height) {
  std::vector<double> breakpoints;
  for (int i = 0; i <= count; ++i) breakpoints.push_back(i);
  Points<3> points(3, count + 3);
  for (int i = 0; i < points.cols(); ++i) {
    const double angle = 2.0 * pi * (i % count) / count;
    points.col(i) << 2.0 * std::cos(angle), std::sin(angle), height;
  }
  return NurbsCurve<3>::from_points(KnotVector::periodic(3, breakpoints), points);
}

double volume(const Body& body) {
  EXPECT_TRUE(orient(body.boundary).topology.closed);
  return measures(body.boundary).content;
}

// --- Uniformisation -------------------------------------------------------------------------------------------

double largest_difference(const NurbsCurve<3>& a, const NurbsCurve<3>& b) {
  double largest = 0.0;
  const NurbsCurve<3> unit = reparametrise(a, Interval{0.0, 1.0});
  for (int k = 0; k <= 500; ++k) {
    largest = std::max(largest, (evaluate(unit, k / 500.0) - evaluate(b, k / 500.0)).norm());
  }
  return largest;
}

TEST(Uniformise, MergingIsExact) {
  const std::vector<NurbsCurve<3>> given{wavy(8, 0.0), wavy(11, 1.0), circle_at(1.0, 2.0)};
  const UniformSections uniform = uniformise(given);
  for (std::size_t k = 0; k < given.size(); ++k) {
    EXPECT_EQ(uniform.sections[k].knots(), uniform.sections[0].knots());
    EXPECT_LT(largest_difference(given[k], uniform.sections[k]), 1e-13);
  }
  // 7 and 10 inner knots of multiplicity 1 and, of the circle raised to degree 3, three of 3; two of 1/4, 1/2, 3/4 are
  // among the others.
  EXPECT_EQ(uniform.control_points, 4 + 7 + 10 + 9 - 3);
  EXPECT_EQ(uniform.removed, 0);
  EXPECT_EQ(uniform.error_bound, 0.0);
}

TEST(Uniformise, InsertAndRemoveKeepsWithinTheTolerance) {
  std::vector<NurbsCurve<3>> given;
  for (const int count : {17, 19, 23, 29}) given.push_back(wavy(count, 0.1 * count));
  const UniformSections merged = uniformise(given);
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const UniformSections uniform =
        uniformise(given, {.method = Uniformisation::insert_and_remove, .inserted_knots = 25, .tolerance = tolerance});
    double moved = 0.0;
    for (std::size_t k = 0; k < given.size(); ++k) {
      EXPECT_EQ(uniform.sections[k].knots(), uniform.sections[0].knots());
      moved = std::max(moved, largest_difference(given[k], uniform.sections[k]));
    }
    EXPECT_LE(moved, uniform.error_bound + 1e-12);
    EXPECT_LE(uniform.error_bound, tolerance);
    if (tolerance == 1e-2) {
      EXPECT_LT(uniform.control_points, merged.control_points / 2);
      EXPECT_GT(uniform.removed, 40);
      EXPECT_GT(moved, 1e-5);
    }
  }
}

TEST(Uniformise, WithoutToleranceOnlyWhatCostsNothingGoes) {
  // A curve refined beyond need loses what it does not need.
  const std::vector<NurbsCurve<3>> given{refine_knots(clamp(wavy(8, 0.0)), std::vector{0.7, 1.9, 3.3})};
  const UniformSections uniform = uniformise(given, {.method = Uniformisation::insert_and_remove, .inserted_knots = 4});
  EXPECT_EQ(uniform.removed, 3);
  EXPECT_EQ(uniform.control_points, 11 + 4);
  EXPECT_LT(largest_difference(given[0], uniform.sections[0]), 1e-12);
}

TEST(Uniformise, RefusesBadOptions) {
  const std::vector<NurbsCurve<3>> given{wavy(8, 0.0)};
  const UniformisationOptions none{.method = Uniformisation::insert_and_remove, .inserted_knots = 0};
  EXPECT_GEOMETRY_ERROR(uniformise(given, none), "0 knots to insert");
  const UniformisationOptions negative{.tolerance = -1.0};
  EXPECT_GEOMETRY_ERROR(uniformise(given, negative), "tolerance is -1");
}

// --- Bodies ---------------------------------------------------------------------------------------------------

TEST(BodyOfSections, ACylinderOfCirclesIsExact) {
  std::vector<BodySection> sections;
  for (const double height : {0.0, 0.5, 1.5, 3.0}) {
    // Started and directed each in its own way.
    NurbsCurve<3> circle = start_at(circle_at(2.0, height), 0.25 * std::fmod(2.0 * height, 4.0));
    if (height == 1.5) circle = reverse(circle);
    sections.push_back({"", {circle}});
  }
  const Body body = body_of_sections(sections);
  ASSERT_EQ(body.boundary.patches.front().name, "side");
  EXPECT_NEAR(volume(body), 12.0 * pi, 1e-6);
}

TEST(BodyOfSections, TubesHaveWallsForEveryLoop) {
  std::vector<BodySection> sections;
  for (const double height : {0.0, 1.0, 2.0}) {
    std::vector<NurbsCurve<3>> loops{circle_at(2.0, height), circle_at(0.5, height, {0.8, 0.0}),
                                     circle_at(0.4, height, {-0.8, 0.0})};
    // The order of the loops plays no part.
    if (height == 1.0) std::ranges::reverse(loops);
    sections.push_back({"", loops});
  }
  const Body body = body_of_sections(sections);
  EXPECT_NEAR(volume(body), 2.0 * pi * (4.0 - 0.25 - 0.16), 1e-9);
}

TEST(BodyOfSections, PointsEndABodyWithoutCap) {
  std::vector<BodySection> sections{{"", {point_section({0.0, 0.0, 0.0})}}};
  for (const double height : {1.0, 2.0}) sections.push_back({"", {circle_at(height, height)}});
  sections.push_back({"", {point_section({0.0, 0.0, 6.0})}});
  const Body body = body_of_sections(sections, {.degree = 1});
  EXPECT_EQ(body.boundary.patches.size(), 1U);
  EXPECT_NEAR(volume(body), pi * 4.0 * 6.0 / 3.0, 1e-11);
}

NurbsCurve<3> tube_section(double angle) {
  const Axis axis{Point3::Zero(), Vector3::UnitZ()};
  NurbsCurve<3> circle = embed(circle_curve(1.0, {3.0, 0.0}));
  return transform(transform(circle, rotation(Axis{Point3::Zero(), Vector3::UnitX()}, pi / 2.0)),
                   rotation(axis, angle));
}

TEST(BodyOfSections, RingsConvergeToTheTorus) {
  const double exact = 2.0 * pi * pi * 3.0;
  std::vector<double> errors;
  for (const int count : {8, 16, 32}) {
    std::vector<BodySection> sections;
    for (int k = 0; k < count; ++k) sections.push_back({"", {tube_section(2.0 * pi * k / count)}});
    const Body body = body_of_sections(sections, {.ends = BodyEnds::closed});
    EXPECT_EQ(body.boundary.patches.size(), 1U);
    errors.push_back(std::abs(volume(body) - exact) / exact);
  }
  // Cubic interpolation: fourth order.
  EXPECT_GT(std::log2(errors[0] / errors[1]), 3.6);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 3.6);
  EXPECT_LT(errors[2], 1e-4);
}

TEST(BodyOfSections, ClosedBodiesAreSmoothWhereTheyClose) {
  std::vector<BodySection> sections;
  for (int k = 0; k < 12; ++k) sections.push_back({"", {tube_section(2.0 * pi * k / 12)}});
  const Body body = body_of_sections(sections, {.ends = BodyEnds::closed});
  const NurbsSurface<3>& side = surface_of(body.boundary.patches.front().shape);
  for (const double u : {0.1, 0.4, 0.8}) {
    const SurfaceJet<3> first = evaluate_jet(side, {u, 0.0});
    const SurfaceJet<3> last = evaluate_jet(side, {u, 1.0});
    EXPECT_LT((first.point - last.point).norm(), 1e-12);
    EXPECT_LT((first.dv - last.dv).norm(), 1e-10);
    EXPECT_LT((first.dvv - last.dvv).norm(), 1e-8);
  }
}

TEST(BodyOfSections, RefusesWhatIsNoBody) {
  const std::vector<BodySection> branching{{"z = 0", {circle_at(2.0, 0.0)}},
                                           {"z = 1", {circle_at(0.5, 1.0, {1, 0}), circle_at(0.5, 1.0, {-1, 0})}}};
  EXPECT_GEOMETRY_ERROR(body_of_sections(branching),
                        "the body branches: section 1 (z = 0) has 1 loop(s), section 2 (z = 1) has 2");
  const std::vector<BodySection> one{branching.front()};
  EXPECT_GEOMETRY_ERROR(body_of_sections(one), "1 section(s), at least 2");
  const std::vector<BodySection> empty{branching.front(), {"b", {}}};
  EXPECT_GEOMETRY_ERROR(body_of_sections(empty), "section 2 (b) has no loop");
  const std::vector<BodySection> open{branching.front(),
                                      {"", {line_segment<3>(Point3::Zero(), Point3(1.0, 0.0, 1.0))}}};
  EXPECT_GEOMETRY_ERROR(body_of_sections(open), "section 2: a loop is not closed");
  const std::vector<BodySection> bent{{"", {tube_section(0.0)}}, {"", {tube_section(0.3)}}, {"", {tube_section(0.6)}}};
  const BodyOptions even{.degree = 2, .ends = BodyEnds::closed};
  EXPECT_GEOMETRY_ERROR(body_of_sections(bent, even), "degree is 2; closed lofts need an odd one");
  const std::vector<BodySection> crossing{{"", {circle_at(1.0, 0.0), circle_at(1.0, 0.0, {1.0, 0.0})}},
                                          {"", {circle_at(1.0, 1.0), circle_at(1.0, 1.0, {1.0, 0.0})}}};
  EXPECT_GEOMETRY_ERROR(body_of_sections(crossing), "cross");
}

}  // namespace
}  // namespace isorim::geometry
