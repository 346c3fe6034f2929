#include "solver/hydrostatics/stability.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"

namespace isorim::solver {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Righting {
 public:
  Righting(const FloatingBody& body, const Loading& loading, const RightingOptions& options)
      : body_(body), loading_(loading), options_(options) {}

  FloatingState at(double heel) const {
    if (options_.mode == TrimMode::fixed)
      return float_at(body_, loading_, up_direction(options_.trim, heel), options_.flotation);
    return float_at_heel(body_, loading_, heel, options_.trim, options_.flotation);
  }
  double arm(double heel) const { return at(heel).righting_arm(); }

  /// Between two heels at which the arm has different signs: the Illinois variant of the false position, with
  /// bisections.
  double zero_between(double low, double at_low, double high, double at_high) const {
    int side = 0;
    for (int k = 0; k < 200 && high - low > 1e-13; ++k) {
      double next = (low * at_high - high * at_low) / (at_high - at_low);
      if (!(next > low && next < high) || k % 5 == 4) next = 0.5 * (low + high);
      const double value = arm(next);
      if (value == 0.0) return next;
      const bool is_low = (value > 0.0) == (at_low > 0.0);
      if (is_low) {
        if (side == 1) at_high *= 0.5;
        low = next;
        at_low = value;
      } else {
        if (side == -1) at_low *= 0.5;
        high = next;
        at_high = value;
      }
      side = is_low ? 1 : -1;
    }
    return 0.5 * (low + high);
  }

  /// The heel of the largest arm within a range, by golden section.
  double largest_between(double low, double high) const {
    constexpr double golden = 0.6180339887498949;
    double a = high - golden * (high - low);
    double b = low + golden * (high - low);
    double at_a = arm(a);
    double at_b = arm(b);
    while (high - low > 1e-8) {
      if (at_a > at_b) {
        high = std::exchange(b, a);
        at_b = at_a;
        a = high - golden * (high - low);
        at_a = arm(a);
      } else {
        low = std::exchange(a, b);
        at_a = at_b;
        b = low + golden * (high - low);
        at_b = arm(b);
      }
    }
    return 0.5 * (low + high);
  }

 private:
  const FloatingBody& body_;
  const Loading& loading_;
  const RightingOptions& options_;
};

void check_heels(const std::vector<double>& heels) {
  if (heels.empty()) throw InputError("found no angles of heel; expected one or more");
  for (std::size_t i = 1; i < heels.size(); ++i)
    if (!(heels[i] > heels[i - 1]))
      throw InputError(
          fmt::format("found the angles of heel {:.9g} and {:.9g} rad one after the other; expected rising "
                      "ones",
                      heels[i - 1], heels[i]));
}

/// Arms below this, relative to the size, count as zero at a given heel.
constexpr double zero_arm = 1e-11;

void find_zeros(const Righting& righting, double size, RightingCurve& curve) {
  const auto is_zero = [&](std::size_t i) { return std::abs(curve.points[i].arm) <= zero_arm * size; };
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const RightingPoint& here = curve.points[i];
    if (is_zero(i)) {
      curve.zeros.push_back({here.heel, here.state.transverse_metacentric_height() > 0.0});
      continue;
    }
    if (i + 1 == curve.points.size() || is_zero(i + 1)) continue;
    const RightingPoint& next = curve.points[i + 1];
    if ((here.arm > 0.0) == (next.arm > 0.0)) continue;
    curve.zeros.push_back({righting.zero_between(here.heel, here.arm, next.heel, next.arm), here.arm < 0.0});
  }
}

