#include "solver/hydrostatics/flotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::solver {
namespace {

using geometry::Vector2;
using geometry::Vector3;

/// Turns below this, in radians, are rounding.
constexpr double smallest_turn = 1e-13;

struct Wet {
  ImmersedBody immersed;
  WaterPlane plane;
};

Wet wet_at(const FloatingBody& body, const Vector3& up, double offset) {
  const WaterPlane plane{up, offset};
  return {immersed_body(body, plane, body.wetted(plane)), plane};
}

FloatingState state_of(const Wet& wet, const Loading& loading) {
  FloatingState state;
  state.plane = wet.plane;
  state.immersed = wet.immersed;
  const WaterAxes& axes = wet.immersed.axes;
  const Vector3 lever = wet.immersed.centre_of_buoyancy - loading.centre_of_gravity;
  state.arms = {lever.dot(axes.forward), lever.dot(axes.port)};
  state.energy = -lever.dot(axes.up);
  state.metacentric_heights =
      wet.immersed.waterplane.second_moments / loading.volume + lever.dot(axes.up) * Eigen::Matrix2d::Identity();
  return state;
}

/// Eigenvalues in increasing order and unit eigenvectors of a symmetric matrix, in closed form.
struct Eigen2 {
  Vector2 values;
  Eigen::Matrix2d vectors;

  explicit Eigen2(const Eigen::Matrix2d& m) {
    const double mean = 0.5 * (m(0, 0) + m(1, 1));
    const double half = 0.5 * (m(0, 0) - m(1, 1));
    const double radius = std::hypot(half, m(0, 1));
    const double angle = 0.5 * std::atan2(m(0, 1), half);
    values = {mean - radius, mean + radius};
    vectors << -std::sin(angle), std::cos(angle), std::cos(angle), std::sin(angle);
  }
};

/// The step s of length at most `radius` that makes g.s + s.H s / 2 least (Moré and Sorensen's, in the eigenvectors).
Vector2 trust_region_step(const Vector2& gradient, const Eigen2& hessian, double radius) {
  const Vector2 g = hessian.vectors.transpose() * gradient;
  const auto step = [&](double shift) {
    return Vector2(-g.x() / (hessian.values.x() + shift), -g.y() / (hessian.values.y() + shift));
  };
  if (hessian.values.x() > 0.0 && step(0.0).norm() <= radius) return hessian.vectors * step(0.0);
  const double least = std::max(0.0, -hessian.values.x());
  double low = least;
  double high = least + g.norm() / radius + std::abs(hessian.values.y());
  for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (step(middle).norm() > radius ? low : high) = middle;
  }
  Vector2 s = step(high);
  // The hard case: no gradient along the direction of least curvature.
  if (!std::isfinite(s.x()) || s.norm() < 0.9 * radius) {
    s.y() = std::isfinite(s.y()) ? s.y() : 0.0;
    s.x() = std::copysign(std::sqrt(std::max(0.0, radius * radius - s.y() * s.y())), -g.x());
  }
  return hessian.vectors * s;
}

/// up turned towards a horizontal direction by its length, along a great circle.
Vector3 turned(const WaterAxes& axes, const Vector2& turn) {
  const double angle = turn.norm();
  if (angle == 0.0) return axes.up;
  const Vector3 towards = (turn.x() * axes.forward + turn.y() * axes.port) / angle;
  return (std::cos(angle) * axes.up + std::sin(angle) * towards).normalized();
}

/// Newton's method on the sphere of directions.
class Rest {
 public:
  Rest(const FloatingBody& body, const Loading& loading, const FlotationOptions& options)
      : body_(body), loading_(loading), options_(options), tolerance_(options.tolerance * body.box().diagonal()) {}

  FloatingState find(const Vector3& up) {
    FloatingState state = float_at(body_, loading_, up, options_);
    int evaluations = state.evaluations;
    double radius = 0.2;
    const bool floats = state.status == FlotationStatus::converged;
    state.status = floats ? FlotationStatus::not_converged : state.status;
    for (int k = 0; floats && k < options_.max_iterations; ++k) {
      if (state.arms.norm() <= tolerance_) {
        state.status = FlotationStatus::converged;
        break;
      }
      // The gradient of the energy is minus the arm.
      const Vector2 turn = trust_region_step(-state.arms, Eigen2(state.metacentric_heights), radius);
      FloatingState next = float_at(body_, loading_, turned(state.immersed.axes, turn), options_, state.plane.offset);
      evaluations += next.evaluations;
      const double rounding = 2.0 * tolerance_;
      const bool is_better = next.energy < state.energy ||
                             (next.energy <= state.energy + rounding && next.arms.norm() < 0.5 * state.arms.norm());
      if (is_better) {
        const double predicted = state.arms.dot(turn) - 0.5 * turn.dot(state.metacentric_heights * turn);
        if (state.energy - next.energy > 0.7 * predicted) radius = std::min(2.0 * radius, 1.0);
        next.status = FlotationStatus::not_converged;
        state = std::move(next);
      } else {
        radius = 0.25 * turn.norm();
        if (radius < smallest_turn) {
          state.status =
              state.arms.norm() <= 1e3 * tolerance_ ? FlotationStatus::converged : FlotationStatus::not_converged;
          break;
        }
      }
    }
    state.evaluations = evaluations;
    return state;
  }

