#include "io/iges/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/sweeps.h"
#include "io/iges/arc_length_curve.h"
#include "io/iges/fitting.h"

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Axis;
using geometry::HomogeneousPoints;
using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::SurfaceJet;
using geometry::Vector3;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr Interval unit_interval{0.0, 1.0};

/// The curve's parameters spread over [0, 1].
ParameterMap over_unit_interval(const ParametrisedCurve& curve) {
  if (!curve.parameters.is_identity()) return curve.parameters.over(unit_interval);
  return ParameterMap::affine(unit_interval, curve.curve.domain());
}

std::optional<double> turn_of(const ParametrisedCurve& curve) {
  for (const ParameterMap::Piece& piece : curve.parameters.pieces())
    if (piece.half_rate != 0.0) return std::numbers::pi / piece.half_rate;
  return std::nullopt;
}

/// As two curves over [0, 1] see each other: the largest difference of their relative NURBS parameters.
double largest_difference(const ParameterMap& first, const ParameterMap& second) {
  const auto relative = [](const ParameterMap& map, double t) {
    return (map(t) - map.image().first) / map.image().length();
  };
  double largest = 0.0;
  constexpr int samples = 96;
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    largest = std::max(largest, std::abs(relative(first, t) - relative(second, t)));
  }
  return largest;
}

}  // namespace

ParametrisedSurface transform(const ParametrisedSurface& surface, const AffineMap<3>& map) {
  ParametrisedSurface result = surface;
  if (!map.linear.isIdentity(0.0) || !map.translation.isZero(0.0)) result.surface = transform(surface.surface, map);
  return result;
}

ParametrisedSurface surface_of_revolution(const ParametrisedCurve& generatrix, const Axis& axis, double first,
                                          double last) {
  double sweep = last - first;
  if (!(sweep > 0.0) || sweep > two_pi + 1e-6)
    throw GeometryError(
        fmt::format("surface of revolution: from the angle {} to {}; expected a sweep in (0, 2 pi]", first, last));
  sweep = std::min(sweep, two_pi);
  NurbsCurve<3> start = generatrix.curve;
  if (first != 0.0) start = transform(start, geometry::rotation(axis, first));
  // u runs round, v along the curve; in IGES it is the other way.
  const NurbsSurface<3> surface = swap_directions(geometry::revolve(start, axis, sweep));
  const int pieces = (surface.count_v() - 1) / 2;
  const bool full = sweep >= two_pi * (1.0 - 1e-14);
  return {surface,
          {generatrix.parameters, ParameterMap::arc({first, first + sweep}, pieces, 1.0, full), turn_of(generatrix),
           two_pi},
          {},
          generatrix.deviation,
          generatrix.tolerance};
}

ParametrisedSurface tabulated_cylinder(const ParametrisedCurve& directrix, const Point3& end) {
  const Vector3 by = end - evaluate(directrix.curve, directrix.curve.domain().first);
  if (!(by.stableNorm() > 0.0)) throw GeometryError("tabulated cylinder: its generatrix has no length");
  return {geometry::extrude(directrix.curve, by),
          {over_unit_interval(directrix), {}, {}, {}},
          {{directrix.parameters, {}, turn_of(directrix), {}}},
          directrix.deviation,
          directrix.tolerance};
}

ParametrisedSurface ruled_surface(const ParametrisedCurve& first, const ParametrisedCurve& second, double tolerance) {
  const ParameterMap map = over_unit_interval(first);
  const double difference = largest_difference(map, over_unit_interval(second));
  // Equal up to the roundings of the angles.
  const bool exact = difference <= 1e-14;
  const ParametrisedCurve rail = exact ? first : in_own_parameter(first, unit_interval, tolerance);
  const ParametrisedCurve other = exact ? second : in_own_parameter(second, unit_interval, tolerance);
  const NurbsSurface<3> surface = geometry::ruled(rail.curve, other.curve);
  SurfaceParameters parameters{ParameterMap::affine(unit_interval, unit_interval), {}, {}, {}};
  SurfaceParameters own;
  if (exact) {
    // geometry::ruled() moves the curves' parameters to [0, 1].
    const Interval domain = rail.curve.domain();
    const auto moved = [&](const ParameterMap& given) {
      std::vector<ParameterMap::Piece> pieces(given.pieces().begin(), given.pieces().end());
      for (ParameterMap::Piece& piece : pieces)
        piece.to = {(piece.to.first - domain.first) / domain.length(),
                    (piece.to.last - domain.first) / domain.length()};
      return ParameterMap(std::move(pieces));
    };
    parameters.u = moved(map);
    own = {parameters.u.over(parameter_range(first)), {}, turn_of(first), {}};
  } else {
    own = {ParameterMap::affine(parameter_range(first), unit_interval), {}, turn_of(first), {}};
  }
  return {surface,
          parameters,
          {own},
          std::max({rail.deviation, other.deviation, first.deviation, second.deviation}),
          exact ? std::max(first.tolerance, second.tolerance) : tolerance};
}

