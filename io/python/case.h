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

/// Progress that lets Ctrl-C through: raises what Python's signal handlers raise. For work without the GIL.
io::RunOptions run_options(int threads);

void declare_case(pybind11::module_& module);
void declare_integrals(pybind11::module_& module);
void declare_sections(pybind11::module_& module);
void declare_fits(pybind11::module_& module);

}  // namespace isorim::python
