#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/nurbs/surface.h"
#include "geometry/shapes/transforms.h"
#include "geometry/vocabulary.h"
#include "io/iges/curves.h"
#include "io/iges/parameter_map.h"

/// The surfaces of IGES as NURBS: conversions of numbers, which know no file. All throw GeometryError if the numbers
/// describe no surface.
namespace isorim::io::iges {

/// From the parameters that IGES gives a surface to those of the NURBS, and how long a turn is where a parameter is an
/// angle: curves in parameter space may be given on any turn.
struct SurfaceParameters {
  ParameterMap u;
  ParameterMap v;
  /// 2 pi or 360; none if the parameter is no angle.
  std::optional<double> turn_u;
  std::optional<double> turn_v;
};

/// The point at IGES parameters (u, v) is evaluate(surface, {parameters.u(u), parameters.v(v)}); the natural normal is
/// that of IGES.
struct ParametrisedSurface {
  geometry::NurbsSurface<3> surface;
  SurfaceParameters parameters;
  /// What other programs take for the parameters of this entity; the curves on it tell which is meant.
  std::vector<SurfaceParameters> alternatives;
  /// 0 if the NURBS is exact; else the largest distance found, and what was asked for.
  double deviation = 0.0;
  double tolerance = 0.0;
};

ParametrisedSurface transform(const ParametrisedSurface& surface, const geometry::AffineMap<3>& map);

/// 120: u along the generatrix, v the angle from `first` to `last` in radians, right-handed about the axis. A sweep
/// beyond a full turn by less than 1e-6 is a full turn.
ParametrisedSurface surface_of_revolution(const ParametrisedCurve& generatrix, const geometry::Axis& axis, double first,
                                          double last);

/// 122: directrix(u) + v (end - directrix(0)), u and v in [0, 1].
ParametrisedSurface tabulated_cylinder(const ParametrisedCurve& directrix, const geometry::Point3& end);

/// 118 form 1: (1 - v) first(u) + v second(u), u and v in [0, 1], both curves at equal relative parameters. Exact
/// where their parameter maps agree (two lines or splines, two arcs of one angle); else both curves are fitted.
ParametrisedSurface ruled_surface(const ParametrisedCurve& first, const ParametrisedCurve& second, double tolerance);
/// 118 form 0: the same at equal relative arc lengths. Exact for lines and circular arcs.
ParametrisedSurface ruled_by_length(const ParametrisedCurve& first, const ParametrisedCurve& second, double tolerance);

struct BSplineSurfaceData {
  int degree_u = 1;
  int degree_v = 1;
  std::vector<double> knots_u;
  std::vector<double> knots_v;
  /// u fastest.
  std::vector<double> weights;
  geometry::Points<3> points;
  /// The part of the domain that is meant; all of it if empty or outside.
  geometry::Interval range_u;
  geometry::Interval range_v;
};

/// 128: knots, weights and points as written unless the ranges are a part of the domain.
ParametrisedSurface b_spline_surface(const BSplineSurfaceData& data, Remark& remark);

/// 114: patch (i, j), at [i + j * count_u], is sum_{k, l} column(k + 4 l) s^k t^l with s, t from its first breakpoints.
/// The degrees are those of the highest coefficients that are not 0. Throws if neighbours do not meet.
ParametrisedSurface parametric_spline_surface(std::span<const double> breakpoints_u,
                                              std::span<const double> breakpoints_v,
                                              std::span<const Eigen::Matrix<double, 3, 16>> coefficients);

/// 140: base(u, v) + distance N(u, v), N the unit normal S_u x S_v, fitted to the tolerance. At a pole N is its limit.
/// Throws if the base surface has an edge inside, where its offset would be in pieces, or no normal.
ParametrisedSurface offset_surface(const ParametrisedSurface& base, double distance, double tolerance);

}  // namespace isorim::io::iges
