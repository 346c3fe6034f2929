#pragma once

#include <array>
#include <string_view>

/// Named thickness forms and mean lines of blade sections, along a chord of length 1 from the leading edge (x = 0) to
/// the trailing edge (x = 1).
namespace isorim::geometry {

enum class ThicknessForm {
  /// The 66 series as modified for propellers: a blunter nose and a trailing edge of 6.66 % of the thickness (Brockett,
  /// DTMB report 1780, 1966). Interpolated through its table.
  naca_66_mod,
  /// The 16 series (NACA TN 976), trailing edge of 2 % of the thickness.
  naca_16,
  /// The four-digit series (NACA report 460), trailing edge of 2.1 % of the thickness.
  naca_4_digit,
};

enum class MeanLine {
  /// Uniform load up to 0.8 of the chord, then falling to nothing (NACA report 824).
  naca_a08,
  /// Uniform load over the whole chord.
  naca_a10,
  parabola,
};

/// Half the thickness, for a largest whole thickness of 1. x in [0, 1]; as the root of x at the nose.
double half_thickness(ThicknessForm form, double x);

struct MeanLinePoint {
  /// For a largest camber of 1.
  double camber = 0.0;
  double slope = 0.0;
};
/// x in [0, 1]. At the ends of the chord the slope of naca_a08's nose and of both ends of naca_a10 is infinite; the
/// value there is that at a distance of 1e-6 of the chord.
MeanLinePoint mean_line(MeanLine line, double x);

/// The names that case files use, in the order of the enumeration.
inline constexpr std::array<std::string_view, 3> thickness_form_names{"naca66mod", "naca16", "naca4"};
inline constexpr std::array<std::string_view, 3> mean_line_names{"a=0.8", "a=1.0", "parabola"};

}  // namespace isorim::geometry
