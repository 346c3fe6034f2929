#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/hull/offset_table.h"
#include "geometry/spline/knot_vector.h"
#include "geometry/spline/smoothest_spline.h"

/// The steps of skinning a hull's sections: parameters, splines along the sections, rows across them.
namespace isorim::geometry {

/// The part of a section between two knuckles, with a parameter for each point.
struct BandSection {
  Points<3> points;
  /// As HullSection::lines.
  std::vector<int> lines;
  std::vector<double> parameters;
  bool is_level_at_start = false;
  /// An end of the hull, where half-breadths of 0 may follow one another.
  bool is_end = false;
};

/// Throws GeometryError for successive points that coincide.
BandSection band_section(const HullSection& section, std::size_t band, bool is_end);

/// No section leans over between two points by more than 2 in half-breadth to 1 in height, nor a bulb's contour by as
/// much along the ship, and all rise.
bool can_use_heights(std::span<const HullSection> sections);

/// Sets the parameters over [0, 1]: heights, or chord lengths, of which sections with points on the same lines share
/// the means.
void set_parameters(std::span<BandSection> sections, bool uses_heights);

/// The parameters of all sections in order, without those that lie nearer to the one before than a quarter of the
/// smallest step of a section. `kept`, inside the domain, is among them, exactly.
std::vector<double> merged_parameters(std::span<const BandSection> sections, std::optional<double> kept = std::nullopt);

/// Runs of equal values, of at least three of them, or of two zeros where these close the hull.
std::vector<ConstantRun> constant_runs(const Eigen::VectorXd& values, bool zeros_close);

/// The coefficients for points at parameters, each coordinate with its flat parts; `is_level`: z starts level.
Points<3> smoothest_net(const KnotVector& knots, const std::vector<double>& parameters, const Points<3>& points,
                        bool zeros_close, bool is_level);

/// The net points of one function of v at all sections.
Points<3> row_of(std::span<const Points<3>> nets, Eigen::Index function);

/// Inner coefficients beyond the centre plane of a row whose points do not lie beyond it.
std::vector<int> beyond_centre_plane(const Eigen::VectorXd& coefficients, const Eigen::VectorXd& values);

/// The coefficients of a row through its points at u; its half-breadths stay on their side of the centre plane where
/// they can.
Points<3> closed_row(const KnotVector& knots, const std::vector<double>& u, const Points<3>& row);

}  // namespace isorim::geometry
