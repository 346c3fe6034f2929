#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "solver/hydrostatics/floating_body.h"
#include "solver/hydrostatics/hydrostatics.h"
#include "solver/hydrostatics/immersed_body.h"

/// How a body of given weight floats: at a given direction of up, with trim left free, or altogether free.
namespace isorim::solver {

/// What a body weighs and where, in the coordinates of the body.
struct Loading {
  /// The volume that it displaces afloat: its mass over the density of water. Between 0 and that of the body.
  double volume = 0.0;
  geometry::Point3 centre_of_gravity = geometry::Point3::Zero();
};

enum class FlotationStatus {
  /// The residuals are below the tolerance.
  converged,
  /// The body is heavier than what it can displace.
  sinks,
  /// Newton's method did not get there.
  not_converged,
};
std::string_view name_of(FlotationStatus status);

struct FlotationOptions {
  /// Of volumes relative to the loading's, and of lever arms relative to the size of the body.
  double tolerance = 1e-12;
  int max_iterations = 100;
};

/// A body that displaces its loading's volume.
struct FloatingState {
  FlotationStatus status = FlotationStatus::not_converged;
  WaterPlane plane;
  ImmersedBody immersed;
  /// Horizontal parts of B - G, forwards and to port: zero in equilibrium.
  geometry::Vector2 arms = geometry::Vector2::Zero();
  /// The height of G over B along up: the potential energy over the weight.
  double energy = 0.0;
  /// Metacentric heights, per axis of turning: (waterplane's second moments)/V + (B - G).up 1, along forward and port.
  /// The second derivatives of the energy by turns of up towards forward and port.
  Eigen::Matrix2d metacentric_heights = Eigen::Matrix2d::Zero();
  /// Planes at which the body was cut.
  int evaluations = 0;

  /// The smallest metacentric height about any horizontal axis; in equilibrium: it is stable if this is positive.
  double smallest_metacentric_height() const;
  /// GM about the longitudinal axis.
  double transverse_metacentric_height() const { return metacentric_heights(1, 1); }
  /// Positive if it turns the body back from a heel to starboard.
  double righting_arm() const { return 0.0 - arms.y(); }
};

/// The draught at which the body displaces the loading's volume with `up` given: Newton's method with dV/doffset = A_w,
/// kept in a shrinking bracket. The guess may be anything. Throws InputError if the loading's volume is not positive.
FloatingState float_at(const FloatingBody& body, const Loading& loading, const geometry::Vector3& up,
                       const FlotationOptions& options = {}, std::optional<double> guess = {});

/// At a given heel, with the trim such that B is vertically above G seen from the side: Newton's method on the energy
/// as a function of the trim, downhill only, so that the trim found is stable. From the trim given.
FloatingState float_at_heel(const FloatingBody& body, const Loading& loading, double heel, double trim,
                            const FlotationOptions& options = {});

/// A place of rest.
struct Equilibrium {
  FloatingState state;
  bool is_stable = false;
};

/// Where the body comes to rest. The energy, the height of G over B, is a function of the direction of up; its gradient
/// is the horizontal part of G - B and its second derivatives are the metacentric heights, so Newton's method needs
/// nothing but what is known of the waterplane. Steps are those of a trust region (along directions of negative
/// curvature, too), and never uphill.
///
/// The first one is found from `up`; if that happens to be an unstable equilibrium (a ship upright with negative GM) it
/// is given as such, followed by the stable ones on both sides of it (the angles of loll; one if they coincide).
std::vector<Equilibrium> find_equilibria(const FloatingBody& body, const Loading& loading, const geometry::Vector3& up,
                                         const FlotationOptions& options = {});

}  // namespace isorim::solver