ParametrisedSurface ruled_by_length(const ParametrisedCurve& first, const ParametrisedCurve& second, double tolerance) {
  return ruled_surface(by_relative_length(first, tolerance), by_relative_length(second, tolerance), tolerance);
}

ParametrisedSurface b_spline_surface(const BSplineSurfaceData& data, Remark& remark) {
  const NurbsSurface<3> whole = NurbsSurface<3>::from_points(
      KnotVector(data.degree_u, data.knots_u), KnotVector(data.degree_v, data.knots_v), data.points, data.weights);
  const Interval domain_u = whole.knots_u().domain();
  const Interval domain_v = whole.knots_v().domain();
  const Interval u = meant_range(data.range_u, domain_u, remark);
  const Interval v = meant_range(data.range_v, domain_v, remark);
  const auto same = [](const Interval& a, const Interval& b) { return a.first == b.first && a.last == b.last; };
  if (same(u, domain_u) && same(v, domain_v)) return {whole, {}, {}};
  return {restrict_to(whole, u, v), {}, {}};
}

namespace {

using Patch = Eigen::Matrix<double, 3, 16>;

struct PatchDegrees {
  int u = 1;
  int v = 1;
};

PatchDegrees degrees_of(std::span<const Patch> patches) {
  PatchDegrees degrees;
  for (const Patch& patch : patches)
    for (int k = 0; k < 16; ++k)
      if (!patch.col(k).isZero(0.0)) degrees = {std::max(degrees.u, k % 4), std::max(degrees.v, k / 4)};
  return degrees;
}

/// Powers of s in [0, h] to Bernstein polynomials: (k, i) = C(i, k) / C(degree, k) h^k.
Eigen::MatrixXd powers_to_bezier(int degree, double h) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(degree + 1, degree + 1);
  for (int i = 0; i <= degree; ++i) {
    double factor = 1.0;
    for (int k = 0; k <= i; ++k) {
      matrix(k, i) = factor;
      factor *= h * (i - k) / (degree - k > 0 ? degree - k : 1);
    }
  }
  return matrix;
}

Points<3> bezier_net(const Patch& patch, const PatchDegrees& degrees, double h, double k) {
  const Eigen::MatrixXd in_u = powers_to_bezier(degrees.u, h);
  const Eigen::MatrixXd in_v = powers_to_bezier(degrees.v, k);
  Points<3> net = Points<3>::Zero(3, (degrees.u + 1) * (degrees.v + 1));
  for (int l = 0; l <= degrees.v; ++l) {
    const Points<3> row = patch.middleCols(4 * l, degrees.u + 1) * in_u;
    for (int j = 0; j <= degrees.v; ++j) net.middleCols(j * (degrees.u + 1), degrees.u + 1) += in_v(l, j) * row;
  }
  return net;
}

}  // namespace

ParametrisedSurface parametric_spline_surface(std::span<const double> breakpoints_u,
                                              std::span<const double> breakpoints_v, std::span<const Patch> patches) {
  const std::size_t count_u = breakpoints_u.size() - 1;
  const std::size_t count_v = breakpoints_v.size() - 1;
  if (breakpoints_u.size() < 2 || breakpoints_v.size() < 2 || patches.size() != count_u * count_v)
    throw GeometryError(fmt::format("parametric spline surface: {} patches for {} x {} breakpoints", patches.size(),
                                    breakpoints_u.size(), breakpoints_v.size()));
  const PatchDegrees degrees = degrees_of(patches);
  const int width = static_cast<int>(count_u) * degrees.u + 1;
  const int height = static_cast<int>(count_v) * degrees.v + 1;
  Points<3> points(3, static_cast<Eigen::Index>(width) * height);
  std::vector<bool> is_set(static_cast<std::size_t>(points.cols()), false);
  double gap = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const std::size_t i = k % count_u;
    const std::size_t j = k / count_u;
    const Points<3> net = bezier_net(patches[k], degrees, breakpoints_u[i + 1] - breakpoints_u[i],
                                     breakpoints_v[j + 1] - breakpoints_v[j]);
    size = std::max(size, net.cwiseAbs().maxCoeff());
    for (Eigen::Index c = 0; c < net.cols(); ++c) {
      const Eigen::Index column = static_cast<Eigen::Index>(i) * degrees.u + c % (degrees.u + 1) +
                                  (static_cast<Eigen::Index>(j) * degrees.v + c / (degrees.u + 1)) * width;
      const std::size_t place = static_cast<std::size_t>(column);
      if (is_set[place]) gap = std::max(gap, (points.col(column) - net.col(c)).norm());
      points.col(column) = net.col(c);
      is_set[place] = true;
    }
  }
  if (!(gap <= 1e-6 * size))
    throw GeometryError(fmt::format("parametric spline surface: neighbouring patches are {:.3g} apart", gap));
  return {NurbsSurface<3>::from_points(piecewise_knots(degrees.u, breakpoints_u),
                                       piecewise_knots(degrees.v, breakpoints_v), points),
          {},
          {}};
}

