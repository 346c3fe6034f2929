#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vocabulary.h"
#include "solver/bem/field_space.h"

namespace isorim::solver {

/// The functions and collocation points of one patch; elements and functions are counted from 0.
template <int Dim>
struct PatchSpace {
  std::vector<FieldElement<Dim>> elements;
  std::vector<std::int32_t> functions;
  std::vector<double> rows;
  struct Place {
    int element = 0;
    geometry::Point<Dim - 1> place;
  };
  /// One for each function.
  std::vector<Place> points;
};

}  // namespace isorim::solver
