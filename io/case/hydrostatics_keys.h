#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/case/schema.h"

/// [hydrostatics]: a solid afloat.
namespace isorim::io {

/// Numbers one by one, or { from, to, step } or { from, to, count }.
struct NumberList {
  std::vector<double> values;
};

struct LoadingKeys {
  double mass = 0.0;
  Coordinates centre_of_gravity;
  KeyPlace where;
};

struct CurvesOfFormKeys {
  NumberList draughts;
  KeyPlace where;
};

struct BonjeanKeys {
  NumberList stations;
  NumberList draughts;
  KeyPlace where;
};

enum class TrimChoice { free, fixed };

struct RightingArmsKeys {
  NumberList heels;
  TrimChoice trim = TrimChoice::free;
  KeyPlace where;
};

struct CrossCurvesKeys {
  NumberList displacements;
  NumberList heels;
  KeyPlace where;
};

struct HydrostaticsKeys {
  std::optional<double> draught;
  /// Degrees.
  double trim = 0.0;
  double heel = 0.0;
  double water_density = 1.0;
  std::optional<double> baseline;
  std::optional<Coordinates> origin;
  std::optional<double> length;
  std::optional<double> beam;
  std::optional<LoadingKeys> loading;
  std::optional<CurvesOfFormKeys> curves_of_form;
  std::optional<BonjeanKeys> bonjean;
  std::optional<RightingArmsKeys> righting_arms;
  std::optional<CrossCurvesKeys> cross_curves;
  KeyPlace where;
};

/// What [expect] may name: "hydrostatics.volume", ... and the columns of the tables, "righting_arms.arm", ....
std::vector<std::string> hydrostatics_quantity_names(const HydrostaticsKeys& keys);

}  // namespace isorim::io