namespace {

/// The unit normal, and at a point where one derivative vanishes its limit from inside the domain.
Vector3 unit_normal(const NurbsSurface<3>& surface, const Point2& uv) {
  const SurfaceJet<3> jet = evaluate_jet(surface, uv);
  const Vector3 normal = jet.du.cross(jet.dv);
  const double scale_u = jet.du.norm();
  const double scale_v = jet.dv.norm();
  if (normal.norm() > 1e-9 * scale_u * scale_v && scale_u > 1e-9 * jet.duv.norm() * 1.0 &&
      scale_v > 1e-9 * jet.duv.norm())
    return normal.normalized();
  const Interval u = surface.knots_u().domain();
  const Interval v = surface.knots_v().domain();
  // S_u(u, v + h) = h S_uv where S_u vanishes along the edge v.
  const double into_v = uv.y() < v.middle() ? 1.0 : -1.0;
  const double into_u = uv.x() < u.middle() ? 1.0 : -1.0;
  const Vector3 limit =
      scale_u < scale_v ? Vector3(into_v * jet.duv.cross(jet.dv)) : Vector3(into_u * jet.du.cross(jet.duv));
  if (!(limit.norm() > 0.0))
    throw GeometryError(fmt::format("offset surface: the base surface has no normal at ({}, {})", uv.x(), uv.y()));
  return limit.normalized();
}

/// The breakpoints of one direction in IGES parameters.
std::vector<double> breakpoints_of(const ParameterMap& map, const KnotVector& knots) {
  if (map.is_identity()) return knots.breakpoints();
  const Interval range = map.domain();
  std::vector<double> result = map.breakpoints(range);
  for (const ParameterMap::Piece& piece : map.pieces())
    if (piece.half_rate == 0.0)
      for (const double u : knots.breakpoints())
        if (piece.to.first < u && u < piece.to.last)
          result.push_back(piece.from.first + (u - piece.to.first) / piece.to.length() * piece.from.length());
  result.push_back(range.first);
  result.push_back(range.last);
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Throws if the normal jumps across an inner knot line.
void require_smooth(const NurbsSurface<3>& surface) {
  const auto check = [&](const KnotVector& across, const KnotVector& along, bool across_u) {
    const std::vector<double> lines = across.breakpoints();
    const Interval range = along.domain();
    const double step = 1e-9 * across.domain().length();
    for (std::size_t i = 1; i + 1 < lines.size(); ++i)
      for (const double part : {0.17, 0.5, 0.83}) {
        const double s = range.first + part * range.length();
        const auto normal = [&](double t) { return unit_normal(surface, across_u ? Point2(t, s) : Point2(s, t)); };
        if ((normal(lines[i]) - normal(lines[i] - step)).norm() > 1e-5)
          throw GeometryError(fmt::format("offset surface: the base surface has an edge along {} = {}",
                                          across_u ? "u" : "v", lines[i]));
      }
  };
  check(surface.knots_u(), surface.knots_v(), true);
  check(surface.knots_v(), surface.knots_u(), false);
}

}  // namespace

ParametrisedSurface offset_surface(const ParametrisedSurface& base, double distance, double tolerance) {
  require_smooth(base.surface);
  const ParameterMap& map_u = base.parameters.u;
  const ParameterMap& map_v = base.parameters.v;
  const FittedSurface fit = fit_surface(
      [&](const Point2& uv) -> Point3 {
        const Point2 own(map_u(uv.x()), map_v(uv.y()));
        return evaluate(base.surface, own) + distance * unit_normal(base.surface, own);
      },
      breakpoints_of(map_u, base.surface.knots_u()), breakpoints_of(map_v, base.surface.knots_v()),
      {.tolerance = tolerance, .largest_count = 64});
  return {fit.surface,
          {{}, {}, base.parameters.turn_u, base.parameters.turn_v},
          {},
          std::max(fit.deviation, base.deviation),
          tolerance};
}

}  // namespace isorim::io::iges
