#include "geometry/propeller/profile_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace isorim::geometry {
namespace {

constexpr std::array forms{ThicknessForm::naca_66_mod, ThicknessForm::naca_16, ThicknessForm::naca_4_digit};
constexpr std::array lines{MeanLine::naca_a08, MeanLine::naca_a10, MeanLine::parabola};

TEST(ThicknessForm, HasALargestThicknessOfOne) {
  for (const ThicknessForm form : forms) {
    double largest = 0.0;
    for (int i = 0; i <= 10000; ++i) largest = std::max(largest, half_thickness(form, i / 10000.0));
    EXPECT_NEAR(largest, 0.5, 4e-4) << thickness_form_names[static_cast<std::size_t>(form)];
    EXPECT_EQ(half_thickness(form, 0.0), 0.0);
  }
}

// NACA TN 976: the 16-009 section, in per cent of the chord.
TEST(ThicknessForm, Naca16AgreesWithItsPublishedOrdinates) {
  constexpr std::array<std::pair<double, double>, 13> published{{{1.25, 0.969},
                                                                 {2.5, 1.354},
                                                                 {5.0, 1.882},
                                                                 {10.0, 2.593},
                                                                 {20.0, 3.498},
                                                                 {30.0, 4.063},
                                                                 {40.0, 4.391},
                                                                 {50.0, 4.500},
                                                                 {60.0, 4.376},
                                                                 {70.0, 3.952},
                                                                 {80.0, 3.149},
                                                                 {90.0, 1.888},
                                                                 {95.0, 1.061}}};
  for (const auto& [x, y] : published)
    EXPECT_NEAR(9.0 * half_thickness(ThicknessForm::naca_16, x / 100.0), y, 1.5e-3) << x;
}

// Report 460: NACA 0012, in per cent of the chord.
TEST(ThicknessForm, FourDigitsAgreeWithTheirPublishedOrdinates) {
  constexpr std::array<std::pair<double, double>, 7> published{
      {{1.25, 1.894}, {5.0, 3.555}, {10.0, 4.683}, {30.0, 6.002}, {50.0, 5.294}, {80.0, 2.623}, {100.0, 0.126}}};
  for (const auto& [x, y] : published)
    EXPECT_NEAR(12.0 * half_thickness(ThicknessForm::naca_4_digit, x / 100.0), y, 1e-3) << x;
}

TEST(ThicknessForm, Naca66ModPassesThroughItsTableAndStaysSmooth) {
  EXPECT_NEAR(half_thickness(ThicknessForm::naca_66_mod, 0.05), 0.2066, 1e-15);
  EXPECT_NEAR(half_thickness(ThicknessForm::naca_66_mod, 0.45), 0.5, 1e-15);
  EXPECT_NEAR(half_thickness(ThicknessForm::naca_66_mod, 1.0), 0.0333, 1e-15);
  // The nose: y^2 = 2 r x with r = 0.448.
  const double x = 1e-7;
  EXPECT_NEAR(std::pow(half_thickness(ThicknessForm::naca_66_mod, x), 2) / (2.0 * x), 0.448, 1e-3);
  // Rising up to the largest thickness, then falling.
  for (double t = 0.0; t < 0.999; t += 0.001) {
    const double step =
        half_thickness(ThicknessForm::naca_66_mod, t + 0.001) - half_thickness(ThicknessForm::naca_66_mod, t);
    EXPECT_TRUE(t < 0.44 ? step > 0.0 : t < 0.46 || step < 0.0) << t;
  }
}

// Report 824, table of the a = 0.8 mean line for a design lift coefficient of 1, in per cent of the chord.
TEST(MeanLine, A08AgreesWithItsPublishedOrdinates) {
  constexpr std::array<std::pair<double, double>, 14> published{{{0.5, 0.287},
                                                                 {1.25, 0.616},
                                                                 {2.5, 1.077},
                                                                 {5.0, 1.841},
                                                                 {10.0, 3.043},
                                                                 {20.0, 4.748},
                                                                 {30.0, 5.863},
                                                                 {40.0, 6.528},
                                                                 {50.0, 6.790},
                                                                 {60.0, 6.644},
                                                                 {70.0, 6.037},
                                                                 {80.0, 4.771},
                                                                 {90.0, 2.435},
                                                                 {95.0, 1.163}}};
  const double scale = 6.790 / mean_line(MeanLine::naca_a08, 0.5).camber;
  for (const auto& [x, y] : published)
    EXPECT_NEAR(scale * mean_line(MeanLine::naca_a08, x / 100.0).camber, y, 1.1e-3) << x;
}

TEST(MeanLine, HasALargestCamberOfOneAndItsSlope) {
  for (const MeanLine line : lines) {
    double largest = 0.0;
    for (int i = 0; i <= 10000; ++i) largest = std::max(largest, mean_line(line, i / 10000.0).camber);
    EXPECT_NEAR(largest, 1.0, 1e-8);
    EXPECT_NEAR(mean_line(line, 0.0).camber, 0.0, 1e-15);
    EXPECT_NEAR(mean_line(line, 1.0).camber, 0.0, 1e-15);
    EXPECT_TRUE(std::isfinite(mean_line(line, 0.0).slope));
    EXPECT_TRUE(std::isfinite(mean_line(line, 1.0).slope));
    for (const double x : {0.01, 0.2, 0.5, 0.79, 0.81, 0.97}) {
      const double h = 1e-6;
      const double difference = (mean_line(line, x + h).camber - mean_line(line, x - h).camber) / (2.0 * h);
      EXPECT_NEAR(mean_line(line, x).slope, difference, 1e-7) << x;
    }
  }
}

}  // namespace
}  // namespace isorim::geometry
