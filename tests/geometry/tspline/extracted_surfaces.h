#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/bezier/subdivision.h"
#include "geometry/boundary.h"
#include "geometry/nurbs/surface.h"
#include "geometry/spline/bspline.h"
#include "geometry/tspline/extracted_surface.h"

/// Extracted surfaces whose shape is known otherwise.
namespace isorim::geometry::testing {

/// The surface by its elements: the functions are the B-splines, the domains its knot spans, u fastest.
inline ExtractedSurface extracted(const NurbsSurface<3>& surface) {
  std::vector<ExtractionElement> elements;
  for (const ExtractionOperator& v : extraction_operators(surface.knots_v())) {
    for (const ExtractionOperator& u : extraction_operators(surface.knots_u())) {
      const Eigen::Index p = u.matrix.rows();
      const Eigen::Index q = v.matrix.rows();
      ExtractionElement element{{static_cast<std::int8_t>(p - 1), static_cast<std::int8_t>(q - 1)},
                                {},
                                Eigen::MatrixXd(p * q, p * q),
                                {u.domain, v.domain}};
      for (Eigen::Index j = 0; j < q; ++j)
        for (Eigen::Index i = 0; i < p; ++i) {
          element.functions.push_back(
              static_cast<std::int32_t>(u.first_function + i + (v.first_function + j) * surface.count_u()));
          for (Eigen::Index b = 0; b < q; ++b)
            for (Eigen::Index a = 0; a < p; ++a) element.rows(i + j * p, a + b * p) = u.matrix(i, a) * v.matrix(j, b);
        }
      elements.push_back(std::move(element));
    }
  }
  return {surface.homogeneous(), std::move(elements)};
}

/// Every patch, which is a whole NURBS surface, by its elements.
inline Boundary<3> extracted(Boundary<3> boundary) {
  for (Patch<3>& patch : boundary.patches) patch.shape = extracted(std::get<NurbsSurface<3>>(patch.shape));
  return boundary;
}

/// The same surface with one element cut in two, exactly: its edges across the cut face two others each.
inline ExtractedSurface cut_element(const ExtractedSurface& surface, std::size_t index, int direction,
                                    double fraction) {
  std::vector<ExtractionElement> elements = surface.elements();
  ExtractionElement& first = elements[index];
  ExtractionElement second = first;
  const std::array<int, 2> degrees{first.degree[0], first.degree[1]};
  const auto count = static_cast<int>(first.functions.size());
  const auto [a, b] =
      subdivide({first.rows.data(), static_cast<std::size_t>(first.rows.size())}, count, degrees, direction, fraction);
  first.rows = Eigen::Map<const Eigen::MatrixXd>(a.data(), count, first.rows.cols());
  second.rows = Eigen::Map<const Eigen::MatrixXd>(b.data(), count, first.rows.cols());
  Interval& low = first.domain[static_cast<std::size_t>(direction)];
  const double at = low.first + fraction * low.length();
  second.domain[static_cast<std::size_t>(direction)] = {at, low.last};
  low.last = at;
  elements.push_back(std::move(second));
  return {surface.homogeneous(), std::move(elements)};
}

/// The same element looked at from the other side: its first parameter reversed.
inline ExtractionElement reversed(ExtractionElement element) {
  const Eigen::Index p = element.degree[0] + 1;
  const Eigen::MatrixXd rows = element.rows;
  for (Eigen::Index j = 0; j < rows.cols(); ++j) element.rows.col(j) = rows.col(j - j % p + p - 1 - j % p);
  return element;
}

}  // namespace isorim::geometry::testing
