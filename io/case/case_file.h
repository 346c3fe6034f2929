#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/case/schema.h"
#include "io/case/shape_keys.h"

/// A case file, read and validated: the keys as they stand there with their defaults filled in. The declarations are
/// in section_declarations.cpp and shape_declarations.cpp.
namespace isorim::io {

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
  std::string source;
  GeometryKeys geometry;
  PropertiesKeys properties;
  std::vector<IntegralKeys> integral;
  ExpectKeys expect;
  OutputKeys output;
  std::optional<ConvergenceKeys> convergence;
  KeyPlace where;
};

struct CaseFile {
  std::filesystem::path path;
  CaseKeys keys;
  /// The case with its overrides, as TOML.
  std::string resolved;

  /// The file's name without its extension.
  std::string name() const { return path.stem().string(); }
  /// The title, or the name if there is none.
  std::string title() const { return keys.title.empty() ? name() : keys.title; }
};

/// Validates a tree of values. Throws InputError with all complaints, one a line, each with file and line, key, what
/// was found and what was expected. `geometry` is not built here, so what only its construction tells (knots against
/// points, loops that are open) comes from build_boundary().
CaseKeys read_keys(const Value& root);

/// Reads a case file, puts the overrides ("path.to.key=value") into it and validates it. Throws InputError.
CaseFile read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// 2 if the case is about a region of the plane, 3 if about a solid.
int dimension(const GeometryKeys& geometry);

/// The quantities that [expect] and [convergence] may name besides the integrals, in dimension `dim`.
std::vector<std::string> property_names(int dim);

}  // namespace isorim::io
