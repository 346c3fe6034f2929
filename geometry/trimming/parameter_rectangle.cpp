#include "geometry/trimming/parameter_rectangle.h"

#include <algorithm>
#include <cmath>

#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {
namespace {

bool is_point(const NurbsCurve<3>& side, double tolerance) {
  const Points<3> points = side.control_points();
  return ((points.colwise() - points.col(0)).colwise().norm().array() <= tolerance).all();
}

/// The two sides are compared at the same parameters.
bool coincide(const NurbsCurve<3>& first, const NurbsCurve<3>& second, double tolerance) {
  const std::vector<double> breaks = first.knots().breakpoints();
  const int samples = 2 * first.degree() + 1;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    for (int k = 0; k <= samples; ++k) {
      const double t = k == samples ? breaks[i + 1] : breaks[i] + (breaks[i + 1] - breaks[i]) * k / samples;
      if ((evaluate(first, t) - evaluate(second, t)).norm() > tolerance) return false;
    }
  return true;
}

}  // namespace

ParameterRectangle::ParameterRectangle(const NurbsSurface<3>& surface)
    : surface_(&surface), domain_{surface.knots_u().domain(), surface.knots_v().domain()} {
  const Points<3> points = surface.control_points();
  surface_size_ = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
  tolerance_ = TrimmedSurface::parameter_tolerance * lengths();
  const std::array<NurbsCurve<3>, 4> curves = boundary_curves(surface);
  const double near = coincidence * surface_size_;
  for (std::size_t side = 0; side < 4; ++side) {
    pole_points_[side] = curves[side].control_points().rowwise().mean();
    if (is_point(curves[side], near)) sides_[side] = SideKind::pole;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (sides_[side] == SideKind::pole || sides_[side + 2] == SideKind::pole) continue;
    if (coincide(curves[side], curves[side + 2], near)) sides_[side] = sides_[side + 2] = SideKind::seam;
  }
}

bool ParameterRectangle::has_no_open_side() const {
  return std::find(sides_.begin(), sides_.end(), SideKind::open) == sides_.end();
}

Point2 ParameterRectangle::wrap(const Point2& uv) const {
  Point2 wrapped = uv;
  for (int d = 0; d < 2; ++d) {
    if (!is_closed(d) || domain(d).contains(uv[d])) continue;
    const double period = domain(d).length();
    wrapped[d] -= period * std::floor((uv[d] - domain(d).first) / period);
    wrapped[d] = std::clamp(wrapped[d], domain(d).first, domain(d).last);
  }
  return wrapped;
}

Point2 ParameterRectangle::clamp_open(const Point2& uv) const {
  Point2 clamped = uv;
  for (int d = 0; d < 2; ++d)
    if (!is_closed(d)) clamped[d] = std::clamp(uv[d], domain(d).first, domain(d).last);
  return clamped;
}

SideLine side_line(const ParameterRectangle& rectangle, int side) {
  const int parameter = side % 2 == 0 ? 1 : 0;
  const Interval domain = rectangle.domain(parameter);
  return {parameter, side == 0 || side == 3 ? domain.first : domain.last};
}

}  // namespace isorim::geometry
