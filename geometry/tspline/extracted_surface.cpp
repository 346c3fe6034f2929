#include "geometry/tspline/extracted_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/validation.h"

namespace isorim::geometry {

namespace {

using Coefficients = Eigen::RowVectorXd;

std::string element_name(std::size_t index) {
  return fmt::format("extracted surface: element {}", index);
}

void require_degrees(const ExtractionElement& element, const std::string& name) {
  for (const int degree : element.degree)
    if (degree < 1 || degree > KnotVector::max_degree)
      throw GeometryError(
          fmt::format("{}: degree {} is out of range; expected 1 to {}", name, degree, KnotVector::max_degree));
}

void require_domain(const ExtractionElement& element, const std::string& name) {
  for (const Interval& side : element.domain)
    if (!std::isfinite(side.length()) || !(side.length() > 0.0))
      throw GeometryError(
          fmt::format("{}: its domain from {} to {} is empty or not finite", name, side.first, side.last));
}

void require_functions(const ExtractionElement& element, Eigen::Index function_count, const std::string& name) {
  if (element.functions.empty()) throw GeometryError(fmt::format("{}: no function lives on it", name));
  std::vector<std::int32_t> sorted = element.functions;
  std::ranges::sort(sorted);
  for (const std::int32_t end : {sorted.front(), sorted.back()})
    if (end < 0 || end >= function_count)
      throw GeometryError(
          fmt::format("{}: function {} does not exist; expected 0 to {}", name, end, function_count - 1));
  const auto twice = std::ranges::adjacent_find(sorted);
  if (twice != sorted.end()) throw GeometryError(fmt::format("{}: function {} is listed twice", name, *twice));
}

void require_rows(const ExtractionElement& element, const std::string& name) {
  const Eigen::Index length = (element.degree[0] + 1) * (element.degree[1] + 1);
  const auto count = static_cast<Eigen::Index>(element.functions.size());
  if (element.rows.rows() != count || element.rows.cols() != length)
    throw GeometryError(fmt::format(
        "{}: {} rows of {} coefficients given; {} functions of degree ({}, {}) need {} x {}", name, element.rows.rows(),
        element.rows.cols(), count, element.degree[0], element.degree[1], count, length));
  if (element.rows.allFinite()) return;
  for (Eigen::Index k = 0; k < count; ++k)
    for (Eigen::Index j = 0; j < length; ++j)
      if (!std::isfinite(element.rows(k, j)))
        throw GeometryError(fmt::format("{}: coefficient {} of function {} is {}; expected a finite number", name, j,
                                        element.functions[static_cast<std::size_t>(k)], element.rows(k, j)));
}

/// The functions of the element sum to one but for the rounding of their coefficients.
bool sums_to_one(const ExtractionElement& element) {
  const Coefficients sums = element.rows.colwise().sum();
  const double magnitude = element.rows.cwiseAbs().colwise().sum().maxCoeff();
  const double tolerance = partition_rounding * std::max(1.0, magnitude);
  return ((sums.array() - 1.0).abs() <= tolerance).all();
}

HomogeneousPoints<3> bezier_net_of(const HomogeneousPoints<3>& points, const ExtractionElement& element) {
  HomogeneousPoints<3> local(4, element.rows.rows());
  for (Eigen::Index k = 0; k < local.cols(); ++k)
    local.col(k) = points.col(element.functions[static_cast<std::size_t>(k)]);
  HomogeneousPoints<3> net = local.lazyProduct(element.rows);
  const double weight = local(3, 0);
  if ((local.row(3).array() == weight).all() && sums_to_one(element)) net.row(3).setConstant(weight);
  return net;
}

void require_valid(const HomogeneousPoints<3>& points, const ExtractionElement& element, std::size_t index) {
  const std::string name = element_name(index);
  require_degrees(element, name);
  require_domain(element, name);
  require_functions(element, points.cols(), name);
  require_rows(element, name);
  require_valid_net<3>(bezier_net_of(points, element), name + " in Bézier form", [&](Eigen::Index j) {
    return fmt::format("({}, {})", j % (element.degree[0] + 1), j / (element.degree[0] + 1));
  });
}

}  // namespace

ExtractedSurface::ExtractedSurface(HomogeneousPoints<3> homogeneous, std::vector<ExtractionElement> elements)
    : homogeneous_(std::move(homogeneous)), elements_(std::move(elements)) {
  if (elements_.empty()) throw GeometryError("extracted surface: it has no elements");
  if (homogeneous_.cols() > std::numeric_limits<std::int32_t>::max())
    throw GeometryError(fmt::format("extracted surface: {} functions are too many", homogeneous_.cols()));
  require_valid_net<3>(homogeneous_, "extracted surface", [](Eigen::Index i) { return std::to_string(i); });
  for (std::size_t e = 0; e < elements_.size(); ++e) require_valid(homogeneous_, elements_[e], e);
}

std::vector<double> partition_defects(const ExtractedSurface& surface) {
  std::vector<double> defects;
  defects.reserve(surface.elements().size());
  for (const ExtractionElement& element : surface.elements()) {
    const Coefficients sums = element.rows.colwise().sum();
    defects.push_back((sums.array() - 1.0).abs().maxCoeff());
  }
  return defects;
}

HomogeneousPoints<3> bezier_net(const ExtractedSurface& surface, int element) {
  return bezier_net_of(surface.homogeneous(), surface.elements()[static_cast<std::size_t>(element)]);
}

NurbsSurface<3> bezier_surface(const ExtractedSurface& surface, int element) {
  const std::array<std::int8_t, 2>& degree = surface.elements()[static_cast<std::size_t>(element)].degree;
  return {KnotVector::bezier(degree[0]), KnotVector::bezier(degree[1]), bezier_net(surface, element)};
}

ExtractedSurface transform(const ExtractedSurface& surface, const AffineMap<3>& map) {
  HomogeneousPoints<3> net = surface.homogeneous();
  net.topRows<3>() = map.linear * surface.homogeneous().topRows<3>() + map.translation * surface.homogeneous().row(3);
  return {std::move(net), surface.elements()};
}

}  // namespace isorim::geometry
