#include "io/results/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isorim::io {

double Entries::largest_magnitude() const {
  double largest = 0.0;
  for (const double x : values) largest = std::max(largest, std::abs(x));
  return largest;
}

Entries single(double value) {
  return {std::vector<double>(1, value), 1, 1};
}

double Quantity::largest_error() const {
  return error.empty() ? 0.0 : *std::max_element(error.begin(), error.end());
}

ExpectationResult compare(const Quantity& quantity, const Entries& expected, double rtol, double atol) {
  ExpectationResult result{.quantity = quantity.name,
                           .value = quantity.value,
                           .expected = expected,
                           .error = std::nullopt,
                           .rtol = rtol,
                           .atol = atol,
                           .difference = std::nullopt,
                           .relative_difference = std::nullopt};
  if (!quantity.error.empty()) result.error = quantity.largest_error();
  if (quantity.value.values.size() != expected.values.size()) return result;
  double difference = 0.0;
  for (std::size_t i = 0; i < expected.values.size(); ++i) {
    const double entry = std::abs(quantity.value.values[i] - expected.values[i]);
    // max() would pass over a NaN.
    difference = entry <= difference ? difference : entry;
    if (std::isnan(entry)) break;
  }
  const double size = expected.largest_magnitude();
  result.difference = difference;
  if (size > 0.0) result.relative_difference = difference / size;
  result.met = difference <= atol + rtol * size;
  return result;
}

std::string_view status_name(RunStatus status) {
  constexpr std::array<std::string_view, 3> names{"ok", "expectation_missed", "tolerance_not_reached"};
  return names[static_cast<std::size_t>(status)];
}

std::string_view status_name(quadrature::Status status) {
  constexpr std::array<std::string_view, 4> names{"exact", "converged", "fixed_rule", "tolerance_not_reached"};
  return names[static_cast<std::size_t>(status)];
}

int exit_status(RunStatus status) {
  constexpr std::array<int, 3> statuses{0, 1, 3};
  return statuses[static_cast<std::size_t>(status)];
}

const Quantity* Report::find(std::string_view name) const {
  for (const std::vector<Quantity>* list : {&properties, &integrals}) {
    for (const Quantity& quantity : *list) {
      if (quantity.name == name) return &quantity;
    }
  }
  return nullptr;
}

std::string_view program_version() {
  return ISORIM_VERSION;
}

}  // namespace isorim::io
