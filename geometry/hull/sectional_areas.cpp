#include "geometry/hull/sectional_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/interpolation.h"
#include "geometry/spline/smoothest_spline.h"

namespace isorim::geometry {
namespace {

/// Gauss-Legendre with four points on [0, 1]: exact up to degree 7.
constexpr std::array<double, 4> gauss_points{0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                             0.9305681557970263};
constexpr std::array<double, 4> gauss_weights{0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                              0.17392742256872692};

/// Where along a Bézier segment, whose height rises, it reaches `height`: its end if it does not.
double reach(const NurbsCurve<3>& line, const Interval& span, double height) {
  if (evaluate(line, span.last).z() <= height) return span.last;
  double low = span.first;
  double high = span.last;
  for (int k = 0; k < 200 && high - low > 1e-16 * span.length(); ++k) {
    const double middle = 0.5 * (low + high);
    (evaluate(line, middle).z() <= height ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double area_of_line(const NurbsCurve<3>& line, double height) {
  double area = 0.0;
  const std::vector<double> breaks = line.knots().breakpoints();
  for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
    const Interval span{breaks[s], breaks[s + 1]};
    if (evaluate(line, span.first).z() >= height) break;
    const double end = reach(line, span, height);
    for (std::size_t g = 0; g < gauss_points.size(); ++g) {
      const double t = span.first + (end - span.first) * gauss_points[g];
      const CurveJet<3> jet = evaluate_jet(line, t);
      area += 2.0 * (end - span.first) * gauss_weights[g] * jet.point.y() * jet.du.z();
    }
  }
  return area;
}

/// Volume and centroid of the curve through the areas.
void measure(SectionalAreas& curve) {
  const auto count = static_cast<Eigen::Index>(curve.places.size());
  const Eigen::Map<const Eigen::RowVectorXd> values(curve.areas.data(), count);
  std::vector<ConstantRun> runs;
  for (Eigen::Index first = 0, last = 0; first < count; first = last + 1) {
    for (last = first; last + 1 < count && values(last + 1) == values(first);) ++last;
    if (last - first >= 2) runs.push_back({static_cast<int>(first), static_cast<int>(last)});
  }
  const int degree = std::min(3, static_cast<int>(count) - 1);
  const KnotVector knots = runs.empty() ? averaged_knots(degree, curve.places) : doubled_knots(3, curve.places);
  const BSpline spline{knots, SmoothestSpline(knots, {curve.places, runs, false}).coefficients(values)};
  double moment = 0.0;
  curve.volume = 0.0;
  const std::vector<double> breaks = knots.breakpoints();
  for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
    const double width = breaks[s + 1] - breaks[s];
    for (std::size_t g = 0; g < gauss_points.size(); ++g) {
      const double x = breaks[s] + width * gauss_points[g];
      const double part = width * gauss_weights[g] * evaluate(spline, x)(0);
      curve.volume += part;
      moment += x * part;
    }
  }
  curve.centroid = moment / curve.volume;
  curve.largest = values.maxCoeff();
}

double midships(const OffsetTable& table) {
  return table.after_perpendicular + 0.5 * table.length;
}

/// One half of the ship as the shift sees it.
struct Half {
  double middle = 0.0;
  double end = 0.0;
  /// Part of the way at which the parallel middle body ends.
  double parallel = 0.0;

  double moved(double x, double factor) const {
    const double s = (x - middle) / (end - middle);
    if (s <= parallel || s >= 1.0) return x;
    return x + factor * (1.0 - s) * (s - parallel) * (end - middle);
  }
};

struct Halves {
  Half aft;
  Half forward;

  double moved(double x, const Eigen::Vector2d& factors) const {
    return x < forward.middle ? aft.moved(x, factors(0)) : forward.moved(x, factors(1));
  }
};

Halves halves_of(const SectionalAreas& curve, const OffsetTable& table) {
  const double middle = midships(table);
  const double full = curve.largest * (1.0 - 1e-12);
  double from = middle;
  double to = middle;
  for (std::size_t i = 0; i < curve.places.size(); ++i) {
    if (curve.areas[i] < full) continue;
    from = std::min(from, curve.places[i]);
    to = std::max(to, curve.places[i]);
  }
  const double start = curve.places.front();
  const double end = curve.places.back();
  return {{middle, start, (from - middle) / (start - middle)}, {middle, end, (to - middle) / (end - middle)}};
}

}  // namespace

double section_area(std::span<const NurbsSurface<3>> bands, double u, double height) {
  double area = 0.0;
  for (const NurbsSurface<3>& band : bands) {
    const Interval domain = band.knots_u().domain();
    if (u >= domain.first && u <= domain.last) area += area_of_line(isoparametric_curve(band, Direction::v, u), height);
  }
  return area;
}

SectionalAreas sectional_areas(const OffsetTable& table, const HullSurfaceOptions& options) {
  const std::vector<HullSection> sections = hull_sections(table);
  const std::vector<NurbsSurface<3>> bands = hull_surface(sections, options);
  SectionalAreas curve;
  const std::vector<double> places = section_parameters(sections);
  const double height = table.baseline + table.draught;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    // A stem above a bulb is no end of the curve.
    if (sections[i].is_contour && i > 0 && i + 1 < sections.size()) continue;
    curve.places.push_back(places[i]);
    curve.areas.push_back(sections[i].is_contour ? 0.0 : section_area(bands, places[i], height));
  }
  measure(curve);
  return curve;
}

double prismatic_coefficient(const SectionalAreas& areas, const OffsetTable& table) {
  return areas.volume / (table.length * areas.largest);
}

double buoyancy_centre(const SectionalAreas& areas, const OffsetTable& table) {
  return (areas.centroid - midships(table)) / table.length;
}

OffsetTable shift_sections(const OffsetTable& table, const SectionShift& target, const HullSurfaceOptions& options) {
  const SectionalAreas given = sectional_areas(table, options);
  const Halves halves = halves_of(given, table);
  const auto residual = [&](const Eigen::Vector2d& factors) -> Eigen::Vector2d {
    SectionalAreas moved = given;
    for (double& x : moved.places) x = halves.moved(x, factors);
    for (std::size_t i = 1; i < moved.places.size(); ++i) {
      if (moved.places[i - 1] < moved.places[i]) continue;
      throw GeometryError(
          fmt::format("hull \"{}\": a prismatic coefficient of {} and a centre of buoyancy {} forward of amidships "
                      "would move stations past one another; those of the table are {:.6g} and {:.6g}",
                      table.name, target.prismatic, target.centre, prismatic_coefficient(given, table),
                      buoyancy_centre(given, table)));
    }
    measure(moved);
    return {prismatic_coefficient(moved, table) - target.prismatic, buoyancy_centre(moved, table) - target.centre};
  };
  Eigen::Vector2d factors = Eigen::Vector2d::Zero();
  Eigen::Vector2d defect = residual(factors);
  for (int step = 0; step < 50 && defect.cwiseAbs().maxCoeff() > 1e-14; ++step) {
    constexpr double difference = 1e-5;
    Eigen::Matrix2d jacobian;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d aside = difference * Eigen::Vector2d::Unit(k);
      jacobian.col(k) = (residual(factors + aside) - residual(factors - aside)) / (2.0 * difference);
    }
    factors -= jacobian.inverse() * defect;
    defect = residual(factors);
  }
  if (!(defect.cwiseAbs().maxCoeff() < 1e-12)) {
    throw GeometryError(
        fmt::format("hull \"{}\": no shift of the sections gives the prismatic coefficient {} and the "
                    "centre of buoyancy {}",
                    table.name, target.prismatic, target.centre));
  }
  OffsetTable result = table;
  for (double& x : result.stations) x = halves.moved(x, factors);
  // The notch moves with the sections about it; the nose is an end of the ship.
  if (table.bulb.cols() > 0)
    for (double& x : result.stem.row(0)) x = halves.moved(x, factors);
  return result;
}

}  // namespace isorim::geometry
