#include "solver/plane_sections.h"

#include <cstddef>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "solver/properties.h"

namespace isorim::solver {
namespace {

void measure(MeasuredSection& result, const PlaneSectionOptions& options) {
  const geometry::PlaneSection& section = *result.section;
  if (section.loops.empty()) return;
  PropertyOptions<2> how;
  how.integration.tolerance = options.tolerance;
  how.integration.threads = 1;
  const GeometricProperties<2> properties =
      geometric_properties<2>(geometry::bezier_elements(geometry::section_region(section)), how);
  result.perimeter = properties.boundary_measure;
  result.area = properties.domain->measure;
  result.centroid = section.frame.to_space(properties.domain->centroid);
  result.centroid_error = properties.domain->centroid_error;
  result.second_moments = properties.domain->inertia;
}

void fit(MeasuredSection& result, const geometry::SectionSplineOptions& options) {
  const geometry::PlaneSection& section = *result.section;
  for (const geometry::SectionLoop& loop : section.loops)
    result.loops.push_back(geometry::fit_section(loop.curve, options));
  for (const geometry::SectionCurve& chain : section.chains)
    result.chains.push_back(geometry::fit_section(chain, options));
  for (const geometry::SectionCurve& curve : section.touching)
    result.touching.push_back(geometry::fit_section(curve, options));
}

MeasuredSection measured(const geometry::PlaneCutter& cutter, const geometry::PlaneFrame& plane,
                         const PlaneSectionOptions& options) {
  MeasuredSection result;
  try {
    result.section = cutter.section(plane);
    measure(result, options);
    if (options.fit_tolerance > 0.0) fit(result, {.tolerance = options.fit_tolerance * cutter.size()});
  } catch (const Error& error) {
    result = {};
    result.failure = error.what();
  }
  return result;
}

}  // namespace

std::vector<MeasuredSection> measure_sections(const geometry::PlaneCutter& cutter,
                                              std::span<const geometry::PlaneFrame> planes,
                                              const PlaneSectionOptions& options) {
  std::vector<MeasuredSection> results(planes.size());
  quadrature::parallel_for(
      planes.size(), options.threads,
      [&](std::size_t i, int /*thread*/) { results[i] = measured(cutter, planes[i], options); }, options.progress);
  return results;
}

}  // namespace isorim::solver
