#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/case/analysis_keys.h"
#include "io/case/schema.h"

/// [added_mass]: the inertia of the fluid around a solid.
namespace isorim::io {

struct AddedMassKeys {
  double water_density = 1.0;
  /// Of a hull: the double body to this draught. Absent: the solid as it is, in an unbounded fluid.
  std::optional<double> draught;
  std::optional<double> baseline;
  std::optional<Coordinates> centre;
  int degree = 3;
  int refine = 1;
  int edge_layers = 3;
  SolveMethodKind method = SolveMethodKind::automatic;
  double tolerance = 1e-8;
  KeyPlace where;
};

/// What [expect] may name: the matrix, the mass that it is compared with, and its diagonal over the displaced mass or
/// moment of inertia, by the names of the motions.
std::vector<std::string> added_mass_quantity_names();

}  // namespace isorim::io
