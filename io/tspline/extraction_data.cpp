#include "io/tspline/extraction_data.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io::tspline {

using geometry::ExtractedSurface;
using geometry::ExtractionElement;
using geometry::HomogeneousPoints;

namespace {

/// Sets of functions that live together on some element.
class FunctionSets {
 public:
  explicit FunctionSets(int count) : parents_(static_cast<std::size_t>(count)) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  int find(int function) {
    while (parent(function) != function) function = parent(function) = parent(parent(function));
    return function;
  }
  /// The representative is the smallest.
  void unite(int a, int b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent(high) = low;
  }

 private:
  int& parent(int function) { return parents_[static_cast<std::size_t>(function)]; }

  std::vector<int> parents_;
};

/// One part on its way.
struct Part {
  std::vector<std::int32_t> functions;
  std::vector<ExtractionElement> elements;
};

/// Parts by the numbers of their functions in the whole.
std::vector<Part> split(const ExtractedSurface& surface) {
  FunctionSets sets(surface.function_count());
  for (const ExtractionElement& element : surface.elements())
    for (const std::int32_t function : element.functions) sets.unite(element.functions.front(), function);
  std::vector<int> part_of(static_cast<std::size_t>(surface.function_count()), -1);
  std::vector<Part> parts;
  for (const ExtractionElement& element : surface.elements()) {
    int& part = part_of[static_cast<std::size_t>(sets.find(element.functions.front()))];
    if (part < 0) {
      part = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    Part& own = parts[static_cast<std::size_t>(part)];
    own.elements.push_back(element);
    own.functions.insert(own.functions.end(), element.functions.begin(), element.functions.end());
  }
  for (Part& part : parts) {
    std::ranges::sort(part.functions);
    part.functions.erase(std::unique(part.functions.begin(), part.functions.end()), part.functions.end());
  }
  return parts;
}

ExtractedSurface surface_of(Part part, const HomogeneousPoints<3>& points) {
  HomogeneousPoints<3> own(4, static_cast<Eigen::Index>(part.functions.size()));
  for (std::size_t i = 0; i < part.functions.size(); ++i)
    own.col(static_cast<Eigen::Index>(i)) = points.col(part.functions[i]);
  for (ExtractionElement& element : part.elements) {
    for (std::int32_t& function : element.functions)
      function = static_cast<std::int32_t>(std::ranges::lower_bound(part.functions, function) - part.functions.begin());
  }
  return {std::move(own), std::move(part.elements)};
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::vector<ExtractedSurface> connected_parts(ExtractedSurface surface) {
  std::vector<Part> parts = split(surface);
  std::vector<ExtractedSurface> result;
  if (parts.size() == 1 && parts.front().functions.size() == static_cast<std::size_t>(surface.function_count())) {
    result.push_back(std::move(surface));
    return result;
  }
  for (Part& part : parts) result.push_back(surface_of(std::move(part), surface.homogeneous()));
  return result;
}

CadModel model_of(ExtractionData data, std::string_view format) {
  CadModel model;
  model.format = format;
  model.reader = "isorim";
  model.unit = "";
  model.entities = std::move(data.entities);
  model.warnings = std::move(data.warnings);
  const auto given = static_cast<std::size_t>(data.points.cols());
  try {
    std::size_t used = 0;
    for (ExtractedSurface& part : connected_parts({std::move(data.points), std::move(data.elements)})) {
      used += static_cast<std::size_t>(part.function_count());
      model.t_splines.push_back({std::move(part), {}, -1});
    }
    if (used < given)
      model.warnings.push_back(
          fmt::format("{} on no element: left out", counted(given - used, "function lives", "functions live")));
  } catch (const GeometryError& error) {
    throw InputError(error.what());
  }
  return model;
}

}  // namespace isorim::io::tspline
