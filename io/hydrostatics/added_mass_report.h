#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/topology/orientation.h"
#include "io/case/added_mass_keys.h"
#include "io/results/json_parts.h"
#include "io/results/report.h"
#include "solver/bem/added_mass.h"

/// What [added_mass] asks for: computed, and told in every form.
namespace isorim::io {

struct AddedMassReport {
  /// Times the density; at a draught those of the part under water alone, half of the double body's.
  solver::AddedMass result;
  double water_density = 1.0;
  geometry::Point3 centre = geometry::Point3::Zero();
  /// z of the water of a double body.
  std::optional<double> waterplane;
  /// Seconds.
  double time = 0.0;
};

/// Of a closed, oriented boundary. Throws GeometryError where the keys make no sense for it (a draught that covers all
/// of the solid, a centre out of the water of a double body), and as solver::added_mass() does.
AddedMassReport compute_added_mass(const AddedMassKeys& keys, const geometry::OrientedBoundary<3>& boundary,
                                   int threads, const std::function<void(double)>& progress);

/// added_mass_quantity_names().
std::vector<Quantity> expected_quantities(const AddedMassReport& report);

/// What results.json says under "added_mass".
Json added_mass_json(const AddedMassReport& report);

/// The lines of the terminal.
std::string added_mass_text(const AddedMassReport& report);

}  // namespace isorim::io
