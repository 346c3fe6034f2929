#include "geometry/propeller/table_blade.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/propeller/tip_outline.h"

namespace isorim::geometry {
namespace {

void check_row(const TableBlade& blade, std::size_t k) {
  const BladeTableRow& row = blade.rows[k];
  const std::string name = fmt::format("blade table, row {} (r/R = {})", k + 1, row.radius_ratio);
  for (const double value :
       {row.radius_ratio, row.chord, row.pitch, row.skew, row.rake, row.max_thickness, row.max_camber})
    if (!std::isfinite(value)) throw GeometryError(fmt::format("{}: found {}; expected numbers", name, value));
  if (!(row.radius_ratio > 0.0 && row.radius_ratio <= 1.0))
    throw GeometryError(fmt::format("{}: r/R lies between 0 and 1, the radius over that of the tip", name));
  if (k > 0 && !(row.radius_ratio > blade.rows[k - 1].radius_ratio))
    throw GeometryError(
        fmt::format("{}: the row before has {}; the radii have to rise", name, blade.rows[k - 1].radius_ratio));
  const bool is_tip = k + 1 == blade.rows.size();
  if (row.chord < 0.0 || (row.chord == 0.0 && !is_tip))
    throw GeometryError(fmt::format("{}: the chord is {}; expected a positive one, or 0 at the tip", name, row.chord));
  const bool is_point = is_tip && row.chord == 0.0;
  if (row.max_thickness < 0.0 || (row.max_thickness == 0.0 && !is_point))
    throw GeometryError(fmt::format("{}: the thickness is {}; expected a positive one", name, row.max_thickness));
}

void check_table(const TableBlade& blade) {
  constexpr std::size_t fewest_rows = 3;
  if (blade.rows.size() < fewest_rows)
    throw GeometryError(fmt::format("blade table: {} row(s), at least {} are needed", blade.rows.size(), fewest_rows));
  for (std::size_t k = 0; k < blade.rows.size(); ++k) check_row(blade, k);
  if (blade.rows.back().radius_ratio != 1.0)
    throw GeometryError(
        fmt::format("blade table: the last row has r/R = {}; expected the tip, 1", blade.rows.back().radius_ratio));
}

BladeSection section_of(const TableBlade& blade, const BladeTableRow& row) {
  ProfileSection profile;
  profile.station = {0.5 * blade.diameter * row.radius_ratio, row.pitch, row.skew, row.rake};
  profile.chord = row.chord;
  profile.max_thickness = row.max_thickness;
  profile.max_camber = row.max_camber;
  profile.thickness = blade.thickness;
  profile.camber = blade.camber;
  return profile_section(profile, blade.points_a_side);
}

/// A column of the table over all its rows.
RadialLaw law(const TableBlade& blade, double BladeTableRow::*column) {
  std::vector<double> radii;
  std::vector<double> values;
  for (const BladeTableRow& row : blade.rows) {
    radii.push_back(row.radius_ratio);
    values.push_back(row.*column);
  }
  return {"blade table", radii, values};
}

/// Of the camber to the chord, over the rows that have one.
RadialLaw camber_ratio(const TableBlade& blade) {
  std::vector<double> radii;
  std::vector<double> values;
  for (const BladeTableRow& row : blade.rows) {
    if (row.chord == 0.0) continue;
    radii.push_back(row.radius_ratio);
    values.push_back(row.max_camber / row.chord);
  }
  return {"blade table", radii, values};
}

/// The rows between the last one with a chord and the tip.
std::vector<BladeTableRow> rows_of_tip(const TableBlade& blade) {
  std::vector<double> radii;
  std::vector<OutlineEdges> edges;
  for (const BladeTableRow& row : blade.rows) {
    if (row.chord == 0.0) continue;
    radii.push_back(row.radius_ratio);
    edges.push_back({0.5 * row.chord, -0.5 * row.chord});
  }
  const RoundedOutline outline(radii, edges);
  const RadialLaw camber = camber_ratio(blade);
  const double tip_thickness = 2.0 * blade.rows.back().max_thickness / blade.diameter;
  std::vector<BladeTableRow> rows;
  for (const double ratio : tip_radii(radii.back())) {
    if (ratio == 1.0) continue;
    BladeTableRow row;
    row.radius_ratio = ratio;
    row.chord = outline(ratio).leading - outline(ratio).trailing;
    row.pitch = law(blade, &BladeTableRow::pitch)(ratio);
    row.skew = law(blade, &BladeTableRow::skew)(ratio);
    row.rake = law(blade, &BladeTableRow::rake)(ratio);
    row.max_thickness = law(blade, &BladeTableRow::max_thickness)(ratio);
    if (tip_thickness > 0.0) row.max_thickness *= tip_thickness_factor(ratio, radii.back(), tip_thickness);
    row.max_camber = camber(ratio) * row.chord;
    rows.push_back(row);
  }
  return rows;
}

/// Twice the area, counter-clockwise positive, of the closed polygon.
double doubled_area(const Points<2>& outline) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    const Point2 a = outline.col(i);
    const Point2 b = outline.col((i + 1) % outline.cols());
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// Of a polyline whose x goes one way, at x.
double height_at(const Points<2>& line, double x) {
  for (Eigen::Index i = 0; i + 1 < line.cols(); ++i) {
    const double from = line(0, i);
    const double to = line(0, i + 1);
    if (from == to || (x - from) * (x - to) > 0.0) continue;
    return std::lerp(line(1, i), line(1, i + 1), (x - from) / (to - from));
  }
  return line(1, line.cols() - 1);
}

/// The largest distance, in y, between the back and the face, at their points.
double largest_thickness(const Points<2>& outline, Eigen::Index leading_edge) {
  const Points<2> back = outline.leftCols(leading_edge + 1);
  const Points<2> face = outline.rightCols(outline.cols() - leading_edge);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < back.cols(); ++i) largest = std::max(largest, back(1, i) - height_at(face, back(0, i)));
  for (Eigen::Index i = 0; i < face.cols(); ++i) largest = std::max(largest, height_at(back, face(0, i)) - face(1, i));
  return largest;
}

}  // namespace

