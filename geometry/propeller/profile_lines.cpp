#include "geometry/propeller/profile_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace isorim::geometry {
namespace {

/// x and half the thickness over the root of x, of NACA 66 (mod); the first value is that of the nose radius 0.448.
struct TableRow {
  double x;
  double half_thickness;
};
constexpr std::array<TableRow, 26> naca_66_table{{
    {0.0, 0.0},       {0.0050, 0.0665}, {0.0075, 0.0812}, {0.0125, 0.1044}, {0.0250, 0.1466}, {0.0500, 0.2066},
    {0.0750, 0.2525}, {0.1000, 0.2907}, {0.1500, 0.3521}, {0.2000, 0.4000}, {0.2500, 0.4363}, {0.3000, 0.4637},
    {0.3500, 0.4832}, {0.4000, 0.4952}, {0.4500, 0.5000}, {0.5000, 0.4962}, {0.5500, 0.4846}, {0.6000, 0.4653},
    {0.6500, 0.4383}, {0.7000, 0.4035}, {0.7500, 0.3612}, {0.8000, 0.3110}, {0.8500, 0.2532}, {0.9000, 0.1877},
    {0.9500, 0.1143}, {1.0000, 0.0333},
}};
constexpr double naca_66_nose_radius = 0.448;

/// Over the root of x, which takes the nose's infinite slope away.
double smooth_part(const TableRow& row) {
  return row.x == 0.0 ? std::sqrt(2.0 * naca_66_nose_radius) : row.half_thickness / std::sqrt(row.x);
}

/// The cubic through four neighbouring rows in the root of x, in Lagrange's form.
double naca_66(double x) {
  const auto above = std::ranges::upper_bound(naca_66_table, x, {}, &TableRow::x);
  const auto position = std::clamp<std::ptrdiff_t>(above - naca_66_table.begin(), 2, naca_66_table.size() - 2);
  const auto first = static_cast<std::size_t>(position - 2);
  const double root = std::sqrt(x);
  double sum = 0.0;
  for (std::size_t i = first; i < first + 4; ++i) {
    double term = smooth_part(naca_66_table[i]);
    for (std::size_t j = first; j < first + 4; ++j) {
      if (j == i) continue;
      const double other = std::sqrt(naca_66_table[j].x);
      term *= (root - other) / (std::sqrt(naca_66_table[i].x) - other);
    }
    sum += term;
  }
  return root * sum;
}

double naca_16(double x) {
  if (x < 0.5) return 0.98968 * std::sqrt(x) - x * (0.23925 + x * (0.041 + x * 0.5594));
  const double rest = 1.0 - x;
  return 0.01 + rest * (2.325 - rest * (3.42 - rest * 1.46));
}

double naca_4_digit(double x) {
  return 5.0 * (0.2969 * std::sqrt(x) - x * (0.1260 + x * (0.3516 - x * (0.2843 - x * 0.1015))));
}

/// x ln x, continued to 0.
double x_log_x(double x) {
  return x > 0.0 ? x * std::log(x) : 0.0;
}
double square_log(double x) {
  return x * x_log_x(x);
}

/// Abbott and von Doenhoff, eqs. 4.25 and 4.26 without the common factor.
MeanLinePoint unscaled_load_line(double a, double x) {
  if (a == 1.0) return {-(x_log_x(1.0 - x) + x_log_x(x)), std::log(1.0 - x) - std::log(x)};
  const double rest = 1.0 - a;
  const double g = -(a * a * (0.5 * std::log(a) - 0.25) + 0.25) / rest;
  const double h = (0.5 * rest * rest * std::log(rest) - 0.25 * rest * rest) / rest + g;
  const double before = std::abs(a - x);
  const double after = 1.0 - x;
  const double bracket =
      0.5 * square_log(before) - 0.5 * square_log(after) + 0.25 * after * after - 0.25 * before * before;
  const double signed_log = a > x ? x_log_x(before) : -x_log_x(before);
  return {bracket / rest - x_log_x(x) + g - h * x, (x_log_x(after) - signed_log) / rest - std::log(x) - 1.0 - h};
}

/// Where the slope changes sign: the largest camber.
double largest_camber(double a) {
  double low = 0.1;
  double high = 0.9;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (unscaled_load_line(a, middle).slope > 0.0 ? low : high) = middle;
  }
  return unscaled_load_line(a, low).camber;
}

MeanLinePoint load_line(double a, double largest, double x) {
  constexpr double near_end = 1e-6;
  return {unscaled_load_line(a, x).camber / largest,
          unscaled_load_line(a, std::clamp(x, near_end, 1.0 - near_end)).slope / largest};
}

}  // namespace

double half_thickness(ThicknessForm form, double x) {
  switch (form) {
    case ThicknessForm::naca_66_mod:
      return naca_66(x);
    case ThicknessForm::naca_16:
      return naca_16(x);
    case ThicknessForm::naca_4_digit:
      break;
  }
  return naca_4_digit(x);
}

MeanLinePoint mean_line(MeanLine line, double x) {
  switch (line) {
    case MeanLine::naca_a08: {
      static const double largest = largest_camber(0.8);
      return load_line(0.8, largest, x);
    }
    case MeanLine::naca_a10:
      return load_line(1.0, std::numbers::ln2, x);
    case MeanLine::parabola:
      break;
  }
  return {4.0 * x * (1.0 - x), 4.0 - 8.0 * x};
}

}  // namespace isorim::geometry
