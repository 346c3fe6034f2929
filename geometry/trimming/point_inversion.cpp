#include "geometry/trimming/point_inversion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace isorim::geometry {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Parameters about which the nearest point of a grid is near enough for Newton's method.
std::vector<double> grid_parameters(const KnotVector& knots) {
  constexpr std::size_t most_spans = 24;
  const std::vector<double> breaks = knots.breakpoints();
  const std::size_t spans = breaks.size() - 1;
  const std::size_t stride = (spans + most_spans - 1) / most_spans;
  const int parts = knots.degree() == 1 && spans > 1 ? 1 : (spans > 4 ? 2 : 4);
  std::vector<double> parameters;
  for (std::size_t i = 0; i < spans; i += stride) {
    const double last = breaks[std::min(i + stride, spans)];
    for (int k = 0; k < parts; ++k) parameters.push_back(breaks[i] + (last - breaks[i]) * (k + 0.5) / parts);
  }
  return parameters;
}

struct Descent {
  Vector2 change = Vector2::Zero();
  /// Newton's own step, which may be trusted when it is small.
  bool is_newton = false;
};

/// Half the squared distance: gradient and Hessian, and the step that leads down.
Descent descent(const SurfaceJet<3>& jet, const Vector3& offset, const std::array<bool, 2>& is_fixed_up,
                const std::array<bool, 2>& is_fixed_down) {
  const Vector2 gradient(offset.dot(jet.du), offset.dot(jet.dv));
  Eigen::Matrix2d metric;
  metric << jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.du.dot(jet.dv), jet.dv.dot(jet.dv);
  Eigen::Matrix2d hessian = metric;
  hessian(0, 0) += offset.dot(jet.duu);
  hessian(0, 1) += offset.dot(jet.duv);
  hessian(1, 0) = hessian(0, 1);
  hessian(1, 1) += offset.dot(jet.dvv);
  std::array<bool, 2> is_free{};
  for (int d = 0; d < 2; ++d) {
    const std::size_t i = static_cast<std::size_t>(d);
    is_free[i] =
        metric(d, d) > 0.0 && !(is_fixed_up[i] && gradient[d] < 0.0) && !(is_fixed_down[i] && gradient[d] > 0.0);
  }
  Descent step;
  if (is_free[0] && is_free[1]) {
    for (const Eigen::Matrix2d* matrix : {&hessian, &metric}) {
      const Eigen::Matrix2d& m = *matrix;
      const double determinant = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1);
      if (!(m(0, 0) > 0.0 && determinant > 1e-13 * metric(0, 0) * metric(1, 1))) continue;
      step.change << m(0, 1) * gradient[1] - m(1, 1) * gradient[0], m(0, 1) * gradient[0] - m(0, 0) * gradient[1];
      step.change /= determinant;
      step.is_newton = matrix == &hessian;
      return step;
    }
  }
  for (int d = 0; d < 2; ++d) {
    if (!is_free[static_cast<std::size_t>(d)]) continue;
    const bool is_convex = hessian(d, d) > 1e-13 * metric(d, d);
    step.change[d] = -gradient[d] / (is_convex ? hessian(d, d) : metric(d, d));
    step.is_newton = step.is_newton || is_convex;
  }
  return step;
}

}  // namespace

PointInverter::PointInverter(const ParameterRectangle& rectangle, double sure)
    : rectangle_(&rectangle), sure_(sure), grid_points_(3, 0) {}

InvertedPoint PointInverter::refine(const Point3& target, const Point2& guess) const {
  constexpr int most_steps = 40;
  const double size = rectangle_->surface_size();
  const Vector2 longest = 0.25 * rectangle_->lengths();
  const double noise = 8.0 * epsilon * (size + target.norm());
  InvertedPoint found{rectangle_->clamp_open(guess), {}, 0.0};
  found.jet = rectangle_->jet(found.uv);
  Vector3 offset = found.jet.point - target;
  for (int k = 0; k < most_steps; ++k) {
    std::array<bool, 2> at_last{};
    std::array<bool, 2> at_first{};
    for (int d = 0; d < 2; ++d) {
      if (rectangle_->is_closed(d)) continue;
      at_first[static_cast<std::size_t>(d)] = found.uv[d] <= rectangle_->domain(d).first;
      at_last[static_cast<std::size_t>(d)] = found.uv[d] >= rectangle_->domain(d).last;
    }
    const Descent step = descent(found.jet, offset, at_last, at_first);
    const Vector2 change = step.change.cwiseMax(-longest).cwiseMin(longest);
    const double moved = (found.jet.du * change[0] + found.jet.dv * change[1]).norm();
    if (moved <= 0.25 * noise) break;
    // Newton's error after a step is about its square.
    const bool is_last = step.is_newton && moved < 3e-9 * size;
    bool is_accepted = false;
    double fraction = 1.0;
    for (int halving = 0; halving < 12 && !is_accepted; ++halving, fraction *= 0.5) {
      const Point2 next = rectangle_->clamp_open(found.uv + fraction * change);
      const SurfaceJet<3> jet = rectangle_->jet(next);
      const Vector3 next_offset = jet.point - target;
      is_accepted = is_last ? next_offset.norm() <= offset.norm() + noise
                            : next_offset.squaredNorm() < offset.squaredNorm() * (1.0 - 4.0 * epsilon);
      if (!is_accepted) continue;
      found.uv = next;
      found.jet = jet;
      offset = next_offset;
    }
    if (!is_accepted || is_last) break;
  }
  found.distance = offset.norm();
  return found;
}

void PointInverter::make_grid() const {
  const std::vector<double> us = grid_parameters(rectangle_->surface().knots_u());
  const std::vector<double> vs = grid_parameters(rectangle_->surface().knots_v());
  grid_points_.resize(3, static_cast<Eigen::Index>(us.size() * vs.size()));
  for (const double v : vs)
    for (const double u : us) {
      grid_.emplace_back(u, v);
      grid_points_.col(static_cast<Eigen::Index>(grid_.size()) - 1) = evaluate(rectangle_->surface(), grid_.back());
    }
}

InvertedPoint PointInverter::locate(const Point3& target) const {
  if (grid_.empty()) make_grid();
  Eigen::Index nearest = 0;
  (grid_points_.colwise() - target).colwise().squaredNorm().minCoeff(&nearest);
  const InvertedPoint quick = refine(target, grid_[static_cast<std::size_t>(nearest)]);
  if (quick.distance <= sure_) return quick;
  const ClosestSurfacePoint<3> closest = closest_point(rectangle_->surface(), target);
  const InvertedPoint careful = refine(target, closest.uv);
  return careful.distance < quick.distance ? careful : quick;
}

}  // namespace isorim::geometry
