#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "geometry/errors.h"
#include "io/expression.h"
#include "io/python/case.h"
#include "quadrature/rim.h"

namespace isorim::python {
namespace {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A copy, n x Dim.
template <int Dim>
Array rows_of(const Eigen::Ref<const geometry::Points<Dim>>& points) {
  Array rows({py::ssize_t{points.cols()}, py::ssize_t{Dim}});
  std::copy(points.data(), points.data() + points.size(), rows.mutable_data());
  return rows;
}

/// What a callable has returned. Throws TypeError for what is no number, or complex.
Array numbers_in(const py::object& result) {
  const py::array found = py::array::ensure(result);
  if (!found) throw py::type_error("the integrand gave what makes no array; expected one number a point");
  if (std::string_view("biuf").find(found.dtype().kind()) == std::string_view::npos) {
    throw py::type_error(fmt::format("the integrand gave values of the type {}; expected real numbers",
                                     py::str(found.dtype()).cast<std::string>()));
  }
  return Array(found);
}

/// A Python callable of (points) or (points, normals), which gives one value a point. Needs the GIL.
template <int Dim>
quadrature::IntegrandFactory<Dim> integrand_of(const py::function& function, bool has_normals) {
  return [function, has_normals]() -> quadrature::Integrand<Dim> {
    return [function, has_normals](const Eigen::Ref<const geometry::Points<Dim>>& points,
                                   const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      const py::object result =
          has_normals ? function(rows_of<Dim>(points), rows_of<Dim>(normals)) : function(rows_of<Dim>(points));
      const Array found = numbers_in(result);
      if (found.ndim() == 0) {
        std::fill(values.begin(), values.end(), *found.data());
      } else if (found.ndim() == 1 && found.shape(0) == points.cols()) {
        std::copy(found.data(), found.data() + found.size(), values.begin());
      } else {
        const std::vector<py::ssize_t> shape(found.shape(), found.shape() + found.ndim());
        throw InputError(
            fmt::format("the integrand gave an array of the shape ({}) for {} points; expected one a point",
                        fmt::join(shape, ", "), points.cols()));
      }
    };
  };
}

template <int Dim>
quadrature::IntegralResult integrate_over(const io::Model<Dim>& model, bool over_boundary,
                                          const quadrature::IntegrandFactory<Dim>& integrand,
                                          const std::optional<std::vector<double>>& pole,
                                          const quadrature::Options& options) {
  if (over_boundary) return quadrature::integrate_over_boundary<Dim>(model.table, integrand, options);
  if (!model.oriented.topology.closed) {
    throw InputError("the boundary is open: it has integrals over itself, but none over a domain");
  }
  std::optional<geometry::Point<Dim>> at;
  if (pole) at = Eigen::Map<const geometry::Point<Dim>>(pole->data());
  return quadrature::integrate_over_domain<Dim>(model.table, integrand, at, options);
}

py::tuple integrate(const Case& self, const py::object& integrand, bool over_boundary, double tolerance,
                    const std::optional<std::vector<double>>& pole, int threads) {
  check_tolerance(tolerance);
  check_threads(threads);
  check_pole(pole, self.dimension());
  const quadrature::IntegralResult result = std::visit(
      [&]<int Dim>(const io::Model<Dim>& model) {
        quadrature::Options options;
        options.tolerance = tolerance;
        if (!py::isinstance<py::str>(integrand)) {
          // Python runs one thread at a time; Ctrl-C ends the callable.
          options.threads = 1;
          return integrate_over<Dim>(model, over_boundary,
                                     integrand_of<Dim>(integrand.cast<py::function>(), over_boundary), pole, options);
        }
        const auto expression = io::compile_integrand<Dim>(
            integrand.cast<std::string>(), over_boundary ? io::ExpressionScope::boundary : io::ExpressionScope::domain,
            self.file.definitions);
        options.threads = threads;
        options.progress = [report = run_options(threads).progress](double fraction) { report("integral", fraction); };
        const py::gil_scoped_release released;
        return integrate_over<Dim>(model, over_boundary, expression, pole, options);
      },
      self.model);
  return py::make_tuple(result.integral.value, result.integral.error, result.evaluations,
                        io::status_name(result.status));
}

}  // namespace

void declare_integrals(py::module_& module) {
  module.def("integrate", &integrate);
}

}  // namespace isorim::python