void find_largest(const Righting& righting, RightingCurve& curve) {
  const auto largest = std::max_element(curve.points.begin(), curve.points.end(),
                                        [](const auto& a, const auto& b) { return a.arm < b.arm; });
  curve.largest_arm = largest->arm;
  curve.heel_of_largest_arm = largest->heel;
  const auto i = largest - curve.points.begin();
  if (curve.points.size() < 3) return;
  const auto last = static_cast<std::ptrdiff_t>(curve.points.size()) - 1;
  const auto heel = [&](std::ptrdiff_t k) {
    return curve.points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last))].heel;
  };
  const double found = righting.largest_between(heel(i - 1), heel(i + 1));
  const double arm = righting.arm(found);
  if (arm <= curve.largest_arm) return;
  curve.largest_arm = arm;
  curve.heel_of_largest_arm = found;
}

}  // namespace

RightingCurve righting_curve(const FloatingBody& body, const Loading& loading, const std::vector<double>& heels,
                             const RightingOptions& options) {
  check_heels(heels);
  const Righting righting(body, loading, options);
  RightingCurve curve;
  curve.points.resize(heels.size());
  quadrature::parallel_for(
      heels.size(), options.threads,
      [&](std::size_t i, int /*thread*/) {
        curve.points[i].heel = heels[i];
        curve.points[i].state = righting.at(heels[i]);
        curve.points[i].arm = curve.points[i].state.righting_arm();
      },
      options.progress);
  const double first = curve.points.front().state.energy;
  for (RightingPoint& point : curve.points) point.area = point.state.energy - first;
  find_zeros(righting, body.box().diagonal(), curve);
  find_largest(righting, curve);
  for (const RightingZero& zero : curve.zeros) {
    if (zero.is_stable || zero.heel <= curve.heel_of_largest_arm || curve.largest_arm <= 0.0) continue;
    curve.vanishing_heel = zero.heel;
    break;
  }
  return curve;
}

CrossCurves cross_curves(const FloatingBody& body, const ShipFrame& frame, const std::vector<double>& volumes,
                         const std::vector<double>& heels, const RightingOptions& options) {
  CrossCurves result{volumes, heels, {}};
  const std::size_t columns = heels.size();
  result.arms.resize(static_cast<Eigen::Index>(volumes.size()), static_cast<Eigen::Index>(columns));
  const geometry::Point3 keel(frame.origin.x(), frame.origin.y(), frame.baseline);
  quadrature::parallel_for(
      volumes.size() * columns, options.threads,
      [&](std::size_t task, int /*thread*/) {
        const Loading loading{volumes[task / columns], keel};
        const FloatingState state =
            float_at(body, loading, up_direction(options.trim, heels[task % columns]), options.flotation);
        result.arms(static_cast<Eigen::Index>(task / columns), static_cast<Eigen::Index>(task % columns)) =
            state.status == FlotationStatus::converged ? state.righting_arm() : nan;
      },
      options.progress);
  return result;
}

BonjeanCurves bonjean_curves(const geometry::PlaneCutter& cutter, const ShipFrame& frame,
                             const std::vector<double>& stations, const std::vector<double>& draughts, int threads) {
  BonjeanCurves result{stations, draughts, {}, {}, {}};
  const auto rows = static_cast<Eigen::Index>(stations.size());
  const auto columns = static_cast<Eigen::Index>(draughts.size());
  result.areas = result.errors = Eigen::MatrixXd::Zero(rows, columns);
  result.heights = Eigen::MatrixXd::Constant(rows, columns, nan);
  quadrature::parallel_for(stations.size(), threads, [&](std::size_t i, int /*thread*/) {
    const auto row = static_cast<Eigen::Index>(i);
    const StationSection section = station_section(cutter, stations[i]);
    for (Eigen::Index k = 0; k < columns; ++k) {
      const double draught = draughts[static_cast<std::size_t>(k)];
      const ImmersedSection wet = immersed_section(section, water_plane(frame, {draught, 0.0, 0.0}));
      result.areas(row, k) = wet.area.value;
      result.errors(row, k) = wet.area.error;
      if (wet.centroid) result.heights(row, k) = wet.centroid->y() - frame.baseline;
    }
  });
  return result;
}

}  // namespace isorim::solver
