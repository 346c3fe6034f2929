#include "geometry/propeller/blade_edit.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

std::string name_of(const BladeEdit& edit) {
  return fmt::format("blade edit, section {}, control point {}", edit.section + 1, edit.point + 1);
}

void check(const NurbsCurve<3>& curve, const BladeEdit& edit) {
  const int last = curve.knots().basis_count() - 1;
  if (edit.point <= 0 || edit.point >= last) {
    throw GeometryError(fmt::format("{}: expected one from 2 to {}; the first and the last are the trailing edge",
                                    name_of(edit), last));
  }
  if (!std::isfinite(edit.by)) throw GeometryError(fmt::format("{}: to move by {}", name_of(edit), edit.by));
}

Point3 moved_on_cylinder(const Point3& point, const BladeEdit& edit) {
  const double radius = std::hypot(point.y(), point.z());
  const double y = point.y() + edit.by;
  if (!(std::abs(y) <= radius)) {
    throw GeometryError(fmt::format("{}: Y = {:.6g} lies off its cylinder of radius {:.6g}", name_of(edit), y, radius));
  }
  return {point.x(), y, std::copysign(std::sqrt((radius - y) * (radius + y)), point.z())};
}

/// Jumps of the p-th derivatives of the basis functions at an inner knot, one a function.
Eigen::VectorXd derivative_jumps(const KnotVector& knots, double knot) {
  const int p = knots.degree();
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(knots.basis_count());
  const int after = knots.find_span(knot);
  const Eigen::MatrixXd right = basis_derivatives(knots, after, knot, p);
  const Eigen::MatrixXd left = basis_derivatives(knots, after - 1, knot, p);
  for (int j = 0; j <= p; ++j) {
    jumps[after - p + j] += right(p, j);
    jumps[after - 1 - p + j] -= left(p, j);
  }
  return jumps;
}

Point3 smoothed(const NurbsCurve<3>& curve, const BladeEdit& edit) {
  const KnotVector& knots = curve.knots();
  const int p = knots.degree();
  if (p % 2 == 0)
    throw GeometryError(
        fmt::format("{}: a curve of degree {} has no knot in the middle of a control point's support; "
                    "expected an odd degree",
                    name_of(edit), p));
  const double knot = knots[edit.point + (p + 1) / 2];
  if (knot <= knots.domain().first || knot >= knots.domain().last)
    throw GeometryError(fmt::format("{}: the knot there is an end of the curve; expected one from {} to {}",
                                    name_of(edit), (p + 1) / 2 + 1, knots.basis_count() - (p + 1) / 2));
  if (knots.multiplicity(knot) > 1)
    throw GeometryError(fmt::format("{}: the knot {:.6g} there is a multiple one", name_of(edit), knot));
  const Eigen::VectorXd jumps = derivative_jumps(knots, knot);
  const Points<3> points = curve.control_points();
  const Vector3 others = points * jumps - jumps[edit.point] * points.col(edit.point);
  return -others / jumps[edit.point];
}

}  // namespace

NurbsCurve<3> edited(const NurbsCurve<3>& curve, const BladeEdit& edit) {
  check(curve, edit);
  if (!curve.is_polynomial()) throw GeometryError(fmt::format("{}: the curve is rational", name_of(edit)));
  Points<3> points = curve.control_points();
  const Point3 old = points.col(edit.point);
  switch (edit.kind) {
    case BladeEdit::Kind::move_along_shaft:
      points(0, edit.point) += edit.by;
      break;
    case BladeEdit::Kind::move_on_cylinder:
      points.col(edit.point) = moved_on_cylinder(old, edit);
      break;
    case BladeEdit::Kind::smooth_at_knot:
      points.col(edit.point) = smoothed(curve, edit);
      break;
  }
  return NurbsCurve<3>::from_points(curve.knots(), points);
}

void apply_edits(std::span<const BladeEdit> edits, std::vector<NurbsCurve<3>>& sections) {
  for (const BladeEdit& edit : edits) {
    if (edit.section >= sections.size())
      throw GeometryError(fmt::format("{}: there are {} sections", name_of(edit), sections.size()));
    sections[edit.section] = edited(sections[edit.section], edit);
  }
}

}  // namespace isorim::geometry
