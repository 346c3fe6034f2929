#include "geometry/hull/section_nets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

constexpr Eigen::Index y_row = 1;
constexpr Eigen::Index z_row = 2;
/// Successive equal values that make a flat part; at edges in the centre plane two zeros do.
constexpr int flat_count = 3;
constexpr int closed_count = 2;

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
void set_heights(std::span<BandSection> sections) {
  for (BandSection& section : sections) {
    const double low = section.points(2, 0);
    const double range = section.points(2, section.points.cols() - 1) - low;
    section.parameters.clear();
    for (Eigen::Index i = 0; i < section.points.cols(); ++i)
      section.parameters.push_back((section.points(2, i) - low) / range);
  }
}

/// Chord lengths; sections with points on the same lines share the means of theirs.
void set_chord_lengths(std::span<BandSection> sections) {
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

}  // namespace

BandSection band_section(const HullSection& section, std::size_t band, bool is_end) {
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

bool can_use_heights(std::span<const HullSection> sections) {
  constexpr double steepest = 2.0;
  for (const HullSection& section : sections) {
    for (Eigen::Index i = 1; i < section.points.cols(); ++i) {
      const Vector3 step = section.points.col(i) - section.points.col(i - 1);
      const double aside = section.is_in_bulb ? std::max(std::abs(step.x()), std::abs(step.y())) : std::abs(step.y());
      if (!(step.z() > 0.0 && aside <= steepest * step.z())) return false;
    }
  }
  return true;
}

void set_parameters(std::span<BandSection> sections, bool uses_heights) {
  if (uses_heights) {
    set_heights(sections);
  } else {
    set_chord_lengths(sections);
  }
}

std::vector<double> merged_parameters(std::span<const BandSection> sections, std::optional<double> kept) {
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
  if (kept) {
    std::erase_if(merged, [&](double t) { return t > 0.0 && t < 1.0 && std::abs(t - *kept) <= 0.25 * smallest; });
    merged.insert(std::upper_bound(merged.begin(), merged.end(), *kept), *kept);
  }
  return merged;
}

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

Points<3> smoothest_net(const KnotVector& knots, const std::vector<double>& parameters, const Points<3>& points,
                        bool zeros_close, bool is_level) {
  Points<3> net(3, knots.basis_count());
  for (Eigen::Index row = 0; row < 3; ++row) {
    const auto runs = constant_runs(points.row(row).transpose(), zeros_close && row == y_row);
    net.row(row) = SmoothestSpline(knots, {parameters, runs, is_level && row == z_row}).coefficients(points.row(row));
  }
  return net;
}

Points<3> row_of(std::span<const Points<3>> nets, Eigen::Index function) {
  Points<3> row(3, static_cast<Eigen::Index>(nets.size()));
  for (std::size_t i = 0; i < nets.size(); ++i) row.col(static_cast<Eigen::Index>(i)) = nets[i].col(function);
  return row;
}

std::vector<int> beyond_centre_plane(const Eigen::VectorXd& coefficients, const Eigen::VectorXd& values) {
  std::vector<int> beyond;
  if (values.minCoeff() < 0.0) return beyond;
  const double rounding = 1e-13 * values.maxCoeff();
  for (Eigen::Index i = 1; i + 1 < coefficients.size(); ++i)
    if (coefficients(i) < -rounding) beyond.push_back(static_cast<int>(i));
  return beyond;
}

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

}  // namespace isorim::geometry
