#pragma once

#include "geometry/bezier/element_table.h"
#include "io/case/case_file.h"
#include "solver/bem/problem.h"

namespace isorim::io {

/// The equation with the constants of [material]; plane stress by its equivalent plane strain.
template <int Dim>
solver::Equation<Dim> equation(const CaseKeys& keys, const geometry::ElementTable<Dim>& table);

/// Poisson's source and the parts of [body_force], in closed form where they are constant. Errors as the solver's.
template <int Dim>
solver::Loads<Dim> case_loads(const CaseFile& file, const solver::Equation<Dim>& equation,
                              const geometry::ElementTable<Dim>& table);

}  // namespace isorim::io
