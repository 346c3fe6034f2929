#pragma once

#include <string>
#include <vector>

/// The names of what [hydrostatics] gives: keys of results.json, columns of the CSV files, names for [expect].
namespace isorim::io {

/// Of one attitude. Angles in degrees.
const std::vector<std::string>& hydrostatics_columns();
const std::vector<std::string>& bonjean_columns();
const std::vector<std::string>& equilibrium_columns();
const std::vector<std::string>& righting_columns();
/// Of the whole curve of righting arms.
const std::vector<std::string>& righting_scalars();
const std::vector<std::string>& cross_columns();

}  // namespace isorim::io
