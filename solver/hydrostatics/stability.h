#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "solver/hydrostatics/floating_body.h"
#include "solver/hydrostatics/flotation.h"
#include "solver/hydrostatics/hydrostatics.h"

/// Righting arms over the angle of heel.
namespace isorim::solver {

enum class TrimMode {
  /// The trim stays as given.
  fixed,
  /// At each heel the trim is that of longitudinal equilibrium.
  free,
};

struct RightingOptions {
  TrimMode mode = TrimMode::free;
  /// Radians; where the search starts if the trim is free.
  double trim = 0.0;
  FlotationOptions flotation = {};
  /// 0: all that OpenMP offers. The results are the same bits for any number.
  int threads = 0;
  std::function<void(double)> progress = {};
};

struct RightingPoint {
  /// Radians.
  double heel = 0.0;
  /// G Z, positive if it turns the body back from a heel to starboard.
  double arm = 0.0;
  /// Work over weight since the first heel, int GZ cos(trim) dheel: the area under the curve for a body without trim.
  /// Exact: it is how much G has risen over B.
  double area = 0.0;
  FloatingState state;
};

/// The arm is zero.
struct RightingZero {
  double heel = 0.0;
  /// The arm rises with the heel.
  bool is_stable = false;
};

struct RightingCurve {
  std::vector<RightingPoint> points;
  /// In the range of the points, increasing. To 1e-12 radians.
  std::vector<RightingZero> zeros;
  /// The largest arm within the range, and where it is (to 1e-7 radians).
  double largest_arm = 0.0;
  double heel_of_largest_arm = 0.0;
  /// The first zero at which the arm falls, beyond the largest arm; absent if the range ends before it.
  std::optional<double> vanishing_heel;
};

/// At the heels given, increasing, radians. Between them zeros are found where the sign changes, and the largest arm
/// about the largest given one: steps must be small enough not to step over a lobe. Throws InputError without heels, or
/// if they do not rise.
RightingCurve righting_curve(const FloatingBody& body, const Loading& loading, const std::vector<double>& heels,
                             const RightingOptions& options = {});

/// KN: the righting arms for G at the frame's origin on the baseline; GZ = KN - KG sin(heel) - (offset of G to port)
/// cos(heel).
struct CrossCurves {
  std::vector<double> volumes;
  std::vector<double> heels;
  /// volumes x heels. Not a number where the body cannot displace the volume.
  Eigen::MatrixXd arms;
};

/// At a fixed trim.
CrossCurves cross_curves(const FloatingBody& body, const ShipFrame& frame, const std::vector<double>& volumes,
                         const std::vector<double>& heels, const RightingOptions& options = {});

/// Immersed areas of transverse sections.
struct BonjeanCurves {
  std::vector<double> stations;
  std::vector<double> draughts;
  /// stations x draughts.
  Eigen::MatrixXd areas;
  Eigen::MatrixXd errors;
  /// Heights of their centroids over the baseline; not a number without area.
  Eigen::MatrixXd heights;
};

/// Upright, without trim. Throws GeometryError if the boundary cannot be cut at a station.
BonjeanCurves bonjean_curves(const geometry::PlaneCutter& cutter, const ShipFrame& frame,
                             const std::vector<double>& stations, const std::vector<double>& draughts, int threads = 0);

}  // namespace isorim::solver
