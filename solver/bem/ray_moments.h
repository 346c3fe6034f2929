#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
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
template <int Dim>
struct RayResolution {
  /// Largest absolute value seen, of all components; of a singularity a multiple of the largest mean on a chord.
  double scale = 0.0;
  /// Points of the rule that each ray, or each panel of one, begins with: one of ray_orders.
  int order = 6;
  /// Rays are cut into panels of about this length, which the rule of most points sees peaks on, or resolves.
  double panel_length = std::numeric_limits<double>::infinity();
  /// Rays are cut into panels that grow with the distance from these.
  std::vector<RayPeak<Dim>> peaks;
};

/// Samples the functions along chords of the domain, climbs to the place where they are largest, and refines rules on
/// chords through it until they resolve the functions to the tolerance: on whole chords, else on panels that grow with
/// the distance from that place, else on panels of one length. Values that are not finite are passed over: the chord
/// may leave the domain where no ray does.
template <int Dim>
RayResolution<Dim> resolve_along_chords(std::span<const quadrature::IntegrandFactory<Dim>> components,
                                        const geometry::ElementTable<Dim>& table, double tolerance);

/// Appends the places 0 < t < 1 at which the ray from + t d is to be cut on account of a peak: the nearest to it, and
/// others at distances s, 3 s, 7 s, ... on both sides, s the distance of the ray from the peak or the peak's width.
template <int Dim>
void append_cuts(const geometry::Point<Dim>& from, const geometry::Vector<Dim>& d, const RayPeak<Dim>& peak,
                 std::vector<double>& cuts);

/// By Gauss-Legendre rules on panels, which are bisected until the last Legendre coefficients of every component fall
/// below the tolerance times the scale, over the panel's length, or times the largest value on the panel. With the same
/// points t ln t is integrated by weights that are exact for polynomials. InputError, with the name and the point, at a
/// value that is not finite.
template <int Dim>
std::unique_ptr<RayFunctions<Dim>> sampled_rays(std::span<const quadrature::IntegrandFactory<Dim>> components,
                                                const std::string& name, const RayResolution<Dim>& resolution,
                                                double tolerance);

}  // namespace isorim::solver
