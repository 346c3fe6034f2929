#pragma once

#include <filesystem>

#include "io/results/compute.h"
#include "io/results/report.h"

namespace isorim::io {

/// Writes results.h5: the tree of results.json as groups, with numbers as datasets and facts as attributes, and the
/// boundary itself, so that everything can be computed again from this file:
///
///   /                       attributes isorim, case, status, threads; dataset resolved_case (text)
///   /geometry               attributes as in results.json; dataset patch_names
///   /geometry/elements      nets: points x (Dim + 1), homogeneous, element by element, the first parameter fastest;
///                           offsets: elements + 1, in points; degrees: elements x (Dim - 1);
///                           domains: elements x (Dim - 1) x 2; patch, orientation, polynomial: elements
///   /properties/NAME        datasets value, error; attributes evaluations, status, reason where they apply
///   /integrals/NAME         the same
///   /expectations/NAME      datasets value, expected; attributes error, difference, rtol, atol, met
///   /timings                attributes read, integrate, write (seconds)
///
/// The file appears whole or not at all. Throws InputError with the path if it cannot be written.
void write_hdf5(const std::filesystem::path& path, const Report& report, const AnyModel& model);

}  // namespace isorim::io
