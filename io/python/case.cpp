#include "io/python/case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "geometry/errors.h"
#include "io/analysis/analysis.h"
#include "io/analysis/boundary_field.h"
#include "io/analysis/solution_pictures.h"
#include "io/atomic_file.h"
#include "io/python/values.h"
#include "io/results/case_files.h"
#include "io/results/conversion.h"
#include "io/results/inspection.h"
#include "io/results/json.h"
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

void check_threads(int threads) {
  if (threads < 0 || threads > 4096) {
    throw InputError(fmt::format("threads: found {}; expected a number from 0 (all) to 4096", threads));
  }
}

void check_tolerance(double tolerance, const char* name) {
  if (!(tolerance > 0.0 && tolerance <= 0.1)) {
    throw InputError(fmt::format("{}: found {}; expected a number > 0 and <= 0.1", name, tolerance));
  }
}

void check_pole(const std::optional<std::vector<double>>& pole, int dimension) {
  if (!pole) return;
  if (static_cast<int>(pole->size()) != dimension) {
    throw InputError(fmt::format("pole: found {} coordinates; expected {}", pole->size(), dimension));
  }
  for (const double x : *pole) {
    if (!std::isfinite(x)) throw InputError(fmt::format("pole: found {}; expected finite coordinates", x));
  }
}

io::RunOptions run_options(int threads) {
  check_threads(threads);
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
  check_threads(threads);
  return std::make_unique<Case>(io::read_case_or_cad(path, overrides, {.threads = threads}));
}

std::unique_ptr<Case> from_tree(io::Value root, const std::filesystem::path& folder,
                                const std::vector<std::string>& overrides, int threads) {
  check_threads(threads);
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

/// Everything that the case asks for, as the text of results.json; its files go into a folder if there is one.
std::string run(Case& self, int threads, const std::optional<std::filesystem::path>& output) {
  if (output) io::require_writable_folder(*output);
  io::Report report = io::compute(self.file, self.model, run_options(threads));
  {
    const py::gil_scoped_acquire lock;
    self.analysis = report.fields;
  }
  if (output) {
    const io::Convergence study = io::study_convergence(self.file, self.model, run_options(threads));
    io::write_case_files(*output, self.file, self.model, study, report);
  }
  return io::to_json(report);
}

/// The case without what its shape need not have: integrals, sections, water, an analysis.
io::CaseFile with_properties_alone(io::CaseFile file) {
  io::CaseKeys& keys = file.keys;
  keys.integral.clear();
  keys.section.clear();
  keys.expect.quantities.clear();
  keys.hydrostatics.reset();
  keys.added_mass.reset();
  keys.analysis.reset();
  return file;
}

/// The properties alone.
std::string properties(const Case& self, double tolerance, std::optional<double> density,
                       const std::optional<std::vector<double>>& pole, int threads) {
  check_tolerance(tolerance);
  check_pole(pole, self.dimension());
  if (density && !(std::isfinite(*density) && *density > 0.0)) {
    throw InputError(fmt::format("density: found {}; expected a number > 0", *density));
  }
  io::CaseFile file = with_properties_alone(self.file);
  file.keys.properties.tolerance = tolerance;
  if (density) file.keys.properties.density = density;
  if (pole) {
    file.keys.properties.pole.emplace();
    file.keys.properties.pole->values = *pole;
  }
  return io::to_json(io::compute(file, self.model, run_options(threads)));
}

std::string inspection(const Case& self, int threads) {
  return io::inspection_json(io::inspect(self.file, self.model, run_options(threads)));
}

void write_boundary(const Case& self, const std::filesystem::path& path, const std::optional<std::string>& unit) {
  io::write_boundary(path, self.file, self.model, {.unit = unit});
}

/// The solution, kept for as long as the caller needs it, whatever other threads do with the case.
std::shared_ptr<const io::AnyAnalysis> solved(const Case& self) {
  const py::gil_scoped_acquire lock;
  if (!self.analysis) throw InputError("there is no solution: the case is no analysis, or has not been run");
  return self.analysis;
}

void write_solution(const Case& self, const std::filesystem::path& path) {
  io::write_solution_vtu(path, self.model, *solved(self));
}

/// The solution at points, n x dim: locations, values (n x components), gradients (n x components x dim); NaN outside.
py::tuple evaluate(const Case& self, const py::array_t<double, py::array::c_style | py::array::forcecast>& points,
                   int threads) {
  check_threads(threads);
  const std::shared_ptr<const io::AnyAnalysis> analysis = solved(self);
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
      analysis->known);
}

/// A row for each node.
template <int Dim>
py::array_t<double> vectors_of(const std::vector<std::array<double, Dim>>& nodes) {
  py::array_t<double> rows({static_cast<py::ssize_t>(nodes.size()), py::ssize_t{Dim}});
  std::copy_n(nodes.data()->data(), nodes.size() * Dim, rows.mutable_data());
  return rows;
}

/// A row for each column of the parts.
py::array_t<double> stacked(const std::vector<Eigen::MatrixXd>& parts, py::ssize_t rows, py::ssize_t components) {
  py::array_t<double> all({rows, components});
  double* next = all.mutable_data();
  for (const Eigen::MatrixXd& part : parts) next = std::copy(part.data(), part.data() + part.size(), next);
  return all;
}

/// The solution on the boundary at the nodes of rules that integrate products of the fields: elements, patches, points
/// (n x Dim), normals, weights, values (n x components), fluxes.
template <int Dim>
py::tuple boundary_fields_of(const io::Analysis<Dim>& known) {
  const solver::FieldSpace<Dim>& space = known.setting.space;
  const quadrature::TargetRules<Dim> rules = io::sampling_rules(space);
  io::BoundarySampler<Dim> sampler(space, known.solution, rules);
  std::vector<int> elements;
  std::vector<int> patches;
  std::vector<std::array<double, Dim>> points;
  std::vector<std::array<double, Dim>> normals;
  std::vector<double> weights;
  std::vector<Eigen::MatrixXd> values;
  std::vector<Eigen::MatrixXd> fluxes;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const io::BoundarySample<Dim>& sample = sampler.sample(e);
    for (std::size_t i = 0; i < sample.nodes.size(); ++i) {
      elements.push_back(e);
      patches.push_back(space.table.elements[static_cast<std::size_t>(e)].patch);
      std::array<double, Dim>& point = points.emplace_back();
      std::array<double, Dim>& normal = normals.emplace_back();
      for (std::size_t d = 0; d < Dim; ++d) {
        point[d] = sample.nodes.position[d][i];
        normal[d] = sample.nodes.normal[d][i];
      }
      weights.push_back(sample.nodes.weight[i]);
    }
    values.push_back(sample.value);
    fluxes.push_back(sample.flux);
  }
  const auto count = static_cast<py::ssize_t>(weights.size());
  const py::ssize_t components = known.report.components;
  return py::make_tuple(py::array_t<int>(count, elements.data()), py::array_t<int>(count, patches.data()),
                        vectors_of<Dim>(points), vectors_of<Dim>(normals), py::array_t<double>(count, weights.data()),
                        stacked(values, count, components), stacked(fluxes, count, components));
}

py::tuple boundary_fields(const Case& self) {
  const std::shared_ptr<const io::AnyAnalysis> analysis = solved(self);
  return std::visit([](const auto& known) { return boundary_fields_of(known); }, analysis->known);
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
      .def("boundary_fields", &boundary_fields)
      .def("evaluate", &evaluate);
}

}  // namespace isorim::python
