#include "geometry/hull/hull_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/interpolation.h"
#include "geometry/spline/smoothest_spline.h"

namespace isorim::geometry {
namespace {

constexpr int full_degree = 3;
constexpr Eigen::Index y_row = 1;
constexpr Eigen::Index z_row = 2;
/// Successive equal values that make a flat part; at edges in the centre plane two zeros do.
constexpr int flat_count = 3;
constexpr int closed_count = 2;

int degree_for(std::size_t points) {
  return std::min(full_degree, static_cast<int>(points) - 1);
}

/// The part of a section between two knuckles, with a parameter for each point.
struct BandSection {
  Points<3> points;
  std::vector<int> lines;
  std::vector<double> parameters;
  bool is_level_at_start = false;
  /// An end of the hull, where half-breadths of 0 may follow one another.
  bool is_end = false;
};

BandSection part(const HullSection& section, std::size_t band, bool is_end) {
  const int first = section.ends[band];
  const int count = section.ends[band + 1] - first + 1;
  BandSection result;
  result.points = section.points.middleCols(first, count);
  result.lines.assign(section.lines.begin() + first, section.lines.begin() + first + count);
  result.is_level_at_start = band == 0 && section.is_level_at_keel;
  result.is_end = is_end;
  for (Eigen::Index i = 1; i < result.points.cols(); ++i) {
    if (result.points.col(i) == result.points.col(i - 1)) {
      throw GeometryError(
          fmt::format("hull: {} has the same point twice at height {}", section.name, result.points(2, i)));
    }
  }
  return result;
}

// --- Parameters -----------------------------------------------------------------------------------------------

bool can_use_heights(std::span<const HullSection> sections) {
  constexpr double steepest = 2.0;
  for (const HullSection& section : sections) {
    for (Eigen::Index i = 1; i < section.points.cols(); ++i) {
      const Vector3 step = section.points.col(i) - section.points.col(i - 1);
      if (!(std::abs(step.y()) <= steepest * step.z())) return false;
    }
  }
  return true;
}

template <class Length>
std::vector<double> cumulative(const BandSection& section, Length&& length) {
  std::vector<double> t{0.0};
  for (Eigen::Index i = 1; i < section.points.cols(); ++i)
    t.push_back(t.back() + length(Vector3(section.points.col(i) - section.points.col(i - 1))));
  const double total = t.back();
  for (double& value : t) value /= total;
  t.back() = 1.0;
  return t;
}

/// z over the section's own range.
void set_heights(std::vector<BandSection>& sections) {
  for (BandSection& section : sections) {
    const double low = section.points(2, 0);
    const double range = section.points(2, section.points.cols() - 1) - low;
    section.parameters.clear();
    for (Eigen::Index i = 0; i < section.points.cols(); ++i)
      section.parameters.push_back((section.points(2, i) - low) / range);
  }
}

/// Chord lengths; sections with points on the same lines share the means of theirs.
void set_chord_lengths(std::vector<BandSection>& sections) {
  std::map<std::vector<int>, std::pair<std::vector<double>, int>> sums;
  for (BandSection& section : sections) {
    section.parameters = cumulative(section, [](const Vector3& step) { return step.norm(); });
    auto& [sum, count] = sums[section.lines];
    sum.resize(section.parameters.size(), 0.0);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += section.parameters[i];
    ++count;
  }
  for (BandSection& section : sections) {
    const auto& [sum, count] = sums[section.lines];
    for (std::size_t i = 0; i < sum.size(); ++i) section.parameters[i] = sum[i] / count;
    section.parameters.back() = 1.0;
  }
}

/// The parameters of all sections in order, without those that lie nearer to the one before than a quarter of the
/// smallest step of a section.
std::vector<double> merged_parameters(const std::vector<BandSection>& sections) {
  std::vector<double> all;
  double smallest = 1.0;
  for (const BandSection& section : sections) {
    const std::vector<double>& t = section.parameters;
    all.insert(all.end(), t.begin(), t.end());
    for (std::size_t i = 1; i < t.size(); ++i) smallest = std::min(smallest, t[i] - t[i - 1]);
  }
  std::sort(all.begin(), all.end());
  std::vector<double> merged;
  for (const double t : all) {
    if (merged.empty() || t - merged.back() > 0.25 * smallest) merged.push_back(t);
  }
  merged.back() = 1.0;
  return merged;
}

// --- Flat parts -----------------------------------------------------------------------------------------------

/// Runs of equal values, of at least three of them, or of two zeros where these close the hull.
std::vector<ConstantRun> constant_runs(const Eigen::VectorXd& values, bool zeros_close) {
  std::vector<ConstantRun> runs;
  for (Eigen::Index first = 0; first < values.size();) {
    Eigen::Index last = first;
    while (last + 1 < values.size() && values(last + 1) == values(first)) ++last;
    const int least = zeros_close && values(first) == 0.0 ? closed_count : flat_count;
    if (last - first + 1 >= least) runs.push_back({static_cast<int>(first), static_cast<int>(last)});
    first = last + 1;
  }
  return runs;
}

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

/// The coefficients for points at parameters, each coordinate with its flat parts; `is_level`: z starts level.
Points<3> smoothest_net(const KnotVector& knots, const std::vector<double>& parameters, const Points<3>& points,
                        bool zeros_close, bool is_level) {
  Points<3> net(3, knots.basis_count());
  for (Eigen::Index row = 0; row < 3; ++row) {
    const auto runs = constant_runs(points.row(row).transpose(), zeros_close && row == y_row);
    net.row(row) = SmoothestSpline(knots, {parameters, runs, is_level && row == z_row}).coefficients(points.row(row));
  }
  return net;
}

// --- Across the sections --------------------------------------------------------------------------------------

/// The net points of one function of v at all sections.
Points<3> row_of(const std::vector<Points<3>>& nets, Eigen::Index function) {
  Points<3> row(3, static_cast<Eigen::Index>(nets.size()));
  for (std::size_t i = 0; i < nets.size(); ++i) row.col(static_cast<Eigen::Index>(i)) = nets[i].col(function);
  return row;
}

/// Inner coefficients beyond the centre plane of a row whose points do not lie beyond it.
std::vector<int> beyond_centre_plane(const Eigen::VectorXd& coefficients, const Eigen::VectorXd& values) {
  std::vector<int> beyond;
  if (values.minCoeff() < 0.0) return beyond;
  const double rounding = 1e-13 * values.maxCoeff();
  for (Eigen::Index i = 1; i + 1 < coefficients.size(); ++i)
    if (coefficients(i) < -rounding) beyond.push_back(static_cast<int>(i));
  return beyond;
}

/// The points of a row; its half-breadths stay on their side of the centre plane where they can.
Points<3> closed_row(const KnotVector& knots, const std::vector<double>& u, const Points<3>& row) {
  Points<3> net = smoothest_net(knots, u, row, true, false);
  const Eigen::VectorXd values = row.row(y_row).transpose();
  const auto runs = constant_runs(values, true);
  std::vector<int> zeros;
  for (;;) {
    const std::vector<int> beyond = beyond_centre_plane(net.row(y_row).transpose(), values);
    if (beyond.empty()) return net;
    zeros.insert(zeros.end(), beyond.begin(), beyond.end());
    try {
      net.row(y_row) = SmoothestSpline(knots, {u, runs, false, zeros}).coefficients(row.row(y_row));
    } catch (const GeometryError&) {
      // Too few functions are left for the points: the row goes beyond.
      return net;
    }
  }
}

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
    if (sections[i].ends.size() != sections.front().ends.size()) {
      throw GeometryError(fmt::format("hull: {} has {} bands between knuckles, {} has {}", sections[i].name,
                                      sections[i].ends.size() - 1, sections.front().name,
                                      sections.front().ends.size() - 1));
    }
    if (i > 0 && !(u[i - 1] < u[i])) {
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
  std::vector<KnotVector> along;
  std::vector<std::vector<Points<3>>> bands;
  for (std::size_t band = 0; band + 1 < sections.front().ends.size(); ++band) {
    std::vector<BandSection> parts;
    for (std::size_t i = 0; i < sections.size(); ++i)
      parts.push_back(part(sections[i], band, i == 0 || i + 1 == sections.size()));
    if (uses_heights) {
      set_heights(parts);
    } else {
      set_chord_lengths(parts);
    }
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
