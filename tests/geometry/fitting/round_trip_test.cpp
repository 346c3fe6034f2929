#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/section_solid.h"
#include "tests/geometry/measures.h"

/// Sections are cut from known bodies as points, fitted and skinned; the volume comes back. The cuts are analytic.
namespace isorim::geometry {
namespace {

using testing::measures;
constexpr double pi = std::numbers::pi;

struct Sampling {
  int sections = 0;
  int points = 0;
  int control_points = 0;
  /// Standard deviation of what is added to both coordinates in the section's plane.
  double noise = 0.0;
};

class Noise {
 public:
  explicit Noise(double sigma) : sigma_(sigma) {}
  Point2 operator()(const Point2& point) {
    return sigma_ == 0.0 ? point : Point2(point + sigma_ * Point2(normal_(random_), normal_(random_)));
  }

 private:
  double sigma_;
  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
};

NurbsCurve<2> fitted(const Points<2>& points, int control_points, double corner_angle = 0.0) {
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.control_points = control_points;
  options.corner_angle = corner_angle;
  return fit_points<2>(points, options).curve;
}

NurbsCurve<3> placed(const NurbsCurve<2>& curve, const Point3& origin, const Vector3& first, const Vector3& second) {
  AffineMap<3> map;
  map.linear.col(0) = first;
  map.linear.col(1) = second;
  map.linear.col(2).setZero();
  map.translation = origin;
  return transform(embed(curve), map);
}

double relative_error(const std::vector<BodySection>& sections, const BodyOptions& options, double exact) {
  return std::abs(measures(body_of_sections(sections, options).boundary, 8).content - exact) / exact;
}

/// Radii 3 and 1, cut by half-planes through the axis.
double torus_error(const Sampling& sampling) {
  Noise noise(sampling.noise);
  std::vector<BodySection> sections;
  for (int k = 0; k < sampling.sections; ++k) {
    Points<2> points(2, sampling.points);
    for (int i = 0; i < sampling.points; ++i) {
      const double t = 2.0 * pi * i / sampling.points;
      points.col(i) = noise(Point2(3.0 + std::cos(t), std::sin(t)));
    }
    const double angle = 2.0 * pi * k / sampling.sections;
    sections.push_back({"",
                        {placed(fitted(points, sampling.control_points), Point3::Zero(),
                                Vector3(std::cos(angle), std::sin(angle), 0.0), Vector3::UnitZ())}});
  }
  return relative_error(sections, {.start = StartRule::as_given, .ends = BodyEnds::closed}, 6.0 * pi * pi);
}

/// Semi-axes 3, 2, 1, cut at the heights of Chebyshev's points, with points for tips.
double ellipsoid_error(const Sampling& sampling) {
  Noise noise(sampling.noise);
  std::vector<BodySection> sections{{"", {point_section({0.0, 0.0, -1.0})}}};
  for (int k = 1; k <= sampling.sections; ++k) {
    const double height = -std::cos(pi * k / (sampling.sections + 1));
    const double scale = std::sqrt(1.0 - height * height);
    Points<2> points(2, sampling.points);
    for (int i = 0; i < sampling.points; ++i) {
      const double t = 2.0 * pi * i / sampling.points;
      points.col(i) = noise(scale * Point2(3.0 * std::cos(t), 2.0 * std::sin(t)));
    }
    sections.push_back({"",
                        {placed(fitted(points, sampling.control_points), Point3(0.0, 0.0, height), Vector3::UnitX(),
                                Vector3::UnitY())}});
  }
  sections.push_back({"", {point_section({0.0, 0.0, 1.0})}});
  return relative_error(sections, {.start = StartRule::as_given}, 8.0 * pi);
}

/// Sections with the thickness of NACA's four-digit series, 18 % of a chord that falls from 1 to 1/2 over the span of
/// 3, turned by 30 degrees along it; a sharp trailing edge.
double blade_error(const Sampling& sampling) {
  Noise noise(sampling.noise);
  const auto thickness = [](double x) {
    return 0.9 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
  };
  std::vector<BodySection> sections;
  for (int k = 0; k < sampling.sections; ++k) {
    const double part = static_cast<double>(k) / (sampling.sections - 1);
    const double chord = 1.0 - 0.5 * part;
    Points<2> points(2, sampling.points);
    for (int i = 0; i < sampling.points; ++i) {
      // Dense at the leading edge, t = 1, alone.
      const double t = 2.0 * i / sampling.points;
      const double x = 1.0 - std::sin(0.5 * pi * (t < 1.0 ? t : 2.0 - t));
      const Point2 point = chord * Point2(x - 0.25, t < 1.0 ? thickness(x) : -thickness(x));
      // The trailing edge is where it is.
      points.col(i) = i == 0 ? Point2(chord * 0.75, 0.0) : noise(point);
    }
    const double angle = pi / 6.0 * part;
    sections.push_back(
        {"",
         {placed(fitted(points, sampling.control_points, 90.0), Point3(0.0, 0.0, 3.0 * part),
                 Vector3(std::cos(angle), std::sin(angle), 0.0), Vector3(-std::sin(angle), std::cos(angle), 0.0))}});
  }
  const double area = 1.8 * (0.2969 * 2.0 / 3.0 - 0.126 / 2.0 - 0.3516 / 3.0 + 0.2843 / 4.0 - 0.1036 / 5.0);
  // The mean of the squared chord is 7/12.
  return relative_error(sections, {.start = StartRule::as_given}, area * 3.0 * 7.0 / 12.0);
}

/// Errors of finer and finer cuts, noted with the test.
std::vector<double> errors(const std::string& name, const std::function<double(const Sampling&)>& error,
                           const std::vector<Sampling>& cuts) {
  std::vector<double> result;
  for (const Sampling& cut : cuts) {
    result.push_back(error(cut));
    ::testing::Test::RecordProperty(name + "_" + std::to_string(result.size()), fmt::format("{:.2e}", result.back()));
  }
  return result;
}

TEST(RoundTrip, TorusConvergesToFourthOrder) {
  const std::vector<double> e = errors("torus", torus_error, {{8, 24, 8, 0.0}, {16, 48, 16, 0.0}, {32, 96, 32, 0.0}});
  EXPECT_GT(std::log2(e[0] / e[1]), 3.7);
  EXPECT_GT(std::log2(e[1] / e[2]), 3.7);
  EXPECT_LT(e[2], 1e-5);
}

TEST(RoundTrip, EllipsoidConvergesToFourthOrder) {
  const std::vector<double> e =
      errors("ellipsoid", ellipsoid_error, {{7, 24, 8, 0.0}, {15, 48, 16, 0.0}, {31, 96, 32, 0.0}});
  EXPECT_GT(std::log2(e[0] / e[1]), 3.0);
  EXPECT_GT(std::log2(e[1] / e[2]), 3.0);
  EXPECT_LT(e[2], 1e-4);
}

TEST(RoundTrip, BladeConverges) {
  const std::vector<double> e = errors("blade", blade_error, {{4, 64, 16, 0.0}, {7, 128, 32, 0.0}, {13, 256, 64, 0.0}});
  EXPECT_LT(e[1], 0.5 * e[0]);
  EXPECT_LT(e[2], 0.5 * e[1]);
  EXPECT_LT(e[2], 1e-4);
}

/// Noise of a thousandth of the sections' size: n points leave a volume error of about noise / sqrt(n) beside that of
/// the fit.
TEST(RoundTrip, NoiseOfAThousandthCostsLess) {
  EXPECT_LT(errors("torus", torus_error, {{32, 96, 16, 0.002}})[0], 5e-4);
  EXPECT_LT(errors("ellipsoid", ellipsoid_error, {{31, 96, 16, 0.004}})[0], 1e-3);
  EXPECT_LT(errors("blade", blade_error, {{13, 96, 24, 0.001}})[0], 2e-3);
}

}  // namespace
}  // namespace isorim::geometry
