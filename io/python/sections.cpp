#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "geometry/errors.h"
#include "io/python/case.h"
#include "io/python/curves.h"
#include "solver/plane_sections.h"

namespace isorim::python {
namespace {

namespace py = pybind11;

geometry::Vector3 three(const std::vector<double>& values, const char* name) {
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw InputError(std::string(name) + ": found " + std::to_string(values.size()) + " coordinates; expected 3");
}

/// None for a curve that could not be fitted.
py::list spline_list(const std::vector<std::optional<geometry::SectionSpline>>& splines,
                     const geometry::PlaneFrame& frame) {
  py::list list;
  for (const std::optional<geometry::SectionSpline>& spline : splines) {
    if (!spline) {
      list.append(py::none());
      continue;
    }
    py::dict entry = curve_dict<3>(geometry::to_space(spline->curve, frame));
    entry["length"] = spline->length;
    entry["error"] = spline->error;
    list.append(entry);
  }
  return list;
}

py::dict section_dict(const solver::MeasuredSection& measured, double offset, const geometry::PlaneFrame& frame) {
  py::dict entry;
  entry["offset"] = offset;
  entry["failure"] = measured.failure;
  entry["area"] = measured.area.value;
  entry["area_error"] = measured.area.error;
  entry["perimeter"] = measured.perimeter.value;
  entry["perimeter_error"] = measured.perimeter.error;
  entry["centroid"] = measured.centroid ? py::object(array_of({measured.centroid->begin(), measured.centroid->end()}))
                                        : py::object(py::none());
  entry["loops"] = spline_list(measured.loops, frame);
  entry["chains"] = spline_list(measured.chains, frame);
  return entry;
}

py::list sections(const Case& self, const std::vector<double>& normal, const std::vector<double>& offsets,
                  const std::vector<double>& point, double fit_tolerance, int threads) {
  const auto* solid = std::get_if<io::Model<3>>(&self.model);
  if (solid == nullptr) throw InputError("the shape is a region of the plane; expected a solid to cut");
  check_tolerance(fit_tolerance, "fit_tolerance");
  const geometry::Vector3 direction = three(normal, "normal");
  const geometry::Point3 origin = three(point, "point");
  std::vector<geometry::PlaneFrame> planes;
  for (const double offset : offsets) {
    planes.push_back(geometry::plane_frame(origin + offset * direction.normalized(), direction));
  }
  std::vector<solver::MeasuredSection> measured;
  {
    const py::gil_scoped_release released;
    solver::PlaneSectionOptions options;
    options.fit_tolerance = fit_tolerance;
    options.threads = threads;
    options.progress = [report = run_options(threads).progress](double fraction) { report("sections", fraction); };
    const geometry::Boundary<3>& boundary = solid->oriented.boundary;
    const double size = geometry::PlaneCutter(boundary).size();
    options.cutting.gap_tolerance =
        std::max(options.cutting.gap_tolerance, 2.0 * solid->oriented.topology.largest_gap / size);
    measured = solver::measure_sections(geometry::PlaneCutter(boundary, options.cutting), planes, options);
  }
  py::list list;
  for (std::size_t i = 0; i < measured.size(); ++i) list.append(section_dict(measured[i], offsets[i], planes[i]));
  return list;
}

}  // namespace

void declare_sections(py::module_& module) {
  module.def("sections", &sections);
}

}  // namespace isorim::python
