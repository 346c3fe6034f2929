#include "geometry/shapes/sweeps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/curves.h"
#include "geometry/spline/bspline.h"
#include "geometry/spline/interpolation.h"

namespace isorim::geometry {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
/// Knots of [0, 1] nearer than this are the same: i / n computed in two ways.
constexpr double knot_rounding = 1e-14;

void check_revolution(const Axis& axis, double angle) {
  checks::finite("revolve", "axis point", axis.point);
  checks::finite("revolve", "angle", angle);
  if (angle <= 0.0 || angle > two_pi * (1.0 + 1e-14)) {
    throw GeometryError(fmt::format("revolve: angle is {}, it must lie in (0, 2 pi]", angle));
  }
}

struct Knot {
  double value;
  int multiplicity;
};

/// The distinct inner knots of a clamped curve over [0, 1].
std::vector<Knot> inner_knots(const KnotVector& knots) {
  std::vector<Knot> result;
  for (int i = knots.degree() + 1; i < knots.basis_count(); ++i) {
    if (!result.empty() && knots[i] - result.back().value <= knot_rounding) {
      ++result.back().multiplicity;
    } else {
      result.push_back({knots[i], 1});
    }
  }
  return result;
}

/// The union of the inner knots of all curves, each with its largest multiplicity.
template <int Dim>
std::vector<Knot> merged_knots(std::span<const NurbsCurve<Dim>> curves) {
  std::vector<Knot> all;
  for (const NurbsCurve<Dim>& curve : curves) {
    const std::vector<Knot> own = inner_knots(curve.knots());
    all.insert(all.end(), own.begin(), own.end());
  }
  std::ranges::sort(all, {}, &Knot::value);
  std::vector<Knot> merged;
  for (const Knot& knot : all) {
    if (!merged.empty() && knot.value - merged.back().value <= knot_rounding) {
      merged.back().multiplicity = std::max(merged.back().multiplicity, knot.multiplicity);
    } else {
      merged.push_back(knot);
    }
  }
  return merged;
}

/// `curve` with its inner knots moved by rounding onto the values in `target` and the missing ones inserted.
template <int Dim>
NurbsCurve<Dim> on_knots(const NurbsCurve<Dim>& curve, const std::vector<Knot>& target) {
  const int p = curve.degree();
  const std::vector<Knot> own = inner_knots(curve.knots());
  std::vector<double> snapped(static_cast<std::size_t>(p) + 1, 0.0);
  std::vector<double> missing;
  auto next = own.begin();
  for (const Knot& knot : target) {
    int present = 0;
    if (next != own.end() && std::abs(next->value - knot.value) <= knot_rounding) present = (next++)->multiplicity;
    snapped.insert(snapped.end(), static_cast<std::size_t>(present), knot.value);
    missing.insert(missing.end(), static_cast<std::size_t>(knot.multiplicity - present), knot.value);
  }
  snapped.insert(snapped.end(), static_cast<std::size_t>(p) + 1, 1.0);
  return refine_knots(NurbsCurve<Dim>(KnotVector(p, std::move(snapped)), curve.homogeneous()), missing);
}

/// Parameters of the sections: chord lengths, each control point's total scaled to 1, averaged over the control points.
/// If closed, one more for the first section at the end of the period.
std::vector<double> section_parameters(std::span<const NurbsCurve<3>> sections, bool closed) {
  std::vector<Points<3>> points;
  for (const NurbsCurve<3>& section : sections) points.push_back(section.control_points());
  if (closed) points.push_back(points.front());
  const std::size_t count = points.size();
  std::vector<double> steps(count, 0.0);
  for (Eigen::Index i = 0; i < points[0].cols(); ++i) {
    double total = 0.0;
    for (std::size_t k = 1; k < count; ++k) total += (points[k].col(i) - points[k - 1].col(i)).norm();
    if (total == 0.0) continue;
    for (std::size_t k = 1; k < count; ++k) steps[k] += (points[k].col(i) - points[k - 1].col(i)).norm() / total;
  }
  std::vector<double> parameters(count, 0.0);
  for (std::size_t k = 1; k < count; ++k) {
    if (steps[k] == 0.0) {
      throw GeometryError(fmt::format("loft: sections {} and {} coincide", k - 1, k % sections.size()));
    }
    parameters[k] = parameters[k - 1] + steps[k];
  }
  for (double& v : parameters) v /= parameters.back();
  parameters.back() = 1.0;
  return parameters;
}

/// Knots at the parameters: for odd degrees the periodic interpolation there is well posed.
KnotVector periodic_knots(int degree, std::span<const double> parameters) {
  const std::size_t sections = parameters.size() - 1;
  if (degree % 2 == 0 || static_cast<std::size_t>(degree) > sections) {
    throw GeometryError(fmt::format(
        "loft: degree is {}; closed lofts need an odd one, at most the number of sections, {}", degree, sections));
  }
  return KnotVector::periodic(degree, parameters);
}

/// One curve a column of the net, stacked as the surface stores them.
NurbsSurface<3> surface_of_rows(const KnotVector& along, const KnotVector& across, const Eigen::MatrixXd& rows) {
  // rows: (count across) x (4 * count along); a row, read in order, is one row of the net.
  const Eigen::Index width = along.basis_count();
  HomogeneousPoints<3> net(4, width * rows.rows());
  for (Eigen::Index j = 0; j < rows.rows(); ++j) {
    const Eigen::VectorXd row = rows.row(j).transpose();
    net.middleCols(j * width, width) = Eigen::Map<const HomogeneousPoints<3>>(row.data(), 4, width);
  }
  return {along, across, std::move(net)};
}

}  // namespace

