#pragma once

#include <filesystem>

#include "io/results/compute.h"
#include "io/results/report.h"

namespace isorim::io {

/// Writes results.h5: the tree of results.json as groups, with numbers as datasets and facts as attributes, and the
/// boundary itself, so that everything can be computed again from this file:
///
///   /                       attributes isorim, case, status, threads; dataset resolved_case (text)
///   /geometry               attributes as in results.json; dataset patch_names; of a CAD file also patch_entities,
///                           patch_solids (-1: loose), patch_levels, patch_colours (patches x 3, NaN: none)
///   /geometry/elements      nets: points x (Dim + 1), homogeneous, element by element, the first parameter fastest;
///                           offsets: elements + 1, in points; degrees: elements x (Dim - 1);
///                           domains: elements x (Dim - 1) x 2; patch, orientation, polynomial: elements;
///                           region: elements, the index of a cut element's region, else -1
///   /geometry/regions       if there are cut elements: offsets: regions + 1, in curves; curve_offsets: curves + 1,
///                           in points; points: points x 3, homogeneous (w s, w t, w) in the element's unit cell,
///                           curve by curve: Bézier curves with the kept part on their left
///   /properties/NAME        datasets value, error; attributes evaluations, status, reason where they apply
///   /integrals/NAME         the same
///   /expectations/NAME      datasets value, expected; attributes error, difference, rtol, atol, met
///   /analysis               of an analysis: attributes equation, method, unknowns, ... as in results.json
///   /analysis/errors        attributes
///   /analysis/boundary_conditions/NAME   attributes kind, elements, measure; datasets flux, or force and moment
///   /analysis/probes/NAME, grids/NAME    points x Dim; location (1 inside, 0 boundary, -1 outside); value, gradient,
///                           stress, von_mises, principal: a row a point (grids also counts)
///   /analysis/space         elements and regions as in /geometry; degrees, rational, first_function,
///                           function_count, functions, first_row, rows: see solver/bem/field_space.h; condition;
///                           collocation_points; potential and flux: coefficients, a row a function
///   /timings                attributes read, integrate, write (seconds)
///
/// The file appears whole or not at all. Throws InputError with the path if it cannot be written.
void write_hdf5(const std::filesystem::path& path, const Report& report, const AnyModel& model);

}  // namespace isorim::io
