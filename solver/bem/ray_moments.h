#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "quadrature/target_rules.h"
#include "solver/bem/domain_load.h"

/// Moments of functions along the rays x + t d from a target to nodes on the boundary, t in [0, 1]: what the radial
/// integration method leaves to be integrated.
namespace isorim::solver {

enum class RayMoment {
  /// int f dt
  plain,
  /// int f t dt
  linear,
  /// int f t (-ln t) dt
  logarithmic,
  /// int (f - f(x)) dt
  difference,
  /// int (f - f(x)) / t dt
  quotient,
};

/// Some functions (components), for one thread.
template <int Dim>
class RayFunctions {
 public:
  virtual ~RayFunctions() = default;
  virtual int components() const = 0;
  virtual Eigen::VectorXd at(const geometry::Point<Dim>& point) = 0;
  /// moments[m]: components x nodes, of the kind kinds[m].
  virtual void moments(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                       std::span<const RayMoment> kinds, std::span<Eigen::MatrixXd> moments) = 0;
};

/// In closed form.
template <int Dim>
std::unique_ptr<RayFunctions<Dim>> quadratic_rays(std::vector<Quadratic<Dim>> components);

/// What rules a function needs along rays.
struct RayResolution {
  /// Largest absolute value seen, of all components.
  double scale = 0.0;
  /// Points of the rule that each ray, or each panel of one, begins with: one of ray_orders.
  int order = 6;
  /// Rays are cut into panels of about this length, which the rule of most points sees peaks on, or resolves.
  double panel_length = std::numeric_limits<double>::infinity();
};

/// Samples the functions along chords of the domain, climbs to the place where they are largest, and refines rules on
/// chords through it until they resolve the functions to the tolerance. Values that are not finite are passed over:
/// the chord may leave the domain where no ray does.
template <int Dim>
RayResolution resolve_along_chords(std::span<const quadrature::IntegrandFactory<Dim>> components,
                                   const geometry::ElementTable<Dim>& table, double tolerance);

/// By Gauss-Legendre rules on panels, which are bisected until the last Legendre coefficients of every component fall
/// below the tolerance times the scale, over the panel's length. With the same points t ln t is integrated by weights
/// that are exact for polynomials. NumericalError, naming the point, at a value that is not finite.
template <int Dim>
std::unique_ptr<RayFunctions<Dim>> sampled_rays(std::span<const quadrature::IntegrandFactory<Dim>> components,
                                                const RayResolution& resolution, double tolerance);

}  // namespace isorim::solver
