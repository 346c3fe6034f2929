#pragma once

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/estimate.h"
#include "solver/hydrostatics/floating_body.h"

/// What lies under a water plane: volume, centre of buoyancy, waterplane. In the coordinates of the body.
namespace isorim::solver {

/// Directions that belong to a water plane, orthonormal: forward x port = up.
struct WaterAxes {
  geometry::Vector3 forward;
  geometry::Vector3 port;
  geometry::Vector3 up;
};

/// Forward is the horizontal projection of the body's x axis; where that is vertical, the limit for a body that is
/// trimmed without heel. `up` is of unit length.
WaterAxes water_axes(const geometry::Vector3& up);

/// The waterplane, by its own axes.
struct WaterplaneProperties {
  quadrature::Estimate area;
  /// In the water plane; the point of the plane nearest to the body's middle if there is no area.
  geometry::Point3 centroid;
  /// Along forward and port.
  geometry::Vector2 centroid_error = geometry::Vector2::Zero();
  /// About the centroid: int xi^2, int xi eta, int eta^2, xi forwards, eta to port.
  Eigen::Matrix2d second_moments = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d second_moments_error = Eigen::Matrix2d::Zero();
};

struct ImmersedBody {
  WaterAxes axes;
  quadrature::Estimate volume;
  /// The centre of the volume; the point of the plane nearest to the body's middle if there is no volume.
  geometry::Point3 centre_of_buoyancy;
  geometry::Vector3 centre_error = geometry::Vector3::Zero();
  WaterplaneProperties waterplane;
  /// |the horizontal part of int n dS| over the wetted part, which is zero if the boundary is closed, over the wetted
  /// area: what gaps cost.
  double closure_defect = 0.0;
};

/// From the integrals over the wetted part S alone, by radial integration with the pole p on the water plane, where the
/// plane's own part of the boundary adds nothing:
///
///   3 V = int_S d . n dS,   4 M_i = int_S d_i d . n dS,   d = x - p,
///
/// and, since the immersed body is closed by the waterplane W, for functions f that do not vary along up
/// int_W f dA = - int_S f n . up dS: its area, centroid and second moments with f = 1, xi, xi^2, ...
ImmersedBody immersed_body(const FloatingBody& body, const WaterPlane& plane, const WettedPart& part);

}  // namespace isorim::solver
