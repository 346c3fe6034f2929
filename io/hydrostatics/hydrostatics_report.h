#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "io/case/case_file.h"
#include "io/results/json_parts.h"
#include "io/results/report.h"
#include "solver/hydrostatics/floating_body.h"

/// What [hydrostatics] asks for: computed, and told in every form.
namespace isorim::io {

/// Columns of numbers with names. A number that does not exist is not a number.
struct NumberTable {
  /// "curves_of_form", "bonjean", "equilibria", "righting_arms", "cross_curves".
  std::string name;
  std::vector<std::string> columns;
  /// One list a column, all of one length.
  std::vector<std::vector<double>> values;
  /// Estimated absolute errors, like `values`; empty if none are known.
  std::vector<std::vector<double>> errors;

  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  const std::vector<double>& column(const std::string& column_name) const;
};

struct HydrostaticsReport {
  /// The hydrostatics at one attitude: hydrostatics_columns() that exist there.
  std::vector<Quantity> quantities;
  std::vector<NumberTable> tables;
  /// righting_scalars() that exist.
  std::vector<Quantity> righting;
  double baseline = 0.0;
  geometry::Point2 origin = geometry::Point2::Zero();
  double water_density = 1.0;
  /// Of the shape; empty if unknown.
  std::string unit;
  /// What a user should know: unstable, sinks, tolerance not reached.
  std::vector<std::string> warnings;

  const NumberTable* find(const std::string& name) const;
};

/// Of a closed, oriented boundary. `keys` is [hydrostatics] of the case; gaps of up to twice `largest_gap`, a length,
/// are bridged in transverse sections. Throws GeometryError where the boundary cannot
/// be cut, InputError where the loading makes no sense.
HydrostaticsReport compute_hydrostatics(const HydrostaticsKeys& keys, const geometry::Boundary<3>& boundary,
                                        double largest_gap, const solver::FloatingBodyOptions& options,
                                        const std::function<void(double)>& progress);

/// "hydrostatics.volume", "curves_of_form.volume" (one value a draught), "righting_arms.vanishing_heel", ...
std::vector<Quantity> expected_quantities(const HydrostaticsReport& report);

/// What results.json says under "hydrostatics".
Json hydrostatics_json(const HydrostaticsReport& report);

/// The lines of the terminal.
std::string hydrostatics_text(const HydrostaticsReport& report);

/// TABLE.csv of each table, and if `output.svg` curves_of_form.svg, bonjean.svg, righting_arms.svg, cross_curves.svg.
void write_hydrostatics(const std::filesystem::path& folder, const HydrostaticsReport& report,
                        const OutputKeys& output);

}  // namespace isorim::io