 private:
  const FloatingBody& body_;
  const Loading& loading_;
  FlotationOptions options_;
  double tolerance_;
};

bool is_stable(const FloatingState& state, double size) {
  return state.status == FlotationStatus::converged && state.smallest_metacentric_height() > 1e-12 * size;
}

}  // namespace

std::string_view name_of(FlotationStatus status) {
  switch (status) {
    case FlotationStatus::converged:
      return "converged";
    case FlotationStatus::sinks:
      return "sinks";
    default:
      return "not_converged";
  }
}

double FloatingState::smallest_metacentric_height() const {
  return Eigen2(metacentric_heights).values.x();
}

FloatingState float_at(const FloatingBody& body, const Loading& loading, const Vector3& up,
                       const FlotationOptions& options, std::optional<double> guess) {
  if (!(loading.volume > 0.0))
    throw InputError(fmt::format("found a displacement of {:.9g}; expected one above 0", loading.volume));
  const double middle = up.dot(body.box().middle());
  const double reach = 0.5 * up.cwiseAbs().dot(body.box().upper - body.box().lower);
  double low = middle - reach;
  double high = middle + reach;
  FloatingState state;
  if (loading.volume > body.volume() * (1.0 + options.tolerance)) {
    state = state_of(wet_at(body, up, high), loading);
    state.status = FlotationStatus::sinks;
    return state;
  }
  double offset = std::clamp(guess.value_or(middle), low, high);
  int evaluations = 0;
  for (int k = 0; k < options.max_iterations; ++k) {
    const Wet wet = wet_at(body, up, offset);
    ++evaluations;
    const double missing = loading.volume - wet.immersed.volume.value;
    state = state_of(wet, loading);
    const bool is_narrow = high - low <= 4.0 * std::numeric_limits<double>::epsilon() * (std::abs(middle) + reach);
    if (std::abs(missing) <= options.tolerance * loading.volume || is_narrow) {
      state.status = FlotationStatus::converged;
      break;
    }
    (missing > 0.0 ? low : high) = offset;
    const double next = offset + missing / wet.immersed.waterplane.area.value;
    offset = next > low && next < high ? next : 0.5 * (low + high);
  }
  state.evaluations = evaluations;
  return state;
}

FloatingState float_at_heel(const FloatingBody& body, const Loading& loading, double heel, double trim,
                            const FlotationOptions& options) {
  const double tolerance = options.tolerance * body.box().diagonal();
  const double rounding = 2.0 * tolerance;
  FloatingState state = float_at(body, loading, up_direction(trim, heel), options);
  int evaluations = state.evaluations;
  if (state.status != FlotationStatus::converged) return state;
  double radius = 0.2;
  for (int k = 0; k < options.max_iterations && std::abs(state.arms.x()) > tolerance; ++k) {
    // up turns towards forward with the trim.
    const double slope = -state.arms.x();
    const double curvature = state.metacentric_heights(0, 0);
    double turn = curvature > 0.0 ? -slope / curvature : -std::copysign(radius, slope);
    turn = std::clamp(turn, -radius, radius);
    FloatingState next = float_at(body, loading, up_direction(trim + turn, heel), options, state.plane.offset);
    evaluations += next.evaluations;
    const bool is_better = next.energy < state.energy || (next.energy <= state.energy + rounding &&
                                                          std::abs(next.arms.x()) < 0.5 * std::abs(state.arms.x()));
    if (is_better) {
      trim += turn;
      radius = std::min(2.0 * radius, 0.5);
      state = std::move(next);
      continue;
    }
    radius = 0.25 * std::abs(turn);
    if (radius < smallest_turn) break;
  }
  if (std::abs(state.arms.x()) > 1e3 * tolerance) state.status = FlotationStatus::not_converged;
  state.evaluations = evaluations;
  return state;
}

std::vector<Equilibrium> find_equilibria(const FloatingBody& body, const Loading& loading, const Vector3& up,
                                         const FlotationOptions& options) {
  const double size = body.box().diagonal();
  Rest rest(body, loading, options);
  const FloatingState first = rest.find(up.normalized());
  std::vector<Equilibrium> result{{first, is_stable(first, size)}};
  const Eigen2 curvature(first.metacentric_heights);
  const bool is_saddle = first.status == FlotationStatus::converged && curvature.values.x() < -1e-9 * size;
  if (!is_saddle) return result;
  for (const double side : {1.0, -1.0}) {
    constexpr double push = 0.02;
    const Vector2 turn = side * push * curvature.vectors.col(0);
    const FloatingState beside = rest.find(turned(first.immersed.axes, turn));
    const bool is_known = std::any_of(result.begin(), result.end(), [&](const Equilibrium& known) {
      return (known.state.plane.up - beside.plane.up).norm() < 1e-6;
    });
    if (!is_known) result.push_back({beside, is_stable(beside, size)});
  }
  return result;
}

}  // namespace isorim::solver
