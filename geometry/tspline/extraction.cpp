#include "geometry/tspline/extraction.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {

namespace {

/// The element of a knot span in each direction of a surface with count_u functions in the first.
ExtractionElement element_of(const ExtractionOperator& u, const ExtractionOperator& v, Eigen::Index count_u) {
  const Eigen::Index p = u.matrix.rows();
  const Eigen::Index q = v.matrix.rows();
  ExtractionElement element;
  element.degree = {static_cast<std::int8_t>(p - 1), static_cast<std::int8_t>(q - 1)};
  element.domain = {u.domain, v.domain};
  element.rows.resize(p * q, p * q);
  for (Eigen::Index j = 0; j < q; ++j) {
    for (Eigen::Index i = 0; i < p; ++i) {
      element.functions.push_back(static_cast<std::int32_t>(u.first_function + i + (v.first_function + j) * count_u));
      for (Eigen::Index b = 0; b < q; ++b)
        for (Eigen::Index a = 0; a < p; ++a) element.rows(i + j * p, a + b * p) = u.matrix(i, a) * v.matrix(j, b);
    }
  }
  return element;
}

ExtractedSurface surface_of(const Patch<3>& patch) {
  struct Extractor {
    ExtractedSurface operator()(const NurbsSurface<3>& surface) const { return extracted_surface(surface); }
    ExtractedSurface operator()(const ExtractedSurface& surface) const { return surface; }
    ExtractedSurface operator()(const TrimmedSurface&) const {
      throw GeometryError("it is trimmed; expected whole surfaces, whose elements are all there");
    }
  };
  try {
    ExtractedSurface surface = std::visit(Extractor{}, patch.shape);
    return patch.orientation < 0 ? reversed(surface) : surface;
  } catch (GeometryError& error) {
    error.add_context(fmt::format("patch \"{}\"", patch.name));
    throw;
  }
}

}  // namespace

ExtractedSurface extracted_surface(const NurbsSurface<3>& surface) {
  const std::vector<ExtractionOperator> in_u = extraction_operators(surface.knots_u());
  const std::vector<ExtractionOperator> in_v = extraction_operators(surface.knots_v());
  std::vector<ExtractionElement> elements;
  elements.reserve(in_u.size() * in_v.size());
  for (const ExtractionOperator& v : in_v)
    for (const ExtractionOperator& u : in_u) elements.push_back(element_of(u, v, surface.count_u()));
  return {surface.homogeneous(), std::move(elements)};
}

ExtractedSurface reversed(const ExtractedSurface& surface) {
  std::vector<ExtractionElement> elements = surface.elements();
  for (ExtractionElement& element : elements) {
    const Eigen::Index p = element.degree[0] + 1;
    for (Eigen::Index row = 0; row < element.rows.cols(); row += p)
      element.rows.middleCols(row, p) = element.rows.middleCols(row, p).rowwise().reverse().eval();
    element.domain[0] = {-element.domain[0].last, -element.domain[0].first};
  }
  return {surface.homogeneous(), std::move(elements)};
}

ExtractedSurface extracted_surface(const Boundary<3>& boundary) {
  if (boundary.patches.size() == 1) return surface_of(boundary.patches.front());
  HomogeneousPoints<3> points(4, 0);
  std::vector<ExtractionElement> elements;
  for (const Patch<3>& patch : boundary.patches) {
    const ExtractedSurface own = surface_of(patch);
    const auto first = static_cast<std::int32_t>(points.cols());
    points.conservativeResize(Eigen::NoChange, points.cols() + own.homogeneous().cols());
    points.rightCols(own.homogeneous().cols()) = own.homogeneous();
    for (ExtractionElement element : own.elements()) {
      for (std::int32_t& function : element.functions) function += first;
      elements.push_back(std::move(element));
    }
  }
  return {std::move(points), std::move(elements)};
}

}  // namespace isorim::geometry
