#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/fitting/section_alignment.h"
#include "geometry/fitting/section_fit.h"
#include "geometry/fitting/section_solid.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/intersection/section_spline.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "tests/geometry/measures.h"

/// Bodies are cut by the program's own plane sections, measured in points along the cuts, fitted and skinned again.
namespace isorim::geometry {
namespace {

using testing::measures;
constexpr double pi = std::numbers::pi;

/// Where a body is cut, and which loop of the section is meant.
struct Cut {
  PlaneFrame plane;
  std::size_t loop = 0;
};

struct Level {
  int sections = 0;
  int points = 0;
  int control_points = 0;
  /// Standard deviation of both coordinates in the plane.
  double noise = 0.0;
};

struct Specimen {
  Boundary<3> body;
  std::function<std::vector<Cut>(int)> cuts;
  BodyOptions options = {.start = StartRule::as_given};
  std::vector<Point3> tips{};
  double corner_angle = 0.0;
};

/// The sections of a specimen as they are, from which points with different noise are taken.
struct CutSpecimen {
  std::vector<Cut> cuts;
  std::vector<SectionSpline> splines;
  double volume = 0.0;
};

CutSpecimen cut(const Specimen& specimen, int sections) {
  const PlaneCutter cutter(specimen.body);
  CutSpecimen result{specimen.cuts(sections), {}, measures(specimen.body, 16).content};
  for (const Cut& cut : result.cuts)
    result.splines.push_back(
        fit_section(cutter.section(cut.plane).loops.at(cut.loop).curve, {.tolerance = 1e-10 * cutter.size()}));
  return result;
}

/// Points at equal arc lengths; those of a loop with a corner start there.
Points<2> measured(const SectionSpline& spline, const Level& level, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  Points<2> points(2, level.points);
  for (int i = 0; i < level.points; ++i) {
    points.col(i) = evaluate(spline.curve, spline.length * i / level.points);
    if (level.noise > 0.0) points.col(i) += level.noise * Point2(normal(random), normal(random));
  }
  return points;
}

std::vector<SectionPoints> scan(const Specimen& specimen, const CutSpecimen& cut, const Level& level, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<SectionPoints> scans;
  std::vector<Points<3>> polygons;
  for (std::size_t k = 0; k < cut.cuts.size(); ++k) {
    SectionPoints points{"", measured(cut.splines[k], level, random), {}};
    points.options.control_points = level.control_points;
    points.options.corner_angle = specimen.corner_angle;
    Points<3>& polygon = polygons.emplace_back(3, points.points.cols());
    for (Eigen::Index i = 0; i < polygon.cols(); ++i) polygon.col(i) = cut.cuts[k].plane.to_space(points.points.col(i));
    scans.push_back(std::move(points));
  }
  // A corner is the start already.
  if (specimen.corner_angle > 0.0) return scans;
  const std::vector<PolygonAlignment> aligned = align_polygons(polygons, StartRule::least_twist);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Points<2> given = scans[k].points;
    const Eigen::Index count = given.cols();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index j = (i + aligned[k].first) % count;
      scans[k].points.col(i) = given.col(aligned[k].reversed ? count - 1 - j : j);
    }
  }
  return scans;
}

/// The relative error of the volume that comes back, with its sign.
double error(const Specimen& specimen, const CutSpecimen& cut, const Level& level, unsigned seed) {
  const std::vector<CurveFit<2>> fits = fit_sections(scan(specimen, cut, level, seed));
  std::vector<BodySection> sections;
  if (!specimen.tips.empty()) sections.push_back({"", {point_section(specimen.tips.front())}});
  for (std::size_t k = 0; k < cut.cuts.size(); ++k)
    sections.push_back({"", {to_space(fits[k].curve, cut.cuts[k].plane)}});
  if (!specimen.tips.empty()) sections.push_back({"", {point_section(specimen.tips.back())}});
  const double volume = measures(body_of_sections(sections, specimen.options).boundary, 8).content;
  return (volume - cut.volume) / cut.volume;
}

/// Radii 3 and 1, by planes through the axis; of the two circles the one on the side of the angle.
Specimen ring() {
  Specimen specimen{torus(3.0, 1.0), {}};
  specimen.options.ends = BodyEnds::closed;
  specimen.cuts = [](int count) {
    std::vector<Cut> cuts;
    const PlaneCutter cutter(torus(3.0, 1.0));
    for (int k = 0; k < count; ++k) {
      const double angle = 2.0 * pi * (k + 0.3) / count;
      const Vector3 outward(std::cos(angle), std::sin(angle), 0.0);
      const PlaneFrame plane = plane_frame(Point3::Zero(), Vector3(-std::sin(angle), std::cos(angle), 0.0));
      const PlaneSection section = cutter.section(plane);
      const Point3 first = evaluate_jet(section.loops.at(0).curve.pieces.front(), 0.5).place.point;
      cuts.push_back({plane, first.dot(outward) > 0.0 ? 0U : 1U});
    }
    return cuts;
  };
  return specimen;
}

std::vector<Cut> horizontal(const std::vector<double>& heights) {
  std::vector<Cut> cuts;
  for (const double height : heights) cuts.push_back({plane_frame({0, 0, height}, Vector3::UnitZ()), 0});
  return cuts;
}

