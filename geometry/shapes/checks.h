#pragma once

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/vocabulary.h"

/// Checks of the parameters of shapes. Each throws GeometryError that names the shape, the parameter and its value.
/// Private to the sources of this folder.
namespace isorim::geometry::checks {

inline void finite(std::string_view shape, std::string_view parameter, double value) {
  if (!std::isfinite(value)) throw GeometryError(fmt::format("{}: {} is {}, not a number", shape, parameter, value));
}

template <typename Derived>
void finite(std::string_view shape, std::string_view parameter, const Eigen::MatrixBase<Derived>& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values(i))) {
      throw GeometryError(fmt::format("{}: {}[{}] is {}, not a number", shape, parameter, i, values(i)));
    }
  }
}

inline void positive(std::string_view shape, std::string_view parameter, double value) {
  finite(shape, parameter, value);
  if (value <= 0.0) throw GeometryError(fmt::format("{}: {} is {}, it must be positive", shape, parameter, value));
}

inline void not_negative(std::string_view shape, std::string_view parameter, double value) {
  finite(shape, parameter, value);
  if (value < 0.0) throw GeometryError(fmt::format("{}: {} is {}, it must not be negative", shape, parameter, value));
}

template <typename Derived>
void positive(std::string_view shape, std::string_view parameter, const Eigen::MatrixBase<Derived>& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) positive(shape, fmt::format("{}[{}]", parameter, i), values(i));
}

/// The unit vector along `direction`.
template <int Dim>
Vector<Dim> unit(std::string_view shape, std::string_view parameter, const Vector<Dim>& direction) {
  finite(shape, parameter, direction);
  const double length = direction.stableNorm();
  if (length == 0.0) throw GeometryError(fmt::format("{}: {} is zero, it must be a direction", shape, parameter));
  return (direction / length).stableNormalized();
}

}  // namespace isorim::geometry::checks
