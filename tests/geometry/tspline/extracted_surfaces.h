#pragma once

#include <array>
#include <utility>
#include <vector>

#include "geometry/bezier/subdivision.h"
#include "geometry/boundary.h"
#include "geometry/nurbs/surface.h"
#include "geometry/tspline/extracted_surface.h"
#include "geometry/tspline/extraction.h"

/// Extracted surfaces whose shape is known otherwise.
namespace isorim::geometry::testing {

/// Every patch, which is a whole NURBS surface, by its elements.
inline Boundary<3> extracted(Boundary<3> boundary) {
  for (Patch<3>& patch : boundary.patches) patch.shape = extracted_surface(std::get<NurbsSurface<3>>(patch.shape));
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

}  // namespace isorim::geometry::testing
