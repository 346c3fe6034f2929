#include "solver/plane_sections.h"

#include <cstddef>

#include <fmt/format.h>

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

/// What cannot be fitted leaves its place empty.
void fit(MeasuredSection& result, const geometry::SectionSplineOptions& options) {
  std::vector<std::string>& messages = result.section->messages;
  const auto fitted = [&](const geometry::SectionCurve& curve) -> std::optional<geometry::SectionSpline> {
    try {
      geometry::SectionSpline spline = geometry::fit_section(curve, options);
      if (!spline.tolerance_met)
        messages.push_back(fmt::format("a B-spline is {:.3g} off its section curve; its tolerance is {:.3g}",
                                       spline.error, options.tolerance));
      return spline;
    } catch (const Error& error) {
      messages.push_back(fmt::format("no B-spline of a curve: {}", error.what()));
      return std::nullopt;
    }
  };
  const geometry::PlaneSection& section = *result.section;
  for (const geometry::SectionLoop& loop : section.loops) result.loops.push_back(fitted(loop.curve));
  for (const geometry::SectionCurve& chain : section.chains) result.chains.push_back(fitted(chain));
  for (const geometry::SectionCurve& curve : section.touching) result.touching.push_back(fitted(curve));
}

/// The least of a few distances by which the plane has to be moved along its normal to meet nothing; absent if it takes
/// more than 1e-4 of the boundary's size.
std::optional<double> distance_to_nothing(const geometry::PlaneCutter& cutter, const geometry::PlaneFrame& plane) {
  for (const double part : {1e-9, 1e-8, 1e-7, 1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4}) {
    for (const double sign : {-1.0, 1.0}) {
      const double distance = part * cutter.size();
      geometry::PlaneFrame moved = plane;
      moved.origin += sign * distance * plane.normal;
      try {
        if (cutter.section(moved).is_empty()) return distance;
      } catch (const Error&) {
        // Still too near.
      }
    }
  }
  return std::nullopt;
}

MeasuredSection measured(const geometry::PlaneCutter& cutter, const geometry::PlaneFrame& plane,
                         const PlaneSectionOptions& options) {
  MeasuredSection result;
  try {
    result.section = cutter.section(plane);
    measure(result, options);
  } catch (const Error& error) {
    result = {};
    result.failure = error.what();
    result.touches_within = distance_to_nothing(cutter, plane);
    if (result.touches_within)
      result.failure = fmt::format(
          "the plane only touches the boundary, which ends within {:.2g} of it: a degenerate "
          "section",
          *result.touches_within);
    return result;
  }
  if (options.fit_tolerance > 0.0) fit(result, {.tolerance = options.fit_tolerance * cutter.size()});
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
