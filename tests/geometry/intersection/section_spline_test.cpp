#include "geometry/intersection/section_spline.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/shapes/solids.h"
#include "tests/geometry/intersection/section_measures.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using testing::refusal;

constexpr double pi = std::numbers::pi;

double farthest(const SectionCurve& curve, const NurbsCurve<2>& fitted) {
  double distance = 0.0;
  for (const NurbsCurve<2>& part : curve.plane_curves.curves)
    for (int k = 0; k <= 10; ++k) {
      const Interval domain = part.domain();
      const Point2 point = evaluate(part, domain.first + 0.1 * k * domain.length());
      distance = std::max(distance, closest_point(fitted, point).distance);
    }
  return distance;
}

/// The largest jump of a derivative over the knots, the closing point of a periodic curve among them.
double largest_jump(const SectionSpline& spline, bool second) {
  const NurbsCurve<2>& curve = spline.curve;
  const auto derivative = [&](double u) {
    const CurveJet<2> jet = evaluate_jet(curve, u);
    return second ? jet.duu : jet.du;
  };
  double jump = 0.0;
  const std::vector<double> breaks = curve.knots().breakpoints();
  for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
    const double h = 1e-12 * spline.length;
    jump = std::max(jump, (derivative(breaks[i] - h) - derivative(breaks[i] + h)).norm());
  }
  if (spline.is_periodic) jump = std::max(jump, (derivative(breaks.front()) - derivative(breaks.back())).norm());
  return jump;
}

/// A cylinder without its ends.
Boundary<3> tube() {
  Boundary<3> open = cylinder(1.0, 2.0);
  std::erase_if(open.patches, [](const Patch<3>& patch) { return patch.name == "bottom" || patch.name == "top"; });
  return open;
}

TEST(SectionSpline, MeetsItsTolerance) {
  for (const double height : {0.1, 0.3}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const PlaneSection section = plane_section(torus(2.0, 0.5), plane_frame({0, 0, height}, {0.1, 0.3, 1}));
      for (const SectionLoop& loop : section.loops) {
        const SectionSpline spline = fit_section(loop.curve, {.tolerance = tolerance});
        EXPECT_TRUE(spline.is_periodic);
        EXPECT_LE(spline.error, tolerance);
        EXPECT_LE(farthest(loop.curve, spline.curve), tolerance);
        EXPECT_LE(largest_jump(spline, false), 1e-5);
        EXPECT_LE(largest_jump(spline, true), 1e-4);
        double length = 0.0;
        for (const SectionPiece& piece : loop.curve.pieces) length += testing::piece_length(piece);
        EXPECT_NEAR(spline.length, length, 1e-10);
      }
    }
  }
}

/// The number of segments of a circle: the error falls as the sixth power of their length.
TEST(SectionSpline, ConvergesWithTheSixthPower) {
  const PlaneSection section = plane_section(sphere(1.0), plane_frame({0, 0, 0.3}, {0, 0, 1}));
  const auto points = [&](double tolerance) {
    return static_cast<double>(
        fit_section(section.loops[0].curve, {.tolerance = tolerance}).curve.knots().basis_count());
  };
  EXPECT_LE(points(1e-10) / points(1e-4), 1.3 * 10.0);
  EXPECT_GE(points(1e-10) / points(1e-4), 10.0 / 2.6);
  EXPECT_LE(points(1e-8), 32);
}

/// Simple knots, so four continuous derivatives, also at the closing point; of oblique sections of a torus that makes
/// a quarter of the control points that C2 Hermite segments take (1028).
TEST(SectionSpline, IsSmoothWithFewControlPoints) {
  const PlaneSection section = plane_section(torus(2.0, 0.5), plane_frame({0, 0, 0.3}, {0.1, 0.3, 1}));
  const SectionSpline spline = fit_section(section.loops[0].curve, {.tolerance = 1e-10});
  ASSERT_TRUE(spline.is_periodic);
  const std::vector<double> breaks = spline.curve.knots().breakpoints();
  EXPECT_EQ(static_cast<int>(breaks.size()) - 1 + 5, spline.curve.knots().basis_count());
  EXPECT_LE(spline.curve.knots().basis_count(), 270);
  const Points<2> control = spline.curve.control_points();
  EXPECT_EQ(control.leftCols(5), control.rightCols(5));
  EXPECT_LE(farthest(section.loops[0].curve, spline.curve), 1e-10);
}

/// Corners at both ends of a smooth arc: position, tangent and curvature there are those of the curve.
TEST(SectionSpline, EndsOfArcsAreTheCurves) {
  const PlaneSection section = plane_section(tube(), plane_frame({0, 0, 2}, {1, 0, 1}));
  const SectionSpline spline = fit_section(section.chains[0], {.tolerance = 1e-6});
  EXPECT_LE(spline.curve.knots().basis_count(), 30);
  const std::vector<NurbsCurve<2>>& parts = section.chains[0].plane_curves.curves;
  const auto expect_same = [](const CurveJet<2>& arc, const CurveJet<2>& curve) {
    const double speed = curve.du.norm();
    EXPECT_LE((arc.point - curve.point).norm(), 1e-13);
    EXPECT_LE((arc.du - curve.du / speed).norm(), 1e-11);
    const double bend = (curve.du.x() * curve.duu.y() - curve.du.y() * curve.duu.x()) / (speed * speed * speed);
    EXPECT_NEAR(arc.du.x() * arc.duu.y() - arc.du.y() * arc.duu.x(), bend, 1e-8);
  };
  const auto ends = spline.curve.domain();
  expect_same(evaluate_jet(spline.curve, ends.first), evaluate_jet(parts.front(), parts.front().domain().first));
  expect_same(evaluate_jet(spline.curve, ends.last), evaluate_jet(parts.back(), parts.back().domain().last));
}