/// Semi-axes 3, 2, 1, by planes that crowd towards the tips.
Specimen ellipsoid_with_tips() {
  Specimen specimen{transform(sphere(1.0), scaling<3>(Vector3(3.0, 2.0, 1.0))), {}};
  specimen.tips = {{0, 0, -1}, {0, 0, 1}};
  specimen.cuts = [](int count) {
    std::vector<double> heights;
    for (int k = 1; k <= count; ++k) heights.push_back(-std::cos(pi * k / (count + 1)));
    return horizontal(heights);
  };
  return specimen;
}

/// Sections with the thickness of NACA's four-digit series, tapered and twisted, on nine heights; a sharp edge.
Specimen blade() {
  std::vector<BodySection> sections;
  for (int k = 0; k <= 8; ++k) {
    const double part = k / 8.0;
    const double chord = 1.0 - 0.5 * part * part;
    Points<3> points(3, 200);
    for (int i = 0; i < 200; ++i) {
      const double t = i / 100.0;
      const double x = 1.0 - std::sin(0.5 * pi * (t < 1.0 ? t : 2.0 - t));
      const double half =
          0.9 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
      const Point2 at = chord * Point2(x - 0.25, t < 1.0 ? half : -half);
      const double c = std::cos(0.6 * part);
      const double s = std::sin(0.6 * part);
      points.col(i) << c * at.x() - s * at.y(), s * at.x() + c * at.y(), 3.0 * part;
    }
    CurveFitOptions<3> options;
    options.control_points = 30;
    options.corner_angle = 90.0;
    options.method = FitMethod::fixed_knots;
    CurveFit<3> fit = fit_points<3>(points, options);
    sections.push_back({"", {std::move(fit.curve)}});
  }
  Specimen specimen{body_of_sections(sections, {.start = StartRule::as_given}).boundary, {}};
  specimen.corner_angle = 90.0;
  specimen.cuts = [](int count) {
    std::vector<double> heights;
    for (int k = 0; k < count; ++k) heights.push_back(3.0 * k / (count - 1));
    return horizontal(heights);
  };
  return specimen;
}

/// The standard deviation of the relative volume that independent noise of all points leaves behind: each moves its
/// part of the surface.
double noise_share(const Level& level, double surface_over_volume) {
  return surface_over_volume * level.noise / std::sqrt(static_cast<double>(level.sections * level.points));
}

struct Scatter {
  double mean = 0.0;
  double deviation = 0.0;
};

Scatter scatter_of_errors(const Specimen& specimen, const CutSpecimen& cut, const Level& level) {
  constexpr unsigned seeds = 8;
  std::vector<double> errors;
  Scatter scatter;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    errors.push_back(error(specimen, cut, level, seed));
    scatter.mean += errors.back() / seeds;
  }
  for (const double e : errors) scatter.deviation += (e - scatter.mean) * (e - scatter.mean) / (seeds - 1);
  scatter.deviation = std::sqrt(scatter.deviation);
  return scatter;
}

/// Errors without noise fall with the fourth power of the sections' distance, as cubics do, or faster. With noise, over
/// eight seeds, they scatter as independent errors of the points do, and their mean is that without noise but for the
/// scatter of a mean. Noted with the test.
void expect_convergence(const std::string& name, const Specimen& specimen, const std::vector<Level>& levels,
                        double last, double noise, double surface_over_volume) {
  std::vector<double> exact;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    SCOPED_TRACE(name + " " + std::to_string(k));
    Level level = levels[k];
    const CutSpecimen sections = cut(specimen, level.sections);
    exact.push_back(error(specimen, sections, level, 0));
    level.noise = noise;
    const Scatter scatter = scatter_of_errors(specimen, sections, level);
    const double share = noise_share(level, surface_over_volume);
    EXPECT_LT(std::abs(scatter.mean - exact[k]), 0.2 * std::abs(exact[k]) + 1.5 * share);
    EXPECT_LT(scatter.deviation, 2.0 * share);
    ::testing::Test::RecordProperty(
        name + "_" + std::to_string(k + 1),
        fmt::format("{:.2e}, noisy {:.2e} +- {:.1e}, share {:.1e}", exact[k], scatter.mean, scatter.deviation, share));
  }
  for (std::size_t k = 0; k + 1 < exact.size(); ++k)
    EXPECT_GT(std::log2(std::abs(exact[k] / exact[k + 1])), k + 2 == exact.size() ? 2.2 : 3.6) << name << k;
  EXPECT_LT(std::abs(exact.back()), last) << name;
}

TEST(CutRoundTrip, Ring) {
  expect_convergence("ring", ring(), {{8, 24, 8}, {16, 48, 12}, {32, 96, 16}, {64, 192, 24}}, 5e-7, 0.002, 2.0);
}

TEST(CutRoundTrip, Ellipsoid) {
  expect_convergence("ellipsoid", ellipsoid_with_tips(), {{7, 24, 8}, {15, 48, 12}, {31, 96, 16}}, 2e-6, 0.004, 2.0);
}

/// Surface and volume: 2.06 chords of perimeter, 0.123 squared chords of area.
TEST(CutRoundTrip, Blade) {
  expect_convergence("blade", blade(), {{4, 64, 16}, {7, 128, 24}, {13, 96, 32}}, 4e-6, 0.001, 2.06 / 0.123 / 0.8);
}

}  // namespace
}  // namespace isorim::geometry
