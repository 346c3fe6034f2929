#include <pybind11/pybind11.h>

#include "geometry/errors.h"
#include "io/python/case.h"
#include "io/results/report.h"

namespace {

namespace py = pybind11;

/// InputError and GeometryError are ValueErrors, NumericalError is an ArithmeticError.
void declare_errors(py::module_& module) {
  const auto& input = py::register_exception<isorim::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<isorim::GeometryError>(module, "GeometryError", input);
  py::register_exception<isorim::NumericalError>(module, "NumericalError", PyExc_ArithmeticError);
}

}  // namespace

PYBIND11_MODULE(_isorim, module) {
  module.doc() = "What the package isorim is made of.";
  module.attr("version") = std::string(isorim::io::program_version());
  declare_errors(module);
  isorim::python::declare_case(module);
  isorim::python::declare_integrals(module);
  isorim::python::declare_sections(module);
  isorim::python::declare_fits(module);
}
