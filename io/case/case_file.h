#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/case/added_mass_keys.h"
#include "io/case/analysis_keys.h"
#include "io/case/drawing_keys.h"
#include "io/case/file_shape.h"
#include "io/case/hydrostatics_keys.h"
#include "io/case/lines_plan_keys.h"
#include "io/case/plane_section_keys.h"
#include "io/case/schema.h"
#include "io/case/shape_builder.h"
#include "io/case/shape_keys.h"
#include "io/expression.h"
#include "io/fit/fit_facts.h"

/// A case file, read and validated: the keys as they stand there with their defaults filled in. The declarations are
/// in section_declarations.cpp and shape_declarations.cpp.
namespace isorim::io {

struct HullFacts;
struct PropellerFacts;

/// What to do with a boundary that has free edges when the integrals over its domain are asked for.
enum class OpenBoundary { refuse, integrate };

struct PropertiesKeys {
  double tolerance = 1e-12;
  std::optional<double> density;
  std::optional<Coordinates> pole;
  int gauss_points = 0;
  OpenBoundary open_boundary = OpenBoundary::refuse;
  double closure_tolerance = 1e-6;
  KeyPlace where;
};

enum class IntegralOver { domain, boundary };

struct IntegralKeys {
  std::string name;
  IntegralOver over = IntegralOver::domain;
  std::string integrand;
  std::optional<double> tolerance;
  std::optional<Coordinates> pole;
  KeyPlace where;
};

/// |value - expected| <= atol + rtol max|expected|, for each entry.
struct ExpectationKeys {
  NumberArray value;
  std::optional<double> rtol;
  std::optional<double> atol;
  KeyPlace where;
};

/// One table a quantity, the key being its name.
struct ExpectKeys {
  std::vector<std::pair<std::string, ExpectationKeys>> quantities;
};

struct OutputKeys {
  bool vtk = true;
  bool hdf5 = true;
  bool svg = true;
  bool stl = false;
  /// 0: geometry::TessellationOptions::default_chord of the diagonal.
  double stl_tolerance = 0.0;
  KeyPlace where;
};

/// Numbers of Gauss points: a list or { from, to, step }.
struct PointCounts {
  std::vector<int> counts;
};

struct ConvergenceKeys {
  PointCounts points;
  std::vector<std::string> quantities;
  KeyPlace where;
};

struct CaseKeys {
  std::string title;
  SourceEntry source;
  GeometryKeys geometry;
  PropertiesKeys properties;
  std::vector<IntegralKeys> integral;
  std::vector<PlaneSectionKeys> section;
  std::optional<LinesPlanKeys> lines_plan;
  std::optional<DrawingKeys> drawings;
  std::optional<MouldKeys> moulds;
  std::optional<HydrostaticsKeys> hydrostatics;
  std::optional<AddedMassKeys> added_mass;
  ExpectKeys expect;
  OutputKeys output;
  std::optional<ConvergenceKeys> convergence;
  DefinitionsKeys definitions;
  std::optional<AnalysisKeys> analysis;
  std::optional<MaterialKeys> material;
  std::vector<BoundaryConditionKeys> boundary_condition;
  std::optional<BodyForceKeys> body_force;
  std::optional<DiscretisationKeys> discretisation;
  std::optional<SolveKeys> solve;
  std::vector<ProbeKeys> probe;
  std::vector<GridKeys> grid;
  std::optional<ExactKeys> exact;
  KeyPlace where;
};

struct CaseFile {
  std::filesystem::path path;
  CaseKeys keys;
  /// Those of [definitions], sound.
  Definitions definitions;
  /// The shape that `keys.geometry` describes.
  AnyBoundary shape;
  /// If the shape comes from a CAD file.
  std::optional<CadFacts> cad;
  /// If the shape is fitted to points.
  std::optional<FitFacts> fit;
  /// If the shape is a propeller, else null.
  std::shared_ptr<const PropellerFacts> propeller;
  /// If the shape is a hull, else null.
  std::shared_ptr<const HullFacts> hull;
  /// The case with its overrides, as TOML.
  std::string resolved;

  /// The file's name without its extension.
  std::string name() const { return path.stem().string(); }
  /// The title, or the name if there is none.
  std::string title() const { return keys.title.empty() ? name() : keys.title; }
};

/// Reads a case file, puts the overrides ("path.to.key=value") into it, validates it and builds its shape. Throws
/// InputError with all complaints at once, one a line, each with file and line, key, what was found and what was
/// expected. (That loops cross or that a boundary is open shows only later, in build_model().)
CaseFile read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
                   const FileShapeOptions& options = {});

/// The same for a case that is at hand as a tree of values. Relative paths in it begin at the folder of `path`.
CaseFile read_case(const Value& root, const std::filesystem::path& path, const FileShapeOptions& options = {});

/// Relative error aimed at for a CAD file by itself: below what the edges of nearly every file are worth.
inline constexpr double cad_file_tolerance = 1e-9;

/// A CAD file (has_cad_extension()) by itself, as the case that has only [geometry] type = "file", its path and
/// [properties] tolerance = cad_file_tolerance; or a case file. Overrides and errors as for read_case().
CaseFile read_case_or_cad(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
                          const FileShapeOptions& options = {});

/// The quantities that [expect] and [convergence] may name besides the integrals, in dimension `dim`.
std::vector<std::string> property_names(int dim);

/// Those that a fitted shape has besides: "control_points", "max_distance", "rms_distance", "bending_energy",
/// "curvature_sign_changes".
std::vector<std::string> fit_quantity_names();

/// Those that a hull has besides: "prismatic" and "lcb" (per cent of the length forward of amidships) of the curve of
/// sectional areas up to the design draught, "offset_distance", and of its fairness "bending_energy" and
/// "curvature_sign_changes".
std::vector<std::string> hull_quantity_names();

/// Those that a propeller has besides: area ratios, volumes, control points (propeller_report.h).
std::vector<std::string> propeller_quantity_names();

}  // namespace isorim::io
