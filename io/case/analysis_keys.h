#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "io/case/schema.h"
#include "io/case/shape_keys.h"

/// What a case file says of a boundary-element analysis, as it stands there. The declarations are in
/// analysis_declarations.cpp, the rules between sections in analysis_checks.h.
namespace isorim::io {

/// A number (printed so that it reads back to the same bits) or an expression.
struct ExpressionText {
  std::string text;
  KeyPlace where;
};

/// An expression for each component of a vector, some of which may be missing; or a single one.
struct ComponentTexts {
  std::optional<ExpressionText> single;
  /// x, y, z.
  std::array<std::optional<ExpressionText>, 3> axes;
  /// Along the outward normal.
  std::optional<ExpressionText> normal;
  /// Entries of a list; 0 for a table or a single expression.
  int listed = 0;
  KeyPlace where;

  bool has_axes() const { return axes[0] || axes[1] || axes[2]; }
};

/// The components of a symmetric tensor; what is missing is zero.
struct TensorTexts {
  std::optional<ExpressionText> xx;
  std::optional<ExpressionText> yy;
  std::optional<ExpressionText> zz;
  std::optional<ExpressionText> xy;
  std::optional<ExpressionText> yz;
  std::optional<ExpressionText> xz;
  KeyPlace where;
};

/// Names for expressions, in the order of the file.
struct DefinitionsKeys {
  std::vector<std::pair<std::string, ExpressionText>> entries;
};

/// Its keys are names.
template <>
struct KeyType<DefinitionsKeys> {
  static std::string type() { return "table"; }
  static std::vector<const Description*> nested();
  static bool read(const Value& v, DefinitionsKeys& t, const Range& r, const KeyPlace& w, Complaints& c);
  static std::string print(const DefinitionsKeys&) { return ""; }
};

/// Texts out of few, and what each stands for.
template <class E>
using Choices = std::vector<std::pair<std::string, E>>;

enum class EquationKind { laplace, poisson, elasticity };
enum class PlaneState { strain, stress };

struct AnalysisKeys {
  EquationKind equation = EquationKind::laplace;
  std::optional<PlaneState> state;
  bool exterior = false;
  KeyPlace where;
};

struct MaterialKeys {
  std::optional<double> conductivity;
  std::optional<double> young;
  std::optional<double> poisson;
  std::optional<double> density;
  std::optional<double> expansion;
  KeyPlace where;
};

enum class BoundaryKind { value, flux, robin, displacement, traction, foundation, symmetry };

/// What files and results call them.
inline const Choices<EquationKind> equation_names{
    {"laplace", EquationKind::laplace}, {"poisson", EquationKind::poisson}, {"elasticity", EquationKind::elasticity}};
inline const Choices<BoundaryKind> boundary_kind_names{
    {"value", BoundaryKind::value},       {"flux", BoundaryKind::flux},
    {"robin", BoundaryKind::robin},       {"displacement", BoundaryKind::displacement},
    {"traction", BoundaryKind::traction}, {"foundation", BoundaryKind::foundation},
    {"symmetry", BoundaryKind::symmetry}};
template <class E>
const std::string& name_of(E value, const Choices<E>& names) {
  return std::ranges::find(names, value, &Choices<E>::value_type::second)->first;
}

struct BoundaryConditionKeys {
  std::string name;
  OneOrMany<std::string> on;
  std::optional<ExpressionText> selection;
  BoundaryKind kind = BoundaryKind::value;
  std::optional<ComponentTexts> value;
  std::optional<ComponentTexts> coefficient;
  std::optional<ComponentTexts> reference;
  std::optional<ComponentTexts> traction;
  std::optional<ExpressionText> pressure;
  KeyPlace where;
};

/// Of Poisson's equation.
struct SourceKeys {
  ExpressionText value;
  std::string citation;
  KeyPlace where;
};

/// What stands under "source": where the numbers of a case come from, or the section [source] of Poisson's equation.
struct SourceEntry {
  std::string citation;
  std::optional<SourceKeys> term;
};

template <>
struct KeyType<SourceEntry> {
  static std::string type() { return "text or table"; }
  static std::vector<const Description*> nested();
  static bool read(const Value& v, SourceEntry& t, const Range& r, const KeyPlace& w, Complaints& c);
  static std::string print(const SourceEntry&) { return ""; }
};

struct CentrifugalKeys {
  Coordinates point;
  /// The z axis if absent.
  std::optional<Eigen::Vector3d> direction;
  double speed = 0.0;
  KeyPlace where;
};

struct BodyForceKeys {
  std::optional<Coordinates> gravity;
  std::optional<CentrifugalKeys> centrifugal;
  std::optional<ComponentTexts> force;
  std::optional<ExpressionText> temperature;
  KeyPlace where;
};

struct PatchDiscretisationKeys {
  OneOrMany<std::string> on;
  std::optional<int> degree;
  std::optional<int> refine;
  KeyPlace where;
};

/// Refinement where the error is largest, until its estimate meets the tolerance.
struct AdaptKeys {
  double tolerance = 1e-4;
  int max_unknowns = 5000;
  int max_steps = 50;
  double fraction = 0.5;
  KeyPlace where;
};

/// "adapt": true for the defaults, or a table.
struct AdaptEntry {
  std::optional<AdaptKeys> keys;
};

template <>
struct KeyType<AdaptEntry> {
  static std::string type() { return "true, false or table"; }
  static std::vector<const Description*> nested();
  static bool read(const Value& v, AdaptEntry& t, const Range& r, const KeyPlace& w, Complaints& c);
  static std::string print(const AdaptEntry&) { return "false"; }
};

struct DiscretisationKeys {
  std::optional<int> degree;
  int refine = 0;
  AdaptEntry adapt;
  std::vector<PatchDiscretisationKeys> patch;
  KeyPlace where;
};

enum class SolveMethodKind { automatic, dense, compressed };

struct SolveKeys {
  SolveMethodKind method = SolveMethodKind::automatic;
  double tolerance = 1e-10;
  int max_iterations = 500;
  KeyPlace where;
};

/// Exactly one of `points`, `from` with `to`, and `file`.
struct ProbeKeys {
  std::string name;
  std::vector<Coordinates> points;
  std::optional<Coordinates> from;
  std::optional<Coordinates> to;
  std::optional<int> count;
  std::string file;

  int line_count() const { return count.value_or(101); }
  KeyPlace where;
};

/// Either the box from `from` to `to`, or (in space) the rectangle at `corner` with the sides `sides`.
struct GridKeys {
  std::string name;
  std::optional<Coordinates> from;
  std::optional<Coordinates> to;
  std::optional<Coordinates> corner;
  std::vector<Coordinates> sides;
  std::vector<int> counts;
  KeyPlace where;
};

struct ExactKeys {
  std::optional<ExpressionText> value;
  std::optional<ComponentTexts> gradient;
  std::optional<ExpressionText> flux;
  std::optional<ComponentTexts> displacement;
  std::optional<TensorTexts> stress;
  std::optional<ComponentTexts> traction;
  KeyPlace where;
};

}  // namespace isorim::io
