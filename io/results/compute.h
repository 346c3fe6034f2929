#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/topology/orientation.h"
#include "io/cad/cad_facts.h"
#include "io/case/case_file.h"
#include "io/results/report.h"

/// From a case to its numbers, without a word or a file.
namespace isorim::io {

struct RunOptions {
  /// 0: all that OpenMP offers.
  int threads = 0;
  /// Called now and then from one thread with what is being done and the finished fraction of it; may be empty.
  std::function<void(std::string_view, double)> progress;
};

/// The shape of a case, oriented and cut into elements.
template <int Dim>
struct Model {
  geometry::OrientedBoundary<Dim> oriented;
  geometry::ElementTable<Dim> table;
  /// Where each patch comes from, if it is a CAD file; else empty.
  std::vector<PatchOrigin> origins;
};
using AnyModel = std::variant<Model<2>, Model<3>>;

/// Builds and orients the shape. Throws InputError with file, line and key for whatever is wrong with it: also a
/// region whose loops cross, a loop whose role contradicts the nesting, and integrals that an open boundary does not
/// have.
AnyModel build_model(const CaseFile& file);

/// What there is to know without integrating.
GeometrySummary summarise(const AnyModel& model);

/// Computes the properties and integrals and compares them with what is expected.
///
/// A boundary that is open has its perimeter or area alone: the others are there without entries but with a reason,
/// unless the case says open_boundary = "integrate". Throws GeometryError and NumericalError as the solver does.
Report compute(const CaseFile& file, const AnyModel& model, const RunOptions& options = {});

/// Errors of fixed Gauss rules.
struct Convergence {
  std::vector<int> points;
  struct Curve {
    std::string quantity;
    /// max |value - expected| / max |expected| (without the division if that is zero), one for each number of points.
    std::vector<double> errors;
  };
  std::vector<Curve> curves;
};

/// Runs the rules that the section [convergence] asks for; none without it.
Convergence study_convergence(const CaseFile& file, const AnyModel& model, const RunOptions& options = {});

}  // namespace isorim::io
