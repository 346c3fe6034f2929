#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "quadrature/target_rules.h"
#include "solver/bem/coarse_table.h"
#include "solver/bem/kernels.h"

/// Loads in the domain, brought to the boundary by the radial integration method with the pole at the target x. With
/// d = y - x, y on the boundary, and the ray x + t d,
///
///   int_Omega U(x, z) b(z) dOmega = int_boundary (d . n) [ int_0^1 U(x, x + t d) b(x + t d) t^(Dim - 1) dt ] dS,
///
/// where U(x, x + t d) is U(x, y) / t in space and U(x, y) plus a multiple of ln t in the plane: the fundamental
/// solution's singularity cancels, and what is left along the ray are moments of the load alone (Gao 2002, eqs. 12 and
/// 24; Gao, J. Appl. Mech. 69, 2002, 154-160, for body forces). The same holds for the derivatives by x.
///
/// Rays leave a domain that is not convex, and the load's function has to be defined there. Loads in exterior problems
/// have no such form (rays would have to run to infinity).
namespace isorim::solver {

/// One thread's access to a load. All fill what is to be summed with the nodes' weights.
template <int Dim>
class LoadIntegrand {
 public:
  virtual ~LoadIntegrand() = default;

  /// For int_Omega U(x, z) b(z) dOmega: components x nodes.
  virtual void potential(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                         Eigen::Ref<Eigen::MatrixXd> values) = 0;
  /// For its derivatives by the target's coordinates: (Dim * components) x nodes, row k * components + i.
  virtual void gradient(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                        Eigen::Ref<Eigen::MatrixXd> values) = 0;

  /// Of a temperature theta the two above leave out a uniform rise by theta(x), which is the traction beta theta(x) n
  /// on the boundary and the stress -beta theta(x) 1 in it. This is beta theta(x); 0 for all other loads.
  virtual double uniform_stress(const geometry::Point<Dim>& /*point*/) { return 0.0; }
  /// For what that rise adds to the potential, written with the double layer of the free expansion that it causes: the
  /// sum over nodes is then exactly what the same nodes make of that expansion in the integral equation.
  virtual void uniform_potential(const geometry::Point<Dim>& /*target*/, const quadrature::NodeView<Dim>& /*nodes*/,
                                 Eigen::Ref<Eigen::MatrixXd> values) {
    values.setZero();
  }
};

/// Where functions are singular or much larger than elsewhere.
template <int Dim>
struct RayPeak {
  geometry::Point<Dim> place;
  /// Below this distance from the place the functions are smooth; 0 for a singularity.
  double width = 0.0;
};

template <int Dim>
class DomainLoad {
 public:
  virtual ~DomainLoad() = default;
  /// 1 (a source) or Dim (a force); the rows that LoadIntegrand fills.
  virtual int components() const = 0;
  virtual std::unique_ptr<LoadIntegrand<Dim>> integrand() const = 0;
  /// Source or force per unit of volume, a function for each component, e.g. for quadrature::integrate_over_domain. A
  /// temperature exerts none: its forces in the domain and on the boundary are in balance.
  virtual std::vector<quadrature::IntegrandFactory<Dim>> density() const = 0;
  /// The load loads the body by uniform_stress().
  virtual bool is_thermal() const { return false; }
  /// The moments along the rays are known in closed form and the integrand is smooth.
  virtual bool is_closed_form() const = 0;
  /// Rules of some ten points on parts of the boundary of this length do not miss peaks of its functions; infinite if
  /// there are none.
  virtual double resolution_length() const = 0;
  /// Where its functions are singular or peak sharply, beside that.
  virtual std::vector<RayPeak<Dim>> peaks() const { return {}; }
};

/// c + g . z + z . Q z.
template <int Dim>
struct Quadratic {
  double constant = 0.0;
  geometry::Vector<Dim> linear = geometry::Vector<Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim> quadratic = Eigen::Matrix<double, Dim, Dim>::Zero();

