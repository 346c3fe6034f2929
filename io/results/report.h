#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/cad/cad_facts.h"
#include "io/fit/fit_facts.h"
#include "io/results/analysis_report.h"
#include "quadrature/estimate.h"

/// What a run found, free of dimension and of file formats: the writers of the terminal's table, results.json and
/// results.h5 all start from it.
namespace isorim::io {

struct AnyAnalysis;
struct HullFacts;
struct PropellerFacts;
struct SectionFamily;
struct HydrostaticsReport;
struct AddedMassReport;

/// A number, a vector (columns = 1) or a matrix, entry by entry along the rows.
struct Entries {
  std::vector<double> values;
  int rows = 1;
  int columns = 1;

  double largest_magnitude() const;
};

/// A single number.
Entries single(double value);

/// A property or an integral.
struct Quantity {
  std::string name;
  /// No entries if the quantity was refused.
  Entries value;
  /// Our estimates of the absolute errors: one an entry, or one for all of them. Empty if there is none.
  std::vector<double> error;
  std::optional<std::int64_t> evaluations;
  std::optional<quadrature::Status> status;
  /// Why the quantity was refused.
  std::string reason;
  /// Of several things, one entry each: told apart by numbers, not by axes.
  bool is_sequence = false;

  double largest_error() const;
};

struct ExpectationResult {
  std::string quantity;
  Entries value;
  Entries expected;
  /// Our own estimate of the absolute error of the value.
  std::optional<double> error;
  double rtol = 0.0;
  double atol = 0.0;
  /// max |value - expected|, and the same over max |expected| (absent if that is zero).
  std::optional<double> difference;
  std::optional<double> relative_difference;
  bool met = false;
};

/// Compares by |value - expected| <= atol + rtol max|expected|, every entry. A value without entries, or one that is
/// not finite, misses.
ExpectationResult compare(const Quantity& quantity, const Entries& expected, double rtol, double atol);

enum class RunStatus { ok, expectation_missed, tolerance_not_reached };

std::string_view status_name(RunStatus status);
std::string_view status_name(quadrature::Status status);
/// 0, 1 or 3.
int exit_status(RunStatus status);

/// Lengths in the units of the shape.
struct GeometrySummary {
  int dimension = 0;
  int patches = 0;
  std::int64_t elements = 0;
  int trimmed_faces = 0;
  /// Patches given by their extraction, and by how much their functions fail to sum to one at most.
  int t_splines = 0;
  double partition_defect = 0.0;
  int shells = 0;
  int voids = 0;
  bool closed = false;
  int free_edges = 0;
  double closure_defect = 0.0;
  /// By how much the enclosed area or volume may be wrong for the gaps: what moving the pole by the size changes.
  double pole_shift = 0.0;
  /// The largest distance between ends or edges that were taken as the same, and the largest that would have been.
  double largest_gap = 0.0;
  double edge_tolerance = 0.0;
  /// A point at the largest gap; empty in the plane.
  std::vector<double> largest_gap_place;
  /// Of the control net.
  std::vector<double> box_lower;
  std::vector<double> box_upper;
};

/// Seconds.
struct Timings {
  double read = 0.0;
  double integrate = 0.0;
  double write = 0.0;
};

struct Report {
  std::string version;
  std::string title;
  /// The case with its overrides as TOML; defaults are not spelled out.
  std::string resolved_case;
  RunStatus status = RunStatus::ok;
  GeometrySummary geometry;
  /// If the shape comes from a CAD file.
  std::optional<CadFacts> cad;
  /// If the shape is fitted to points, and fit_quantity_names() of it.
  std::optional<FitFacts> fit;
  std::vector<Quantity> fit_quantities;
  /// If the shape is a propeller (else null), and propeller_quantity_names() of it.
  std::shared_ptr<const PropellerFacts> propeller;
  std::vector<Quantity> propeller_quantities;
  /// If the shape is a hull, else null, and hull_quantity_names() of it.
  std::shared_ptr<const HullFacts> hull;
  std::vector<Quantity> hull_quantities;
  std::vector<Quantity> properties;
  std::vector<Quantity> integrals;
  /// If the case is an analysis; its fields on the boundary, for the writers of pictures.
  std::optional<AnalysisReport> analysis;
  std::shared_ptr<const AnyAnalysis> fields;
  /// Plane sections; null if none are asked for.
  std::shared_ptr<const std::vector<SectionFamily>> sections;
  /// Null if it is not asked for.
  std::shared_ptr<const HydrostaticsReport> hydrostatics;
  /// Added masses; null if none are asked for.
  std::shared_ptr<const AddedMassReport> added_mass;
  std::vector<ExpectationResult> expectations;
  Timings timings;
  int threads = 1;
  /// What the user should know though the run went well: a boundary that is open, ...
  std::vector<std::string> warnings;

  /// A property, integral or quantity of a fit; null if there is none of the name.
  const Quantity* find(std::string_view name) const;
};

/// The version of the program, "0.1.0".
std::string_view program_version();

}  // namespace isorim::io
