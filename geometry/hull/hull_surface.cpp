#include "geometry/hull/hull_surface.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/hull/bulb_surface.h"
#include "geometry/hull/section_nets.h"
#include "geometry/spline/interpolation.h"
#include "geometry/spline/smoothest_spline.h"

namespace isorim::geometry {
namespace {

constexpr int full_degree = 3;
constexpr Eigen::Index y_row = 1;
constexpr Eigen::Index z_row = 2;

int degree_for(std::size_t points) {
  return std::min(full_degree, static_cast<int>(points) - 1);
}

// --- Flat parts -----------------------------------------------------------------------------------------------

bool covers_all(const std::vector<ConstantRun>& runs, Eigen::Index count) {
  return runs.size() == 1 && runs.front().first == 0 && runs.front().last + 1 == count;
}

bool asks_for_freedom(const std::vector<ConstantRun>& runs, Eigen::Index count) {
  return !runs.empty() && !covers_all(runs, count);
}

// --- Along the sections ---------------------------------------------------------------------------------------

KnotVector knots_along(const std::vector<BandSection>& sections) {
  std::size_t most = 0;
  bool needs_freedom = false;
  for (const BandSection& section : sections) {
    most = std::max(most, section.parameters.size());
    const auto runs = constant_runs(section.points.row(y_row).transpose(), section.is_end);
    needs_freedom = needs_freedom || section.is_level_at_start || asks_for_freedom(runs, section.points.cols());
  }
  const std::vector<double> merged = merged_parameters(sections);
  const int degree = needs_freedom ? full_degree : degree_for(most);
  return needs_freedom ? doubled_knots(degree, merged) : averaged_knots(degree, merged);
}

// --- Across the sections --------------------------------------------------------------------------------------

/// Plain interpolation of a row would go beyond the centre plane.
bool dips(const KnotVector& knots, const std::vector<double>& u, const Points<3>& row) {
  const Eigen::VectorXd y = SmoothestSpline(knots, {u}).coefficients(row.row(y_row)).transpose();
  return !beyond_centre_plane(y, row.row(y_row).transpose()).empty();
}

/// All bands of a hull lie over the same knots in u.
KnotVector knots_across(const std::vector<std::vector<Points<3>>>& bands, const std::vector<double>& u) {
  const KnotVector plain = averaged_knots(degree_for(u.size()), u);
  for (const std::vector<Points<3>>& nets : bands) {
    for (Eigen::Index k = 0; k < nets.front().cols(); ++k) {
      const Points<3> row = row_of(nets, k);
      for (const Eigen::Index r : {y_row, z_row}) {
        const auto runs = constant_runs(row.row(r).transpose(), r == y_row);
        if (asks_for_freedom(runs, row.cols())) return doubled_knots(full_degree, u);
      }
      if (dips(plain, u, row)) return doubled_knots(full_degree, u);
    }
  }
  return plain;
}

NurbsSurface<3> skinned(const std::vector<Points<3>>& nets, const KnotVector& along, const KnotVector& across,
                        const std::vector<double>& u) {
  const Eigen::Index width = across.basis_count();
  Points<3> net(3, width * along.basis_count());
  for (Eigen::Index k = 0; k < along.basis_count(); ++k)
    net.middleCols(k * width, width) = closed_row(across, u, row_of(nets, k));
  return NurbsSurface<3>::from_points(across, along, net);
}

void check_sections(std::span<const HullSection> sections, const std::vector<double>& u) {
  if (sections.size() < 2)
    throw GeometryError(fmt::format("hull: {} section(s); expected at least two", sections.size()));
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!sections[i].is_in_bulb && sections[i].ends.size() != sections.front().ends.size()) {
      throw GeometryError(fmt::format("hull: {} has {} bands between knuckles, {} has {}", sections[i].name,
                                      sections[i].ends.size() - 1, sections.front().name,
                                      sections.front().ends.size() - 1));
    }
    if (i > 0 && !sections[i].is_in_bulb && !(u[i - 1] < u[i])) {
      throw GeometryError(fmt::format("hull: {} lies at x = {} on average, not ahead of {} at {}", sections[i].name,
                                      u[i], sections[i - 1].name, u[i - 1]));
    }
  }
}

}  // namespace

std::vector<double> section_parameters(std::span<const HullSection> sections) {
  std::vector<double> u;
  for (const HullSection& section : sections)
    u.push_back(section.is_contour ? section.points.row(0).mean() : section.points(0, 0));
  return u;
}

std::vector<NurbsSurface<3>> hull_surface(std::span<const HullSection> sections, const HullSurfaceOptions& options) {
  const std::vector<double> u = section_parameters(sections);
  check_sections(sections, u);
  const bool uses_heights = options.parameters == SectionParameters::heights ||
                            (options.parameters == SectionParameters::automatic && can_use_heights(sections));
  if (sections.back().is_in_bulb) return bulb_hull_surface(sections, uses_heights);
  std::vector<KnotVector> along;
  std::vector<std::vector<Points<3>>> bands;
  for (std::size_t band = 0; band + 1 < sections.front().ends.size(); ++band) {
    std::vector<BandSection> parts;
    for (std::size_t i = 0; i < sections.size(); ++i)
      parts.push_back(band_section(sections[i], band, i == 0 || i + 1 == sections.size()));
    set_parameters(parts, uses_heights);
    along.push_back(knots_along(parts));
    std::vector<Points<3>>& nets = bands.emplace_back();
    for (const BandSection& section : parts) {
      nets.push_back(
          smoothest_net(along.back(), section.parameters, section.points, section.is_end, section.is_level_at_start));
    }
  }
  const KnotVector across = knots_across(bands, u);
  std::vector<NurbsSurface<3>> surfaces;
  for (std::size_t band = 0; band < bands.size(); ++band)
    surfaces.push_back(skinned(bands[band], along[band], across, u));
  return surfaces;
}

}  // namespace isorim::geometry