NurbsSurface<3> revolve(const NurbsCurve<3>& curve, const Axis& axis, double angle) {
  check_revolution(axis, angle);
  const Vector3 k = checks::unit<3>("revolve", "axis direction", axis.direction);
  const NurbsCurve<2> arc = unit_arc(0.0, std::min(angle, two_pi));
  const HomogeneousPoints<2>& turn = arc.homogeneous();
  const Points<3> points = curve.control_points();
  const double scale = (points.colwise() - axis.point).cwiseAbs().maxCoeff() + axis.point.cwiseAbs().maxCoeff();
  const double on_axis = 8.0 * std::numeric_limits<double>::epsilon() * scale;

  HomogeneousPoints<3> net(4, turn.cols() * points.cols());
  bool whole_on_axis = true;
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    const Point3 point = points.col(j);
    const Point3 foot = axis.point + k * k.dot(point - axis.point);
    Vector3 radial = point - foot;
    if (radial.norm() <= on_axis) radial.setZero();
    whole_on_axis = whole_on_axis && radial.isZero(0.0);
    const Vector3 sideways = k.cross(radial);
    const double weight = curve.homogeneous()(3, j);
    for (Eigen::Index i = 0; i < turn.cols(); ++i) {
      const Vector3 place = turn(2, i) * foot + turn(0, i) * radial + turn(1, i) * sideways;
      net.col(i + j * turn.cols()) << weight * place, weight * turn(2, i);
    }
  }
  if (whole_on_axis) throw GeometryError("revolve: the whole curve lies on the axis");
  return {arc.knots(), curve.knots(), std::move(net)};
}

NurbsSurface<3> extrude(const NurbsCurve<3>& curve, const Vector3& by) {
  checks::unit<3>("extrude", "vector", by);
  AffineMap<3> shift;
  shift.translation = by;
  const Eigen::Index count = curve.homogeneous().cols();
  HomogeneousPoints<3> net(4, 2 * count);
  net << curve.homogeneous(), transform(curve, shift).homogeneous();
  return {curve.knots(), KnotVector::bezier(1), std::move(net)};
}