TEST(SectionSpline, KeepsCorners) {
  const PlaneSection section = plane_section(cube(1.0), plane_frame({0.5, 0.5, 0.5}, {1, 1, 1}));
  const SectionSpline spline = fit_section(section.loops[0].curve, {});
  EXPECT_FALSE(spline.is_periodic);
  ASSERT_EQ(spline.corners.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(spline.corners[i], static_cast<double>(i) * std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(spline.length, 6.0 * std::sqrt(0.5), 1e-14);
  EXPECT_EQ(spline.curve.knots().basis_count(), 31);
  EXPECT_EQ(evaluate(spline.curve, 0.0), evaluate(spline.curve, spline.length));
  for (const double u : {0.1, 0.9, 3.3})
    EXPECT_LE(closest_point(spline.curve, evaluate(spline.curve, u)).distance, 1e-15);
}

/// A half circle with its chord: smooth within, corners at both ends.
TEST(SectionSpline, MixesCornersWithCurves) {
  const Boundary<3> half = clip(sphere(1.0), PlaneTool{{0, 0, 0}, {0.1, 0.2, 1}});
  const PlaneSection section = plane_section(half, plane_frame({0.1, 0, 0}, {1, 0.3, 0}));
  const SectionSpline spline = fit_section(section.loops[0].curve, {.tolerance = 1e-9});
  EXPECT_EQ(spline.corners.size(), 2U);
  EXPECT_LE(farthest(section.loops[0].curve, spline.curve), 1e-9);
}

/// Where a plane meets a cylinder between half balls the curvature jumps and the tangent does not.
TEST(SectionSpline, IsSmoothWhereCurvatureJumps) {
  Boundary<3> capsule = tube();
  for (const double side : {1.0, -1.0}) {
    const Boundary<3> half =
        clip(sphere(1.0, {0, 0, side > 0 ? 2.0 : 0.0}), PlaneTool{{0, 0, side > 0 ? 2.0 : 0.0}, {0, 0, -side}});
    for (const Patch<3>& patch : half.patches)
      if (patch.name != "cap") capsule.patches.push_back({side > 0 ? "top" : "foot", patch.shape, patch.orientation});
  }
  const PlaneSection section = plane_section(capsule, plane_frame({0, 0, 0}, {0, 1, 0}));
  ASSERT_EQ(section.loops.size(), 1U);
  const SectionSpline spline = fit_section(section.loops[0].curve, {.tolerance = 1e-9});
  EXPECT_TRUE(spline.is_periodic);
  EXPECT_TRUE(spline.corners.empty());
  EXPECT_NEAR(spline.length, 4.0 + 2.0 * pi, 1e-12);
  EXPECT_LE(largest_jump(spline, false), 1e-6);
  EXPECT_NEAR(largest_jump(spline, true), 1.0, 1e-3);
}

TEST(SectionSpline, OfOpenCurvesIsClamped) {
  const PlaneSection section = plane_section(tube(), plane_frame({0, 0, 2}, {1, 0, 1}));
  ASSERT_EQ(section.chains.size(), 1U);
  const SectionSpline spline = fit_section(section.chains[0], {.tolerance = 1e-8});
  EXPECT_FALSE(spline.is_periodic);
  EXPECT_TRUE(spline.corners.empty());
  EXPECT_LE(farthest(section.chains[0], spline.curve), 1e-8);
}

TEST(SectionSpline, GoesToSpace) {
  const PlaneFrame frame = plane_frame({0.1, 0.2, 0.3}, {1, 2, 3});
  const PlaneSection section = plane_section(sphere(1.0), frame);
  const NurbsCurve<3> curve = to_space(fit_section(section.loops[0].curve, {.tolerance = 1e-10}).curve, frame);
  for (const double s : {0.0, 1.0, 2.7}) {
    EXPECT_NEAR(evaluate(curve, s).norm(), 1.0, 1e-10);
    EXPECT_NEAR((evaluate(curve, s) - Point3(0.1, 0.2, 0.3)).dot(frame.normal), 0.0, 1e-14);
  }
}

TEST(SectionSpline, SamplesWithinTheSag) {
  const PlaneFrame frame = plane_frame({0, 0, 0.3}, {0, 0.4, 1});
  const PlaneSection section = plane_section(torus(2.0, 0.5), frame);
  const std::vector<SectionSample> samples = sample_section(section.loops[0].curve, frame, 1e-4);
  ASSERT_GT(samples.size(), 50U);
  EXPECT_LE((samples.front().place.point - samples.back().place.point).norm(), 1e-14);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_GT((samples[i].place.point - samples[i - 1].place.point).norm(), 1e-6);
    EXPECT_NEAR(samples[i].tangent.norm(), 1.0, 1e-14);
    const Point3 middle = 0.5 * (samples[i].place.point + samples[i - 1].place.point);
    // From the torus, hence from the curve in its plane at most as far.
    EXPECT_LE(std::abs(std::hypot(std::hypot(middle.x(), middle.y()) - 2.0, middle.z()) - 0.5), 1e-4);
  }
  EXPECT_THAT(refusal([&] { sample_section(section.loops[0].curve, frame, 0.0); }), ::testing::HasSubstr("sag"));
  EXPECT_THAT(refusal([&] { fit_section(section.loops[0].curve, {.tolerance = 0.0}); }),
              ::testing::HasSubstr("tolerance"));
}

}  // namespace
}  // namespace isorim::geometry
