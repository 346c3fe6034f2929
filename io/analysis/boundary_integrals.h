#pragma once

#include "io/analysis/analysis.h"

namespace isorim::io {

/// Fills in what the solution gives when it is integrated over the boundary: the flux or force (and moment) of every
/// condition, their balance with the loads, and the integrals of the case that name the solution. Prescribed data enter
/// as they are prescribed. Throws NumericalError, naming the integral and the place, if a value is not finite.
template <int Dim>
void add_boundary_integrals(const CaseFile& file, const RunOptions& run, Analysis<Dim>& analysis);

}  // namespace isorim::io
