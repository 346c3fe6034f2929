#pragma once

#include <span>

#include "geometry/topology/orientation.h"
#include "solver/bem/field_space.h"

namespace isorim::solver {

/// The boundary with knots inserted in the middles of the marked elements of a space on it; its shape stays exactly the
/// same, and field_space() has elements half as large there. Curves are refined locally; of surfaces the knot lines run
/// through the whole patch. Functions are as smooth at the new knots as the patch is: raise the degree of a straight
/// patch first (raise_degree()), lest they have kinks there.
///
/// Throws InputError for a marked element of a trimmed or extracted surface.
template <int Dim>
geometry::OrientedBoundary<Dim> bisect_elements(const geometry::OrientedBoundary<Dim>& boundary,
                                                const FieldSpace<Dim>& space, std::span<const int> marked);

/// The boundary with all patches of at least that degree (in both directions); trimmed and extracted surfaces stay.
template <int Dim>
geometry::OrientedBoundary<Dim> raise_degree(const geometry::OrientedBoundary<Dim>& boundary, int degree);

}  // namespace isorim::solver
