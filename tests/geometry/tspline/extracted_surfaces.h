#pragma once

#include <cstdint>
#include <utility>
#include <vector>

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

}  // namespace isorim::geometry::testing