template <int Dim>
NurbsSurface<Dim> fan(const NurbsCurve<Dim>& rim, const Point<Dim>& apex) {
  checks::finite("fan", "apex", apex);
  const HomogeneousPoints<Dim>& outer = rim.homogeneous();
  HomogeneousPoints<Dim> net(Dim + 1, 2 * outer.cols());
  for (Eigen::Index j = 0; j < outer.cols(); ++j) {
    net.col(2 * j) << outer(Dim, j) * apex, outer(Dim, j);
    net.col(2 * j + 1) = outer.col(j);
  }
  return {KnotVector::bezier(1), rim.knots(), std::move(net)};
}

template <int Dim>
std::vector<NurbsCurve<Dim>> make_compatible(std::span<const NurbsCurve<Dim>> curves) {
  int degree = 1;
  for (const NurbsCurve<Dim>& curve : curves) degree = std::max(degree, curve.degree());
  std::vector<NurbsCurve<Dim>> result;
  for (const NurbsCurve<Dim>& curve : curves) {
    const NurbsCurve<Dim> raised = curve.degree() < degree ? elevate_degree(curve, degree - curve.degree()) : curve;
    result.push_back(reparametrise(clamp(raised), Interval{0.0, 1.0}));
  }
  const std::vector<Knot> merged = merged_knots<Dim>(result);
  for (NurbsCurve<Dim>& curve : result) curve = on_knots(curve, merged);
  return result;
}

NurbsSurface<3> ruled(const NurbsCurve<3>& first, const NurbsCurve<3>& second) {
  const std::vector<NurbsCurve<3>> sides = make_compatible<3>(std::vector{first, second});
  const Eigen::Index count = sides[0].homogeneous().cols();
  HomogeneousPoints<3> net(4, 2 * count);
  net << sides[0].homogeneous(), sides[1].homogeneous();
  return {sides[0].knots(), KnotVector::bezier(1), std::move(net)};
}

NurbsSurface<3> loft(std::span<const NurbsCurve<3>> sections, const LoftOptions& options) {
  if (sections.size() < 2) {
    throw GeometryError(fmt::format("loft: {} section(s), at least 2 are needed", sections.size()));
  }
  if (options.degree < 1) throw GeometryError(fmt::format("loft: degree is {}, it must be positive", options.degree));
  const std::vector<NurbsCurve<3>> lines = make_compatible(sections);
  const std::vector<double> parameters = section_parameters(lines, options.closed);
  const KnotVector across =
      options.closed ? periodic_knots(options.degree, parameters)
                     : averaged_knots(std::min(options.degree, static_cast<int>(sections.size()) - 1), parameters);

  const auto count = static_cast<Eigen::Index>(lines.size());
  const Eigen::Index width = lines[0].homogeneous().size();
  Eigen::MatrixXd rows(count, width);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::VectorXd>(lines[k].homogeneous().data(), width).transpose();
  }
  Eigen::MatrixXd matrix = collocation_matrix(across, std::span(parameters).first(lines.size()));
  // The last functions of a periodic spline are its first ones.
  const Eigen::Index repeated = matrix.cols() - count;
  for (Eigen::Index j = 0; j < repeated; ++j) matrix.col(j) += matrix.col(count + j);
  Eigen::MatrixXd net(count + repeated, width);
  net.topRows(count) = matrix.leftCols(count).partialPivLu().solve(rows);
  net.bottomRows(repeated) = net.topRows(repeated).eval();
  try {
    const NurbsSurface<3> surface = surface_of_rows(lines[0].knots(), across, net);
    return options.closed ? clamp(surface) : surface;
  } catch (GeometryError& error) {
    error.add_context("loft: interpolation through sections with different weights");
    throw;
  }
}

template NurbsSurface<2> fan<2>(const NurbsCurve<2>&, const Point<2>&);
template NurbsSurface<3> fan<3>(const NurbsCurve<3>&, const Point<3>&);
template std::vector<NurbsCurve<2>> make_compatible<2>(std::span<const NurbsCurve<2>>);
template std::vector<NurbsCurve<3>> make_compatible<3>(std::span<const NurbsCurve<3>>);

}  // namespace isorim::geometry
