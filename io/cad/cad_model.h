#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/trimming/loose_face.h"
#include "geometry/tspline/extracted_surface.h"

/// What a CAD file holds, whichever format it has, before anything is matched, closed or oriented.
namespace isorim::io {

/// Red, green, blue in [0, 1].
using Colour = std::array<double, 3>;

/// Where in its file something stands and how it looks there.
struct CadOrigin {
  /// "144 at D35", "ADVANCED_FACE #120".
  std::string entity;
  /// The name that the file gives it; empty if none.
  std::string name;
  std::optional<Colour> colour;
  /// Level (layer) number; 0 if none.
  int level = 0;
};

struct CadFace {
  geometry::LooseFace face;
  CadOrigin origin;
  /// Index of the solid whose shell it belongs to; -1 for a loose face.
  int solid = -1;
};

/// A surface that the file gives by its Bézier extraction.
struct CadTSpline {
  geometry::ExtractedSurface surface;
  CadOrigin origin;
  /// As in CadFace.
  int solid = -1;
};

/// A curve that no face uses.
struct CadCurve {
  geometry::NurbsCurve<3> curve;
  CadOrigin origin;
};

struct EntityCount {
  /// "144", "128", or STEP's entity name.
  std::string type;
  /// "trimmed parametric surface".
  std::string description;
  int count = 0;
  /// How many of them were left out because this program does not read them.
  int unsupported = 0;
};

/// What has no exact rational form and was approximated.
struct Approximation {
  /// "130 (offset curve) at D21".
  std::string entity;
  /// Largest distance from the exact shape, in the file's unit: what was asked for and what was found.
  double tolerance = 0.0;
  double deviation = 0.0;
};

struct CadModel {
  /// "IGES 5.3", "STEP AP214".
  std::string format;
  /// Which reader made it: "isorim" or "OpenCASCADE 7.6.3".
  std::string reader;
  /// The file's unit: "mm", "in", ... and its length in millimetres. Coordinates are in this unit. Empty if the format
  /// knows no units.
  std::string unit = "mm";
  double unit_in_millimetres = 1.0;
  /// The program that wrote the file, as it calls itself; empty if unknown.
  std::string author;
  /// In the order of the file, placed where the file's transformations put them.
  std::vector<CadFace> faces;
  std::vector<CadTSpline> t_splines;
  std::vector<CadCurve> curves;
  std::vector<geometry::Point3> points;
  std::vector<EntityCount> entities;
  std::vector<Approximation> approximations;
  /// What the user should know: entities left out, blanked ones, flags that contradict the data, ...
  std::vector<std::string> warnings;
};

}  // namespace isorim::io
