#include "geometry/hull/bulb_surface.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/hull/section_nets.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

constexpr int degree = 3;

/// The sections of a hull with a bulb.
struct BulbHull {
  /// From the stern to the last one that runs from keel to deck.
  std::span<const HullSection> full;
  HullSection stem;
  /// Its stations and its contour.
  std::span<const HullSection> bulb;
};

BulbHull parts_of(std::span<const HullSection> sections) {
  const auto first_in_bulb = std::find_if(sections.begin(), sections.end(), [](const auto& s) { return s.is_in_bulb; });
  const auto stem = static_cast<std::size_t>(first_in_bulb - sections.begin()) - 1;
  return {sections.first(stem), sections[stem], sections.subspan(stem + 1)};
}

std::vector<double> stations_of(std::span<const HullSection> sections) {
  std::vector<double> x;
  for (const HullSection& section : sections)
    x.push_back(section.is_contour ? section.points.row(0).mean() : section.points(0, 0));
  return x;
}

/// Where the rows pass the sections.
struct Rows {
  std::vector<double> full;
  double notch = 0.0;
  std::vector<double> bulb;
};

Rows rows_of(const BulbHull& hull) {
  Rows rows{stations_of(hull.full), hull.stem.points(0, 0), stations_of(hull.bulb)};
  // x rises like a parabola on the last stretch, whose end is level: at half the speed.
  const double before = rows.bulb.size() > 1 ? rows.bulb[rows.bulb.size() - 2] : rows.full.back();
  rows.bulb.back() += rows.bulb.back() - before;
  return rows;
}

