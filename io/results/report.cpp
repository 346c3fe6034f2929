#include "io/results/report.h"

#include <algorithm>
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
  switch (status) {
    case RunStatus::ok:
      return "ok";
    case RunStatus::expectation_missed:
      return "expectation_missed";
    case RunStatus::tolerance_not_reached:
      return "tolerance_not_reached";
  }
  return "unknown";
}

std::string_view status_name(quadrature::Status status) {
  switch (status) {
    case quadrature::Status::exact:
      return "exact";
    case quadrature::Status::converged:
      return "converged";
    case quadrature::Status::limited_by_rounding:
      return "limited_by_rounding";
    case quadrature::Status::fixed_rule:
      return "fixed_rule";
    case quadrature::Status::tolerance_not_reached:
      return "tolerance_not_reached";
  }
  return "unknown";
}

int exit_status(RunStatus status) {
  switch (status) {
    case RunStatus::ok:
      return 0;
    case RunStatus::expectation_missed:
      return 1;
    case RunStatus::tolerance_not_reached:
      break;
  }
  return 3;
}

const Quantity* Report::find(std::string_view name) const {
  for (const std::vector<Quantity>* list :
       {&properties, &integrals, &fit_quantities, &propeller_quantities, &hull_quantities}) {
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