std::vector<BladeSection> table_sections(const TableBlade& blade) {
  check_table(blade);
  std::vector<BladeSection> sections;
  for (const BladeTableRow& row : blade.rows)
    if (row.chord > 0.0) sections.push_back(section_of(blade, row));
  const BladeTableRow& tip = blade.rows.back();
  if (tip.chord > 0.0) return sections;
  for (const BladeTableRow& row : rows_of_tip(blade)) sections.push_back(section_of(blade, row));
  BladeSection point = sections.back();
  point.station = {0.5 * blade.diameter, tip.pitch, tip.skew, tip.rake};
  point.chord = 0.0;
  point.leading_edge = 0.0;
  point.max_thickness = 0.0;
  point.outline.setZero();
  sections.push_back(std::move(point));
  return sections;
}

BladeSection point_section(const BladeStation& station, Points<2> outline) {
  const std::string name = fmt::format("blade section at the radius {:.6g}", station.radius);
  constexpr Eigen::Index fewest_points = 5;
  if (outline.cols() < fewest_points)
    throw GeometryError(fmt::format("{}: {} points, at least {} are needed", name, outline.cols(), fewest_points));
  if (!outline.allFinite()) throw GeometryError(fmt::format("{}: a point is not finite", name));
  if (!(doubled_area(outline) < 0.0))
    throw GeometryError(
        fmt::format("{}: the points run along the face first, or enclose nothing; expected the trailing "
                    "edge, the back, the leading edge, the face",
                    name));
  Eigen::Index leading_edge = 0;
  outline.row(0).maxCoeff(&leading_edge);
  if (leading_edge == 0 || leading_edge + 1 == outline.cols())
    throw GeometryError(
        fmt::format("{}: the leading edge, where x is largest, is point {}; expected one between the "
                    "first and the last, which are the trailing edge",
                    name, leading_edge + 1));
  const double trailing_edge = 0.5 * (outline(0, 0) + outline(0, outline.cols() - 1));
  const double thickness = largest_thickness(outline, leading_edge);
  const double leading = outline(0, leading_edge);
  return {station, leading - trailing_edge, leading, thickness, std::move(outline), leading_edge};
}

}  // namespace isorim::geometry
