#include "geometry/fitting/knot_placement.h"

#include <algorithm>
#include <cmath>

namespace isorim::geometry {

namespace {

/// The parameter at a fractional index.
double at_index(std::span<const double> parameters, double place) {
  const double last = static_cast<double>(parameters.size() - 1);
  const std::size_t i = static_cast<std::size_t>(std::clamp(place, 0.0, last));
  if (i + 1 >= parameters.size()) return parameters.back();
  const double a = std::clamp(place, 0.0, last) - static_cast<double>(i);
  return (1.0 - a) * parameters[i] + a * parameters[i + 1];
}

/// The same on a closed curve: index m is the first parameter again, one period on.
double at_cyclic_index(std::span<const double> parameters, double place) {
  const double count = static_cast<double>(parameters.size());
  const double turns = std::floor(place / count);
  const double inside = place - turns * count;
  const std::size_t i = std::min(static_cast<std::size_t>(inside), parameters.size() - 1);
  const double a = inside - static_cast<double>(i);
  const double next = i + 1 < parameters.size() ? parameters[i + 1] : parameters.front() + 1.0;
  return turns + (1.0 - a) * parameters[i] + a * next;
}

}  // namespace

std::vector<double> uniform_knots(double first, double last, int count) {
  std::vector<double> knots(static_cast<std::size_t>(count));
  for (int k = 1; k <= count; ++k)
    knots[static_cast<std::size_t>(k) - 1] = first + (last - first) * static_cast<double>(k) / (count + 1);
  return knots;
}

std::vector<double> averaged_knots(std::span<const double> parameters, int degree, int count, int at_start) {
  const std::size_t wanted = static_cast<std::size_t>(count + degree + 1);
  std::vector<double> chosen(parameters.begin(), parameters.end());
  if (chosen.size() > wanted) {
    chosen.resize(wanted);
    const double step = static_cast<double>(parameters.size() - 1) / static_cast<double>(wanted - 1);
    for (std::size_t i = 0; i < wanted; ++i) chosen[i] = at_index(parameters, static_cast<double>(i) * step);
  }
  const std::size_t missing = wanted - chosen.size();
  chosen.insert(chosen.begin(), std::min(missing, static_cast<std::size_t>(at_start)), parameters.front());
  chosen.resize(wanted, parameters.back());
  std::vector<double> knots(static_cast<std::size_t>(count));
  for (std::size_t j = 0; j < knots.size(); ++j) {
    double sum = 0.0;
    for (std::size_t i = j + 1; i <= j + static_cast<std::size_t>(degree); ++i) sum += chosen[i];
    knots[j] = sum / degree;
  }
  return knots;
}

std::vector<double> piegl_tiller_knots(std::span<const double> parameters, int count) {
  const double spacing = static_cast<double>(parameters.size()) / (count + 1);
  std::vector<double> knots(static_cast<std::size_t>(count));
  for (int k = 1; k <= count; ++k) knots[static_cast<std::size_t>(k) - 1] = at_index(parameters, k * spacing - 1.0);
  return knots;
}

std::vector<double> closed_piegl_tiller_knots(std::span<const double> parameters, int count) {
  const double spacing = static_cast<double>(parameters.size()) / count;
  std::vector<double> knots(static_cast<std::size_t>(count) + 1);
  for (int k = 0; k < count; ++k) knots[static_cast<std::size_t>(k)] = at_cyclic_index(parameters, k * spacing);
  knots.back() = knots.front() + 1.0;
  return knots;
}

std::vector<double> closed_averaged_knots(std::span<const double> parameters, int degree, int count) {
  const double spacing = static_cast<double>(parameters.size()) / count;
  std::vector<double> knots(static_cast<std::size_t>(count) + 1);
  for (int k = 0; k < count; ++k) {
    double& knot = knots[static_cast<std::size_t>(k)];
    knot = at_cyclic_index(parameters, k * spacing);
    if (degree % 2 == 0) knot = 0.5 * (knot + at_cyclic_index(parameters, (k - 1) * spacing));
  }
  knots.back() = knots.front() + 1.0;
  return knots;
}

}  // namespace isorim::geometry
