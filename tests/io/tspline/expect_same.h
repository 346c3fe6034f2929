#pragma once

#include <algorithm>
#include <cstddef>

#include <gtest/gtest.h>

#include "geometry/tspline/extracted_surface.h"

namespace isorim::io::tspline {

/// The same elements, functions and coefficients, bit for bit.
inline void expect_same_rows(const geometry::ExtractedSurface& a, const geometry::ExtractedSurface& b) {
  EXPECT_EQ(a.function_count(), b.function_count());
  ASSERT_EQ(a.elements().size(), b.elements().size());
  for (std::size_t e = 0; e < a.elements().size(); ++e) {
    EXPECT_EQ(a.elements()[e].degree, b.elements()[e].degree) << "element " << e;
    EXPECT_EQ(a.elements()[e].functions, b.elements()[e].functions) << "element " << e;
    EXPECT_EQ(a.elements()[e].rows, b.elements()[e].rows) << "element " << e;
  }
}

/// With domains and points.
inline void expect_same_bits(const geometry::ExtractedSurface& a, const geometry::ExtractedSurface& b) {
  expect_same_rows(a, b);
  for (std::size_t e = 0; e < std::min(a.elements().size(), b.elements().size()); ++e) {
    for (std::size_t d = 0; d < 2; ++d) {
      EXPECT_EQ(a.elements()[e].domain[d].first, b.elements()[e].domain[d].first) << "element " << e;
      EXPECT_EQ(a.elements()[e].domain[d].last, b.elements()[e].domain[d].last) << "element " << e;
    }
  }
  EXPECT_EQ(a.homogeneous(), b.homogeneous());
}

}  // namespace isorim::io::tspline
