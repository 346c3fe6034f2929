#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "geometry/errors.h"
#include "geometry/fitting/curve_fit.h"
#include "io/python/case.h"
#include "io/python/curves.h"

namespace isorim::python {
namespace {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

template <int Dim>
py::dict fit_in(const Array& points, bool closed, int degree, int control_points, double tolerance,
                double corner_angle) {
  const Eigen::Map<const geometry::Points<Dim>> given(points.data(), Dim, points.shape(0));
  geometry::CurveFitOptions<Dim> options;
  options.closed = closed;
  options.degree = degree;
  options.control_points = control_points;
  options.tolerance = tolerance;
  options.corner_angle = corner_angle;
  const geometry::CurveFit<Dim> fit = [&] {
    const py::gil_scoped_release released;
    return geometry::fit_points<Dim>(given, options);
  }();
  py::dict result = curve_dict<Dim>(fit.curve);
  result["parameters"] = array_of(fit.parameters);
  result["distances"] = array_of(fit.distances);
  result["tolerance_met"] = fit.tolerance_met;
  return result;
}

py::dict fit(const Array& points, bool closed, int degree, int control_points, double tolerance, double corner_angle) {
  if (points.ndim() == 2 && points.shape(1) == 2) {
    return fit_in<2>(points, closed, degree, control_points, tolerance, corner_angle);
  }
  if (points.ndim() == 2 && points.shape(1) == 3) {
    return fit_in<3>(points, closed, degree, control_points, tolerance, corner_angle);
  }
  throw InputError("points: expected an array of shape (n, 2) or (n, 3)");
}

}  // namespace

void declare_fits(py::module_& module) {
  module.def("fit", &fit);
}

}  // namespace isorim::python
