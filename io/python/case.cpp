#include "io/python/case.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "geometry/errors.h"
#include "io/analysis/analysis.h"
#include "io/analysis/solution_pictures.h"
#include "io/iges/writer.h"
#include "io/python/values.h"
#include "io/results/hdf5.h"
#include "io/results/inspection.h"
#include "io/results/json.h"
#include "io/results/pictures.h"
#include "io/results/plane_sections.h"
#include "solver/bem/evaluation.h"

namespace isorim::python {

namespace py = pybind11;
using Released = py::call_guard<py::gil_scoped_release>;

Case::Case(io::CaseFile read) : file(std::move(read)), model(io::build_model(file)) {}

std::vector<std::string> Case::patches() const {
  std::vector<std::string> names;
  std::visit(
      [&](const auto& known) {
        for (const auto& patch : known.oriented.boundary.patches) names.push_back(patch.name);
      },
      model);
  return names;
}

io::RunOptions run_options(int threads) {
  return {threads, [](std::string_view /*stage*/, double /*fraction*/) {
            const py::gil_scoped_acquire lock;
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
          }};
}

namespace {

void override_all(io::Value& root, const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) io::apply_override(root, assignment);
}

std::unique_ptr<Case> from_file(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                                int threads) {
  return std::make_unique<Case>(io::read_case_or_cad(path, overrides, {.threads = threads}));
}

std::unique_ptr<Case> from_tree(io::Value root, const std::filesystem::path& folder,
                                const std::vector<std::string>& overrides, int threads) {
  override_all(root, overrides);
  return std::make_unique<Case>(io::read_case(root, folder / "case.toml", {.threads = threads}));
}

std::unique_ptr<Case> from_dict(const py::dict& tree, const std::filesystem::path& folder,
                                const std::vector<std::string>& overrides, int threads) {
  io::Value root = to_value(tree, "case");
  const py::gil_scoped_release released;
  return from_tree(std::move(root), folder, overrides, threads);
}

std::unique_ptr<Case> from_toml(const std::string& text, const std::filesystem::path& folder,
                                const std::vector<std::string>& overrides, int threads) {
  return from_tree(io::parse_toml(text, "case"), folder, overrides, threads);
}

/// Everything that the case asks for, as the text of results.json.
std::string run(Case& self, int threads) {
  const io::Report report = io::compute(self.file, self.model, run_options(threads));
  self.analysis = report.fields;
  return io::to_json(report);
}

/// The properties alone.
std::string properties(const Case& self, double tolerance, std::optional<double> density,
                       const std::optional<std::vector<double>>& pole, int threads) {
  io::CaseFile file = self.file;
  file.keys.integral.clear();
  file.keys.section.clear();
  file.keys.expect.quantities.clear();
  file.keys.analysis.reset();
  file.keys.properties.tolerance = tolerance;
  if (density) file.keys.properties.density = density;
  if (pole) {
    if (static_cast<int>(pole->size()) != self.dimension()) {
      throw InputError("pole: found " + std::to_string(pole->size()) + " coordinates; expected " +
                       std::to_string(self.dimension()));
    }
    file.keys.properties.pole.emplace();
    file.keys.properties.pole->values = *pole;
  }
  return io::to_json(io::compute(file, self.model, run_options(threads)));
}

std::string inspection(const Case& self, int threads) {
  return io::inspection_json(io::inspect(self.file, self.model, run_options(threads)));
}

void write_boundary(const Case& self, const std::filesystem::path& path, const std::string& unit) {
  const std::string extension = path.extension().string();
  if (extension == ".vtu") return io::write_boundary_vtu(path, self.model);
  if (extension == ".svg" && self.dimension() == 2) return io::write_boundary_svg(path, self.file.title(), self.model);
  if (extension == ".igs" || extension == ".iges") {
    io::iges::WriterOptions options;
    options.unit = unit;
    options.title = self.file.title();
    std::visit([&](const auto& known) { io::iges::write_iges(path, known.oriented, options); }, self.model);
    return;
  }
  throw InputError("cannot write '" + path.string() + "': found the extension \"" + extension +
                   "\", expected .vtu, .igs, .iges, or .svg for a region of the plane");
}

const io::AnyAnalysis& solved(const Case& self) {
  if (!self.analysis) throw InputError("there is no solution: the case is no analysis, or has not been run");
  return *self.analysis;
}

void write_solution(const Case& self, const std::filesystem::path& path) {
  io::write_solution_vtu(path, self.model, solved(self));
}

/// The solution at points, n x dim: locations, values (n x components), gradients (n x components x dim); NaN outside.
py::tuple evaluate(const Case& self, const py::array_t<double, py::array::c_style | py::array::forcecast>& points,
                   int threads) {
  return std::visit(
      [&]<int Dim>(const io::Analysis<Dim>& known) {
        if (points.ndim() != 2 || points.shape(1) != Dim) {
          throw InputError("points: expected an array of shape (n, " + std::to_string(Dim) + ")");
        }
        const py::ssize_t count = points.shape(0);
        const Eigen::Map<const geometry::Points<Dim>> places(points.data(), Dim, count);
        std::vector<solver::PointEvaluation<Dim>> found;
        {
          const py::gil_scoped_release released;
          found = solver::evaluate_at<Dim>(known.setting.problem, known.setting.space, known.solution, places,
                                           {.threads = threads});
        }
        const py::ssize_t components = known.report.components;
        py::array_t<std::int8_t> locations(count);
        py::array_t<double> values({count, components});
        py::array_t<double> gradients({count, components, py::ssize_t{Dim}});
        for (py::ssize_t i = 0; i < count; ++i) {
          const solver::PointEvaluation<Dim>& at = found[static_cast<std::size_t>(i)];
          const bool outside = at.location == solver::Location::outside;
          locations.mutable_at(i) = static_cast<std::int8_t>(outside                                   ? -1
                                                             : at.location == solver::Location::inside ? 1
                                                                                                       : 0);
          for (py::ssize_t c = 0; c < components; ++c) {
            values.mutable_at(i, c) = outside ? std::nan("") : at.field.value[c];
            for (py::ssize_t d = 0; d < Dim; ++d) {
              gradients.mutable_at(i, c, d) = outside ? std::nan("") : at.field.gradient(c, d);
            }
          }
        }
        return py::make_tuple(locations, values, gradients);
      },
      solved(self).known);
}

}  // namespace

void declare_case(py::module_& module) {
  py::class_<Case>(module, "Case")
      .def_static("from_file", &from_file, Released())
      .def_static("from_dict", &from_dict)
      .def_static("from_toml", &from_toml, Released())
      .def_property_readonly("dimension", &Case::dimension)
      .def_property_readonly("patches", &Case::patches)
      .def_property_readonly("title", [](const Case& self) { return self.file.title(); })
      .def_property_readonly("resolved", [](const Case& self) { return self.file.resolved; })
      .def("run", &run, Released())
      .def("properties", &properties, Released())
      .def("inspection", &inspection, Released())
      .def("write_boundary", &write_boundary, Released())
      .def("write_solution", &write_solution, Released())
      .def("evaluate", &evaluate);
}

}  // namespace isorim::python
