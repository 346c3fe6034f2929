#pragma once

#include <vector>

#include "geometry/bezier/element_table.h"
#include "solver/bem/field_space.h"
#include "solver/bem/solve.h"

namespace isorim::io {

/// The boundary of an analysis with its fields in the elements' own rational Bézier bases: exact, by raising degrees
/// and, for a polynomial field on a rational element, by multiplying with the weights.
template <int Dim>
struct SolutionCells {
  /// The elements of the space, their nets raised to the degree that field and geometry have in common.
  geometry::ElementTable<Dim> table;
  /// components x control points, as write_vtu() takes point fields: sum N_i w_i f_i / sum N_i w_i is the field.
  std::vector<double> potential;
  std::vector<double> flux;
  int components = 1;
};

template <int Dim>
SolutionCells<Dim> solution_cells(const solver::FieldSpace<Dim>& space, const solver::Solution<Dim>& solution);

}  // namespace isorim::io