std::vector<double> joined(std::vector<double> first, double middle, const std::vector<double>& second) {
  first.push_back(middle);
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Both parts of a spline cut at an inner point, with the coefficient there in common.
std::pair<BSpline, BSpline> cut(const BSpline& spline, double at) {
  const int p = spline.knots.degree();
  const std::vector<double> more(static_cast<std::size_t>(p - spline.knots.multiplicity(at)), at);
  const BSpline refined = refine_knots(spline, more);
  const auto knots = refined.knots.knots();
  const auto first = std::lower_bound(knots.begin(), knots.end(), at) - knots.begin();
  std::vector<double> low(knots.begin(), knots.begin() + first + p);
  low.push_back(at);
  std::vector<double> high(knots.begin() + first, knots.end());
  high.insert(high.begin(), at);
  return {{KnotVector(p, std::move(low)), refined.coefficients.leftCols(first)},
          {KnotVector(p, std::move(high)), refined.coefficients.rightCols(refined.coefficients.cols() - first + 1)}};
}

/// The parameter at which the section has a height, between its points as the heights are.
double parameter_at(const BandSection& section, double height, const std::string& name) {
  const Points<3>& points = section.points;
  for (Eigen::Index i = 1; i < points.cols(); ++i) {
    const double low = points(2, i - 1);
    const double high = points(2, i);
    if (!(low <= height && height <= high && low < high)) continue;
    const auto k = static_cast<std::size_t>(i);
    const double part = (height - low) / (high - low);
    const double t = section.parameters[k - 1] + part * (section.parameters[k] - section.parameters[k - 1]);
    if (t > 0.0 && t < 1.0) return t;
  }
  throw GeometryError(
      fmt::format("hull: the stem begins above the bulb at height {}; expected it between the keel and the top (or "
                  "first knuckle) of {}, {} and {}",
                  height, name, points(2, 0), points(2, points.cols() - 1)));
}

/// The coefficients of values whose spline is level at the last parameter.
Eigen::RowVectorXd level_at_end(const KnotVector& knots, const std::vector<double>& u, const Eigen::RowVectorXd& row) {
  const auto negative = [](std::span<const double> values) {
    std::vector<double> result(values.rbegin(), values.rend());
    for (double& value : result) value = -value;
    return result;
  };
  const Eigen::RowVectorXd values = row.reverse();
  const KnotVector reversed(knots.degree(), negative(knots.knots()));
  const SmoothestSpline spline(reversed, {negative(u), constant_runs(values.transpose(), false), true});
  return spline.coefficients(values).reverse();
}

/// The lowest band, with its sections cut at the line from the notch.
class LowestBand {
 public:
  LowestBand(const BulbHull& hull, const Rows& rows, bool uses_heights) : rows_(rows) {
    std::vector<BandSection> full = band_sections(hull.full);
    full.front().is_end = true;
    set_parameters(full, uses_heights);
    const double height = hull.stem.points(2, 0);
    const double line = parameter_at(full.back(), height, hull.full.back().name);
    std::vector<BandSection> bulb = band_sections(hull.bulb);
    bulb.back().is_end = true;
    set_parameters(bulb, uses_heights);
    for (BandSection& section : bulb) move_parameters(section, 0.0, line);
    std::vector<BandSection> stem{band_section(hull.stem, 0, true)};
    set_parameters(stem, uses_heights);
    move_parameters(stem.front(), line, 1.0);

    std::vector<BandSection> all = full;
    all.insert(all.end(), bulb.begin(), bulb.end());
    all.insert(all.end(), stem.begin(), stem.end());
    const KnotVector along = doubled_knots(degree, merged_parameters(all, line));
    for (const BandSection& section : full) {
      auto [low, high] = cut({along, net_of(along, section)}, line);
      lower_.push_back(low.coefficients);
      upper_.push_back(high.coefficients);
      below_ = low.knots;
      above_ = high.knots;
    }
    for (const BandSection& section : bulb) bulb_.push_back(net_of(below_, section));
    stem_ = net_of(above_, stem.front());
  }

  /// The hull below the line, the bulb, the hull above the line.
  std::vector<NurbsSurface<3>> surfaces(const KnotVector& across) const {
    const auto count = static_cast<Eigen::Index>(below_.basis_count());
    std::vector<Points<3>> aft;
    std::vector<Points<3>> fore;
    KnotVector aft_knots = across;
    KnotVector fore_knots = across;
    for (Eigen::Index k = 0; k + 1 < count; ++k) {
      auto [before, after] = cut({across, lower_row(across, k)}, rows_.notch);
      aft.emplace_back(before.coefficients);
      fore.emplace_back(after.coefficients);
      aft_knots = before.knots;
      fore_knots = after.knots;
    }
    aft.push_back(aft_row(aft_knots, lower_, count - 1));
    fore.push_back(closed_row(fore_knots, joined({}, rows_.notch, rows_.bulb), with_notch(row_of(bulb_, count - 1))));
    std::vector<Points<3>> above;
    for (Eigen::Index k = 0; k < above_.basis_count(); ++k) above.push_back(aft_row(aft_knots, upper_, k));
    return {surface(aft_knots, below_, aft), surface(fore_knots, below_, fore), surface(aft_knots, above_, above)};
  }

 private:
  static std::vector<BandSection> band_sections(std::span<const HullSection> sections) {
    std::vector<BandSection> result;
    for (const HullSection& section : sections) result.push_back(band_section(section, 0, false));
    return result;
  }

  static void move_parameters(BandSection& section, double first, double last) {
    for (double& t : section.parameters) t = first + (last - first) * t;
    section.parameters.front() = first;
    section.parameters.back() = last;
  }

  static Points<3> net_of(const KnotVector& knots, const BandSection& section) {
    return smoothest_net(knots, section.parameters, section.points, section.is_end, section.is_level_at_start);
  }

  static NurbsSurface<3> surface(const KnotVector& across, const KnotVector& along,
                                 const std::vector<Points<3>>& rows) {
    Points<3> net(3, Eigen::Index{across.basis_count()} * along.basis_count());
    Eigen::Index column = 0;
    for (const Points<3>& row : rows) {
      net.middleCols(column, row.cols()) = row;
      column += row.cols();
    }
    return NurbsSurface<3>::from_points(across, along, net);
  }

  /// From the stern through the bulb to its contour.
  Points<3> lower_row(const KnotVector& across, Eigen::Index k) const {
    std::vector<Points<3>> nets = lower_;
    nets.insert(nets.end(), bulb_.begin(), bulb_.end());
    std::vector<double> u = rows_.full;
    u.insert(u.end(), rows_.bulb.begin(), rows_.bulb.end());
    const Points<3> row = row_of(nets, k);
    Points<3> net = closed_row(across, u, row);
    if (k == 0) return net;
    for (const Eigen::Index coordinate : {0, 2}) net.row(coordinate) = level_at_end(across, u, row.row(coordinate));
    return net;
  }

  /// From the stern to the stem.
  Points<3> aft_row(const KnotVector& knots, const std::vector<Points<3>>& nets, Eigen::Index k) const {
    Points<3> points(3, static_cast<Eigen::Index>(nets.size()) + 1);
    const bool is_line = &nets == &lower_;
    points << row_of(nets, k), stem_.col(is_line ? 0 : k);
    return closed_row(knots, joined(rows_.full, rows_.notch, {}), points);
  }

  Points<3> with_notch(const Points<3>& row) const {
    Points<3> points(3, row.cols() + 1);
    points << stem_.col(0), row;
    return points;
  }

  const Rows& rows_;
  KnotVector below_ = KnotVector::bezier(degree);
  KnotVector above_ = KnotVector::bezier(degree);
  std::vector<Points<3>> lower_;
  std::vector<Points<3>> upper_;
  std::vector<Points<3>> bulb_;
  Points<3> stem_;
};

/// A band above a knuckle, from the stern to the stem.
NurbsSurface<3> band_above(const BulbHull& hull, std::size_t band, const KnotVector& across,
                           const std::vector<double>& u, bool uses_heights) {
  std::vector<BandSection> parts;
  for (const HullSection& section : hull.full) parts.push_back(band_section(section, band, parts.empty()));
  parts.push_back(band_section(hull.stem, band, true));
  set_parameters(parts, uses_heights);
  const KnotVector along = doubled_knots(degree, merged_parameters(parts));
  std::vector<Points<3>> nets;
  for (const BandSection& section : parts)
    nets.push_back(smoothest_net(along, section.parameters, section.points, section.is_end, false));
  const Eigen::Index width = across.basis_count();
  Points<3> net(3, width * along.basis_count());
  for (Eigen::Index k = 0; k < along.basis_count(); ++k)
    net.middleCols(k * width, width) = closed_row(across, u, row_of(nets, k));
  return NurbsSurface<3>::from_points(across, along, net);
}

}  // namespace

std::vector<NurbsSurface<3>> bulb_hull_surface(std::span<const HullSection> sections, bool uses_heights) {
  const BulbHull hull = parts_of(sections);
  const Rows rows = rows_of(hull);
  const KnotVector across = doubled_knots(degree, joined(rows.full, rows.notch, rows.bulb));
  std::vector<NurbsSurface<3>> surfaces = LowestBand(hull, rows, uses_heights).surfaces(across);
  const std::vector<double> u = joined(rows.full, rows.notch, {});
  for (std::size_t band = 1; band + 1 < hull.full.front().ends.size(); ++band)
    surfaces.push_back(band_above(hull, band, surfaces.front().knots_u(), u, uses_heights));
  return surfaces;
}

}  // namespace isorim::geometry
