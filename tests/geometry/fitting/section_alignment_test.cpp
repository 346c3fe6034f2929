#include "geometry/fitting/section_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/fitting/section_solid.h"
#include "geometry/shapes/curves.h"
#include "tests/geometry/expect_error.h"

namespace isorim::geometry {
namespace {

constexpr double pi = std::numbers::pi;

/// A smooth closed curve without symmetry on a periodic knot vector.
NurbsCurve<3> periodic_curve(int degree = 3, int count = 12, double height = 0.0) {
  std::vector<double> breakpoints;
  for (int i = 0; i <= count; ++i) breakpoints.push_back(i + 0.2 * std::sin(2.0 * pi * i / count));
  Points<3> points(3, count + degree);
  for (int i = 0; i < points.cols(); ++i) {
    const double angle = 2.0 * pi * (i % count) / count;
    const double radius = 2.0 + 0.5 * std::cos(angle) + 0.3 * std::sin(2.0 * angle);
    points.col(i) << radius * std::cos(angle), radius * std::sin(angle), height;
  }
  return NurbsCurve<3>::from_points(KnotVector::periodic(degree, breakpoints), points);
}

TEST(StartAt, MovesTheStartAlongTheSameCurve) {
  const NurbsCurve<3> circle = embed(circle_curve(2.0, {1.0, -1.0}));
  for (const NurbsCurve<3>& curve : {periodic_curve(3), periodic_curve(4), circle}) {
    const Interval domain = curve.domain();
    for (const double part : {0.0, 0.1, 0.25, 0.6180339887, 0.95}) {
      const NurbsCurve<3> started = start_at(curve, domain.first + part * domain.length());
      EXPECT_TRUE(started.knots().is_clamped());
      EXPECT_TRUE(is_closed(started));
      for (int k = 0; k < 50; ++k) {
        const double t = k / 50.0;
        const double moved = part + t - std::floor(part + t);
        const Point3 expected = evaluate(curve, domain.first + moved * domain.length());
        EXPECT_LT((evaluate(started, t) - expected).norm(), 1e-12);
      }
    }
  }
}

TEST(StartAt, APeriodicCurveStaysSmoothWhereItUsedToClose) {
  const NurbsCurve<3> curve = periodic_curve();
  const NurbsCurve<3> started = start_at(curve, curve.domain().first + 0.3 * curve.domain().length());
  for (const double knot : started.knots().breakpoints()) {
    EXPECT_EQ(started.knots().multiplicity(knot), knot > 0.0 && knot < 1.0 ? 1 : 4);
  }
  const CurveJet<3> first = evaluate_jet(started, 0.0);
  const CurveJet<3> last = evaluate_jet(started, 1.0);
  EXPECT_LT((first.du - last.du).norm(), 1e-11);
  EXPECT_LT((first.duu - last.duu).norm(), 1e-9);
}

TEST(StartAt, RefusesOpenCurvesAndPlacesOutside) {
  EXPECT_GEOMETRY_ERROR(start_at(line_segment<3>(Point3::Zero(), Point3::Ones()), 0.5), "not closed");
  EXPECT_GEOMETRY_ERROR(start_at(embed(circle_curve(1.0)), 1.5), "1.5 lies outside the domain [0, 1]");
}

TEST(VectorArea, IsNormalTimesArea) {
  const Vector3 area = vector_area(embed(circle_curve(2.0, {5.0, 5.0})));
  EXPECT_NEAR(area.z(), 4.0 * pi, 0.01);
  EXPECT_NEAR(area.head<2>().norm(), 0.0, 1e-12);
}

TEST(AlignSections, UndoesShiftsAndReversals) {
  const NurbsCurve<3> base = periodic_curve();
  const Interval domain = base.domain();
  AffineMap<3> up;
  up.translation = {0.2, 0.1, 1.0};
  std::vector<NurbsCurve<3>> sections{base};
  sections.push_back(transform(start_at(base, domain.first + 0.37 * domain.length()), up));
  sections.push_back(reverse(start_at(base, domain.first + 0.71 * domain.length())));
  const NurbsCurve<3> expected = start_at(base, domain.first);
  const std::vector<NurbsCurve<3>> twistless = align_sections(sections, StartRule::least_twist);
  for (int k = 0; k < 40; ++k) {
    const double t = k / 40.0;
    EXPECT_LT((evaluate(twistless[1], t) - up(evaluate(expected, t))).norm(), 2e-5);
    EXPECT_LT((evaluate(twistless[2], t) - evaluate(expected, t)).norm(), 2e-5);
  }
  std::vector<NurbsCurve<3>> unmoved{base, start_at(base, domain.first + 0.37 * domain.length())};
  const std::vector<NurbsCurve<3>> closest = align_sections(unmoved, StartRule::closest);
  EXPECT_LT((evaluate(closest[1], 0.0) - evaluate(expected, 0.0)).norm(), 1e-9);
  const std::vector<NurbsCurve<3>> given = align_sections(unmoved, StartRule::as_given);
  EXPECT_GT((evaluate(given[1], 0.0) - evaluate(expected, 0.0)).norm(), 1.0);
}

TEST(AlignSections, PassesOverPointsAndRefusesOpenCurves) {
  const std::vector<NurbsCurve<3>> tipped{point_section(Point3::UnitZ()), periodic_curve()};
  EXPECT_EQ(align_sections(tipped, StartRule::closest).size(), 2U);
  const std::vector<NurbsCurve<3>> open{periodic_curve(), line_segment<3>(Point3::Zero(), Point3::Ones())};
  EXPECT_GEOMETRY_ERROR(align_sections(open, StartRule::closest), "section 2 is not closed");
}

TEST(AlignPolygons, UndoShiftsAndReversals) {
  const NurbsCurve<3> base = periodic_curve();
  const Interval domain = base.domain();
  Points<3> polygon(3, 90);
  for (int k = 0; k < 90; ++k) polygon.col(k) = evaluate(base, domain.first + domain.length() * k / 90);
  Points<3> rotated(3, 90);
  rotated << polygon.rightCols(60), polygon.leftCols(30);
  for (const StartRule rule : {StartRule::least_twist, StartRule::closest}) {
    std::vector<Points<3>> polygons{polygon, rotated, rotated.rowwise().reverse()};
    const std::vector<PolygonAlignment> done = align_polygons(polygons, rule);
    EXPECT_EQ(done[1].first, 60);
    EXPECT_TRUE(done[2].reversed);
    EXPECT_EQ(polygons[1], polygon);
    EXPECT_EQ(polygons[2].col(0), polygon.col(0));
    EXPECT_EQ(polygons[2].col(1), polygon.col(1));
  }
}

}  // namespace
}  // namespace isorim::geometry
