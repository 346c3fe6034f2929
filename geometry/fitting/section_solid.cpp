#include "geometry/fitting/section_solid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/swept_solids.h"

namespace isorim::geometry {
namespace {

/// "3 (height 0.5)".
std::string label(const std::vector<BodySection>& sections, std::size_t k) {
  return sections[k].name.empty() ? fmt::format("{}", k + 1) : fmt::format("{} ({})", k + 1, sections[k].name);
}

void check_counts(const std::vector<BodySection>& sections, BodyEnds ends) {
  const std::size_t least = ends == BodyEnds::closed ? 3 : 2;
  if (sections.size() < least) {
    throw GeometryError(fmt::format("{} section(s), at least {} are needed", sections.size(), least));
  }
  for (std::size_t k = 0; k < sections.size(); ++k) {
    if (sections[k].loops.empty()) throw GeometryError(fmt::format("section {} has no loop", label(sections, k)));
    if (k > 0 && sections[k].loops.size() != sections[k - 1].loops.size()) {
      throw GeometryError(fmt::format(
          "the body branches: section {} has {} loop(s), section {} has {}; expected the same number in all sections: "
          "split the body there, or give the parts as bodies of their own",
          label(sections, k - 1), sections[k - 1].loops.size(), label(sections, k), sections[k].loops.size()));
    }
    for (const NurbsCurve<3>& loop : sections[k].loops) {
      if (!is_closed(loop)) throw GeometryError(fmt::format("section {}: a loop is not closed", label(sections, k)));
    }
  }
}

struct LoopMeasure {
  Point3 centre;
  /// Square root of the area.
  double size = 0.0;
};

LoopMeasure measure(const NurbsCurve<3>& loop) {
  LoopMeasure result{Point3::Zero(), std::sqrt(vector_area(loop).norm())};
  constexpr int count = 64;
  for (int k = 0; k < count; ++k) {
    result.centre += evaluate(loop, loop.domain().first + k * loop.domain().length() / count) / count;
  }
  return result;
}

/// For each loop of `first` the loop of `second` that continues it: the nearest pairs first.
std::vector<std::size_t> matches(const BodySection& first, const BodySection& second) {
  const std::size_t count = first.loops.size();
  std::vector<LoopMeasure> from;
  std::vector<LoopMeasure> to;
  for (std::size_t i = 0; i < count; ++i) {
    from.push_back(measure(first.loops[i]));
    to.push_back(measure(second.loops[i]));
  }
  std::vector<std::size_t> partner(count, count);
  std::vector<char> taken(count, 0);
  for (std::size_t round = 0; round < count; ++round) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best_i = 0;
    std::size_t best_j = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (partner[i] < count || taken[j]) continue;
        const double distance = (from[i].centre - to[j].centre).norm() + std::abs(from[i].size - to[j].size);
        if (distance >= least) continue;
        least = distance;
        best_i = i;
        best_j = j;
      }
    }
    partner[best_i] = best_j;
    taken[best_j] = 1;
  }
  return partner;
}

/// The loops as chains through all sections.
std::vector<std::vector<NurbsCurve<3>>> chains(const std::vector<BodySection>& sections) {
  std::vector<std::vector<NurbsCurve<3>>> result;
  const std::size_t count = sections.front().loops.size();
  std::vector<std::size_t> current;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back({sections.front().loops[i]});
    current.push_back(i);
  }
  for (std::size_t k = 1; k < sections.size(); ++k) {
    const std::vector<std::size_t> partner = matches(sections[k - 1], sections[k]);
    for (std::size_t i = 0; i < count; ++i) {
      current[i] = partner[current[i]];
      result[i].push_back(sections[k].loops[current[i]]);
    }
  }
  return result;
}

}  // namespace

NurbsCurve<3> point_section(const Point3& point) {
  return NurbsCurve<3>::from_points(KnotVector::bezier(1), point.replicate<1, 2>());
}

Body body_of_sections(const std::vector<BodySection>& sections, const BodyOptions& options) {
  check_counts(sections, options.ends);
  Body body;
  std::vector<std::vector<NurbsCurve<3>>> walls;
  for (const std::vector<NurbsCurve<3>>& chain : chains(sections)) {
    UniformSections uniform = uniformise(align_sections(chain, options.start), options.knots);
    body.control_points_along = std::max(body.control_points_along, uniform.control_points);
    body.knots_inserted += uniform.inserted;
    body.knots_removed += uniform.removed;
    body.uniformisation_error = std::max(body.uniformisation_error, uniform.error_bound);
    walls.push_back(std::move(uniform.sections));
  }
  body.boundary = loft_solid(walls, {.degree = options.degree, .closed = options.ends == BodyEnds::closed});
  for (const Patch<3>& patch : body.boundary.patches) {
    if (!patch.name.starts_with("side")) continue;
    body.control_points_across = std::max(body.control_points_across, surface_of(patch.shape).count_v());
  }
  return body;
}

}  // namespace isorim::geometry
