#include "quadrature/sinh_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isorim::quadrature {

double ellipse_sum(std::complex<double> z) {
  return std::max(std::sqrt(std::norm(z)) + std::sqrt(std::norm(z - 1.0)), 1.0);
}

double log_ellipse(std::complex<double> z) {
  return std::acosh(ellipse_sum(z));
}

SinhMap::SinhMap(double centre, double scale)
    : centre_(centre),
      scale_(scale),
      first_(std::asinh(-centre / scale)),
      length_(std::asinh((1.0 - centre) / scale) - first_) {}

SinhMap SinhMap::towards(std::complex<double> singularity) {
  constexpr double farthest = 1.5;
  constexpr double nearest = 1e-14;
  const double centre = std::clamp(singularity.real(), 0.0, 1.0);
  const double scale = std::abs(singularity - centre);
  if (!(scale < farthest)) return {};
  return {centre, std::max(scale, nearest)};
}

SinhMap::Value SinhMap::at(double g) const {
  if (is_identity()) return {g, 1.0};
  // Of sinh t only the absolute error counts.
  const double half = 0.5 * std::exp(first_ + g * length_);
  const double inverse = 0.25 / half;
  return {std::clamp(centre_ + scale_ * (half - inverse), 0.0, 1.0), scale_ * (half + inverse) * length_};
}

std::complex<double> SinhMap::at(std::complex<double> g) const {
  if (is_identity()) return g;
  return centre_ + scale_ * std::sinh(first_ + g * length_);
}

double SinhMap::log_ellipse_of(std::complex<double> u) const {
  return std::acosh(ellipse_sum_of(u));
}

double SinhMap::ellipse_sum_of(std::complex<double> u) const {
  if (is_identity()) return ellipse_sum(u);
  const std::complex<double> t = std::asinh((u - centre_) / scale_);
  const std::complex<double> mirrored(-t.real(), std::numbers::pi - std::abs(t.imag()));
  return std::min(ellipse_sum((t - first_) / length_), ellipse_sum((mirrored - first_) / length_));
}

Growth::Growth(double degree) {
  for (std::size_t k = 0; k < values_.size(); ++k)
    values_[k] = static_cast<float>(degree * step * static_cast<double>(k));
}

Growth::Growth(std::span<const double> coefficients, double degree) : Growth(degree) {
  for (std::size_t k = 0; k < values_.size(); ++k) {
    double largest = 0.0;
    for (std::size_t j = 0; j < coefficients.size(); ++j) {
      if (coefficients[j] > 0.0)
        largest = std::max(largest, std::log(coefficients[j]) + static_cast<double>(j * k) * step);
    }
    values_[k] += static_cast<float>(largest);
  }
}

double Growth::operator()(double log_rho) const {
  const double at = log_rho / step;
  const auto k = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(values_.size() - 2)));
  const auto low = static_cast<double>(values_[k]);
  const auto high = static_cast<double>(values_[k + 1]);
  return low + (at - static_cast<double>(k)) * (high - low);
}

}  // namespace isorim::quadrature
