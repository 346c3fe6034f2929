#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "io/results/compute.h"

namespace isorim::python {

/// A case with its boundary, oriented and cut into elements.
struct Case {
  io::CaseFile file;
  io::AnyModel model;
  /// Of the last run, if it is an analysis.
  std::shared_ptr<const io::AnyAnalysis> analysis;

  explicit Case(io::CaseFile read);

  int dimension() const { return model.index() == 0 ? 2 : 3; }
  std::vector<std::string> patches() const;
};

/// Progress that lets Ctrl-C through: raises what Python's signal handlers raise. For work without the GIL. Throws
/// InputError for a number of threads that is none.
io::RunOptions run_options(int threads);

/// What callers ask for, held to what case files may say. Throw InputError.
void check_threads(int threads);
void check_tolerance(double tolerance, const char* name = "tolerance");
void check_pole(const std::optional<std::vector<double>>& pole, int dimension);

void declare_case(pybind11::module_& module);
void declare_integrals(pybind11::module_& module);
void declare_sections(pybind11::module_& module);
void declare_fits(pybind11::module_& module);

}  // namespace isorim::python