  double operator()(const geometry::Point<Dim>& z) const {
    return constant + linear.dot(z) + z.dot((quadratic * z).eval());
  }
};

/// A source or force (one polynomial a component), in closed form. Kernel: Laplace or Elasticity. Throws InputError for
/// a wrong number of components or one that is not finite.
template <class Kernel>
std::shared_ptr<const DomainLoad<Kernel::dimension>> polynomial_load(
    const Kernel& kernel, std::vector<Quadratic<Kernel::dimension>> components);

/// A body that turns about an axis with constant speed: b = rho omega^2 (distance from the axis), outward.
struct Rotation {
  /// On the axis, and along it (of any length). In the plane z is 0 in both, or the axis is that of z.
  geometry::Point3 point = geometry::Point3::Zero();
  geometry::Vector3 direction = geometry::Vector3::UnitZ();
  /// Radians per unit of time.
  double angular_speed = 0.0;
  /// Mass per unit of volume.
  double density = 0.0;
};
/// In closed form. Throws InputError for an axis without direction, or (Dim = 2) one that neither lies in the plane nor
/// is normal to it.
template <int Dim>
std::shared_ptr<const DomainLoad<Dim>> centrifugal_load(const Elasticity<Dim>& kernel, const Rotation& rotation);

/// A source or force given by functions of the place, integrated along the rays by rules that are refined until they
/// meet the tolerance (relative to the largest mean of the functions along a chord). The table gives the domain, on
/// chords of which the functions are sampled first to find how fine the rules have to be, so that narrow peaks are not
/// missed; a peak narrower than about 1e-3 of the domain may be. One sharp peak, or a logarithm in the plane, costs
/// little more than a smooth function. Throws InputError for a wrong number of components, and (from the integrand) at
/// a value that is not finite, with the `name` of the load and the point.
template <class Kernel>
std::shared_ptr<const DomainLoad<Kernel::dimension>> expression_load(
    const Kernel& kernel, std::vector<quadrature::IntegrandFactory<Kernel::dimension>> components,
    const geometry::ElementTable<Kernel::dimension>& table, double tolerance = 1e-12,
    const std::string& name = "the load");

/// Thermal expansion by a temperature theta above that of the unloaded body. beta is the stress that a restrained body
/// has per degree: E alpha / (1 - 2 nu) in space and plane strain, E alpha / (1 - nu) in plane stress. Instead of a
/// force -beta grad theta and a traction beta theta n (Duhamel) the domain has beta int U_ij,j theta dOmega, which
/// needs no derivatives of theta and leaves the traction the true one.
template <int Dim>
std::shared_ptr<const DomainLoad<Dim>> thermal_load(const Elasticity<Dim>& kernel, double stress_per_degree,
                                                    const Quadratic<Dim>& temperature);
template <int Dim>
std::shared_ptr<const DomainLoad<Dim>> thermal_load(const Elasticity<Dim>& kernel, double stress_per_degree,
                                                    const quadrature::IntegrandFactory<Dim>& temperature,
                                                    const geometry::ElementTable<Dim>& table, double tolerance = 1e-12,
                                                    const std::string& name = "the temperature");

template <int Dim>
using Loads = std::vector<std::shared_ptr<const DomainLoad<Dim>>>;

struct LoadOptions {
  /// Relative to the largest potential among the targets.
  double tolerance = 1e-11;
  int threads = 0;
};

/// int_Omega U(x, z) b(z) dOmega of all loads together at every target (of temperatures everything, the uniform rise
/// too): components x targets. `rules` are those of the caller's other integrals. Where finer ones disagree with them
/// at some of the targets these are used, on parts of the elements if the load has peaks; and adaptive integration if
/// all of them disagree (a load with kinks). If there is a coarse form of the table rays run to its nodes alone.
/// Throws NumericalError as the loads do.
template <int Dim>
Eigen::MatrixXd domain_potentials(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                                  const quadrature::TargetRules<Dim>& rules,
                                  std::span<const quadrature::Target<Dim>> targets, const LoadOptions& options = {},
                                  const CoarseTable<Dim>* coarse = nullptr);

/// Potentials without the uniform rise, and their derivatives, at points inside, for representation formulas.
struct DomainJets {
  /// components x targets.
  Eigen::MatrixXd value;
  /// (Dim * components) x targets, row k * components + i.
  Eigen::MatrixXd gradient;
  /// LoadIntegrand::uniform_stress().
  Eigen::VectorXd uniform_stress;
};
template <int Dim>
DomainJets domain_jets(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                       const quadrature::TargetRules<Dim>& rules, std::span<const quadrature::Target<Dim>> targets,
                       const LoadOptions& options = {}, const CoarseTable<Dim>* coarse = nullptr);

/// int_Omega b dOmega, and for forces int (z - point) x b dOmega (1 entry in the plane, 3 in space, none for sources).
struct LoadResultant {
  Eigen::VectorXd force;
  Eigen::VectorXd moment;
};
template <int Dim>
LoadResultant load_resultant(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                             const geometry::Point<Dim>& point, double tolerance = 1e-12, int threads = 0);

}  // namespace isorim::solver
