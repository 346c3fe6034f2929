#include "solver/bem/domain_load.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "solver/bem/ray_moments.h"

namespace isorim::solver {

namespace {

using std::numbers::pi;

/// In the plane U(x, x + t d) = U(x, x + d) + c (-ln t) 1; this is c.
double log_coefficient(const Laplace<2>& kernel) {
  return 1.0 / (2.0 * pi * kernel.conductivity);
}
double log_coefficient(const Elasticity<2>& kernel) {
  return (3.0 - 4.0 * kernel.poisson) / (8.0 * pi * kernel.shear_modulus * (1.0 - kernel.poisson));
}

/// d = y - x, and d . n, for a node.
template <int Dim>
struct Ray {
  geometry::Vector<Dim> d;
  double flux = 0.0;

  Ray(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes, std::size_t node) {
    for (std::size_t i = 0; i < Dim; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      d[row] = nodes.offset[i].empty() ? nodes.position[i][node] - target[row] : nodes.offset[i][node];
      flux += d[row] * nodes.normal[i][node];
    }
  }
};

/// The functions of a load for as many threads as want them.
template <int Dim>
class LoadFunctions {
 public:
  explicit LoadFunctions(std::vector<Quadratic<Dim>> polynomials) : polynomials_(std::move(polynomials)) {}
  LoadFunctions(std::vector<quadrature::IntegrandFactory<Dim>> factories, const geometry::ElementTable<Dim>& table,
                double tolerance, const std::string& name)
      : factories_(std::move(factories)),
        name_(name),
        tolerance_(tolerance),
        resolution_(resolve_along_chords<Dim>(factories_, table, tolerance)) {}

  int components() const { return static_cast<int>(is_closed_form() ? polynomials_.size() : factories_.size()); }
  bool is_closed_form() const { return factories_.empty(); }
  double resolution_length() const { return resolution_.panel_length; }
  const std::vector<RayPeak<Dim>>& peaks() const { return resolution_.peaks; }

  std::unique_ptr<RayFunctions<Dim>> rays() const {
    if (is_closed_form()) return quadratic_rays<Dim>(polynomials_);
    return sampled_rays<Dim>(factories_, name_, resolution_, tolerance_);
  }

  std::vector<quadrature::IntegrandFactory<Dim>> factories() const {
    if (!is_closed_form()) return factories_;
    std::vector<quadrature::IntegrandFactory<Dim>> factories;
    for (const Quadratic<Dim>& polynomial : polynomials_) {
      factories.push_back([polynomial] {
        return [polynomial](const Eigen::Ref<const geometry::Points<Dim>>& points,
                            const Eigen::Ref<const geometry::Points<Dim>>&, std::span<double> values) {
          for (Eigen::Index i = 0; i < points.cols(); ++i)
            values[static_cast<std::size_t>(i)] = polynomial(points.col(i));
        };
      });
    }
    return factories;
  }

 private:
  std::vector<Quadratic<Dim>> polynomials_;
  std::vector<quadrature::IntegrandFactory<Dim>> factories_;
  std::string name_;
  double tolerance_ = 0.0;
  RayResolution<Dim> resolution_;
};

/// A source or force.
template <class Kernel>
class ForceIntegrand : public LoadIntegrand<Kernel::dimension> {
 public:
  static constexpr int dimension = Kernel::dimension;
  static constexpr int components = Kernel::components;

  ForceIntegrand(const Kernel& kernel, std::unique_ptr<RayFunctions<dimension>> rays)
      : kernel_(kernel), rays_(std::move(rays)) {}

  void potential(const geometry::Point<dimension>& target, const quadrature::NodeView<dimension>& nodes,
                 Eigen::Ref<Eigen::MatrixXd> values) override {
    static constexpr std::array<RayMoment, 2> kinds{RayMoment::linear, RayMoment::logarithmic};
    rays_->moments(target, nodes, std::span(kinds).first(dimension == 2 ? 2 : 1), moments_);
    const std::size_t count = nodes.size();
    kernel_values_.resize(components * components * count);
    single_layer(kernel_, target, nodes, std::span<double>(kernel_values_));
    for (std::size_t q = 0; q < count; ++q) {
      const auto column = static_cast<Eigen::Index>(q);
      const Ray<dimension> ray(target, nodes, q);
      for (int i = 0; i < components; ++i) {
        double sum = 0.0;
        for (int j = 0; j < components; ++j) sum += kernel_value(i * components + j, q, count) * moments_[0](j, column);
        if constexpr (dimension == 2) sum += log_coefficient(kernel_) * moments_[1](i, column);
        values(i, column) = cancel(ray, sum);
      }
    }
  }

  void gradient(const geometry::Point<dimension>& target, const quadrature::NodeView<dimension>& nodes,
                Eigen::Ref<Eigen::MatrixXd> values) override {
    static constexpr std::array<RayMoment, 1> kinds{RayMoment::plain};
    rays_->moments(target, nodes, kinds, std::span(moments_).first(1));
    const std::size_t count = nodes.size();
    kernel_values_.resize(dimension * components * components * count);
    single_layer_gradient(kernel_, target, nodes, std::span<double>(kernel_values_));
    for (std::size_t q = 0; q < count; ++q) {
      const auto column = static_cast<Eigen::Index>(q);
      const Ray<dimension> ray(target, nodes, q);
      for (int row = 0; row < dimension * components; ++row) {
        double sum = 0.0;
        for (int j = 0; j < components; ++j)
          sum += kernel_value(row * components + j, q, count) * moments_[0](j, column);
        values(row, column) = cancel(ray, sum);
      }
    }
  }

 private:
  double kernel_value(int entry, std::size_t node, std::size_t count) const {
    return kernel_values_[static_cast<std::size_t>(entry) * count + node];
  }
  /// d . n times the rest; a node at the target has no ray.
  static double cancel(const Ray<dimension>& ray, double rest) {
    return ray.d.squaredNorm() > 0.0 ? ray.flux * rest : 0.0;
  }

  Kernel kernel_;
  std::unique_ptr<RayFunctions<dimension>> rays_;
  std::array<Eigen::MatrixXd, dimension == 2 ? 2 : 1> moments_;
  std::vector<double> kernel_values_;
};

template <class Kernel>
class ForceLoad : public DomainLoad<Kernel::dimension> {
 public:
  static constexpr int dimension = Kernel::dimension;

  ForceLoad(const Kernel& kernel, LoadFunctions<dimension> functions)
      : kernel_(kernel), functions_(std::move(functions)) {}

  int components() const override { return Kernel::components; }
  std::unique_ptr<LoadIntegrand<dimension>> integrand() const override {
    return std::make_unique<ForceIntegrand<Kernel>>(kernel_, functions_.rays());
  }
  std::vector<quadrature::IntegrandFactory<dimension>> density() const override { return functions_.factories(); }
  bool is_closed_form() const override { return functions_.is_closed_form(); }
  double resolution_length() const override { return functions_.resolution_length(); }
  std::vector<RayPeak<dimension>> peaks() const override { return functions_.peaks(); }

 private:
  Kernel kernel_;
  LoadFunctions<dimension> functions_;
};

/// A temperature. With U_ij,j = -A d_i / r^Dim, the derivative by y, and rays,
///
///   beta int U_ij,j (theta - theta(x)) dOmega = -beta A int (d . n) d_i / r^Dim [int_0^1 (theta - theta(x)) dt] dS,
///
/// and likewise for its derivatives by x, of the kernel's alone: those of theta(x) cancel against the uniform rise's.
template <int Dim>
class ThermalIntegrand : public LoadIntegrand<Dim> {
 public:
  ThermalIntegrand(const Elasticity<Dim>& kernel, double stress_per_degree, std::unique_ptr<RayFunctions<Dim>> rays)
      : kernel_(kernel), stress_per_degree_(stress_per_degree), rays_(std::move(rays)) {}

  void potential(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                 Eigen::Ref<Eigen::MatrixXd> values) override {
    const Eigen::MatrixXd& rise = moment(target, nodes, RayMoment::difference);
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      const auto column = static_cast<Eigen::Index>(q);
      const Ray<Dim> ray(target, nodes, q);
      const double factor = -strength() * angle(ray) * rise(0, column);
      values.col(column) = factor * ray.d;
    }
  }

  void gradient(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                Eigen::Ref<Eigen::MatrixXd> values) override {
    const Eigen::MatrixXd& rise = moment(target, nodes, RayMoment::quotient);
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      const auto column = static_cast<Eigen::Index>(q);
      const Ray<Dim> ray(target, nodes, q);
      const double factor = strength() * angle(ray) * rise(0, column);
      const double squared = ray.d.squaredNorm();
      for (int k = 0; k < Dim; ++k) {
        for (int i = 0; i < Dim; ++i) {
          const double direction = squared > 0.0 ? Dim * ray.d[i] * ray.d[k] / squared : 0.0;
          values(k * Dim + i, column) = factor * ((i == k ? 1.0 : 0.0) - direction);
        }
      }
    }
  }

  double uniform_stress(const geometry::Point<Dim>& point) override { return stress_per_degree_ * rays_->at(point)[0]; }

  void uniform_potential(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                         Eigen::Ref<Eigen::MatrixXd> values) override {
    const double stretch = uniform_stress(target) / bulk_stiffness();
    const std::size_t count = nodes.size();
    kernel_values_.resize(Dim * Dim * count);
    double_layer(kernel_, target, nodes, std::span<double>(kernel_values_));
    for (std::size_t q = 0; q < count; ++q) {
      const Ray<Dim> ray(target, nodes, q);
      const bool here = !(ray.d.squaredNorm() > 0.0);
      for (int i = 0; i < Dim; ++i) {
        double sum = 0.0;
        for (int j = 0; j < Dim; ++j)
          sum += here ? 0.0 : kernel_values_[static_cast<std::size_t>(i * Dim + j) * count + q] * ray.d[j];
        values(i, static_cast<Eigen::Index>(q)) = stretch * sum;
      }
    }
  }

 private:
  /// beta A.
  double strength() const {
    const double nu = kernel_.poisson;
    return stress_per_degree_ * (1.0 - 2.0 * nu) / (4.0 * (Dim - 1) * pi * kernel_.shear_modulus * (1.0 - nu));
  }
  /// Stress (each normal component) per equal stretch in all of the Dim directions.
  double bulk_stiffness() const {
    const double nu = kernel_.poisson;
    return 2.0 * kernel_.shear_modulus * (1.0 + (Dim - 2) * nu) / (1.0 - 2.0 * nu);
  }
  /// (d . n) / r^Dim
  static double angle(const Ray<Dim>& ray) {
    const double squared = ray.d.squaredNorm();
    return squared > 0.0 ? ray.flux / (Dim == 2 ? squared : squared * std::sqrt(squared)) : 0.0;
  }

  const Eigen::MatrixXd& moment(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                                RayMoment kind) {
    rays_->moments(target, nodes, std::span(&kind, 1), std::span(&moment_, 1));
    return moment_;
  }

  Elasticity<Dim> kernel_;
  double stress_per_degree_;
  std::unique_ptr<RayFunctions<Dim>> rays_;
  Eigen::MatrixXd moment_;
  std::vector<double> kernel_values_;
};

template <int Dim>
class ThermalLoad : public DomainLoad<Dim> {
 public:
  ThermalLoad(const Elasticity<Dim>& kernel, double stress_per_degree, LoadFunctions<Dim> temperature)
      : kernel_(kernel), stress_per_degree_(stress_per_degree), temperature_(std::move(temperature)) {
    if (!std::isfinite(stress_per_degree))
      throw InputError(
          fmt::format("found a thermal stress of {} per degree; expected a finite number", stress_per_degree));
  }

  int components() const override { return Dim; }
  std::unique_ptr<LoadIntegrand<Dim>> integrand() const override {
    return std::make_unique<ThermalIntegrand<Dim>>(kernel_, stress_per_degree_, temperature_.rays());
  }
  std::vector<quadrature::IntegrandFactory<Dim>> density() const override {
    return LoadFunctions<Dim>(std::vector<Quadratic<Dim>>(Dim)).factories();
  }
  bool is_thermal() const override { return true; }
  bool is_closed_form() const override { return temperature_.is_closed_form(); }
  double resolution_length() const override { return temperature_.resolution_length(); }
  std::vector<RayPeak<Dim>> peaks() const override { return temperature_.peaks(); }

 private:
  Elasticity<Dim> kernel_;
  double stress_per_degree_;
  LoadFunctions<Dim> temperature_;
};

template <int Dim>
void require_finite(const Quadratic<Dim>& polynomial) {
  const double sum = polynomial.constant + polynomial.linear.sum() + polynomial.quadratic.sum();
  if (!std::isfinite(sum)) throw InputError("found a load with a coefficient that is not finite");
}

template <class Kernel, class Component>
void require_count(const std::vector<Component>& components) {
  if (components.size() != Kernel::components)
    throw InputError(fmt::format("found a load of {} components; expected {}", components.size(), Kernel::components));
}

/// The unit axis of a rotation.
geometry::Vector3 unit_axis(const Rotation& rotation, int dimension) {
  const double length = rotation.direction.norm();
  if (!(length > 0.0) || !std::isfinite(length))
    throw InputError(fmt::format("found the axis of rotation ({:.6g}, {:.6g}, {:.6g}); expected a direction",
                                 rotation.direction[0], rotation.direction[1], rotation.direction[2]));
  const geometry::Vector3 axis = rotation.direction / length;
  constexpr double slope = 1e-12;
  if (dimension == 2 && std::abs(axis[2]) > slope && axis.head<2>().norm() > slope)
    throw InputError(
        fmt::format("found the axis of rotation ({:.6g}, {:.6g}, {:.6g}) of a plane body; expected one in "
                    "the plane or normal to it",
                    rotation.direction[0], rotation.direction[1], rotation.direction[2]));
  return axis;
}

}  // namespace

template <class Kernel>
std::shared_ptr<const DomainLoad<Kernel::dimension>> polynomial_load(
    const Kernel& kernel, std::vector<Quadratic<Kernel::dimension>> components) {
  require_count<Kernel>(components);
  for (const auto& component : components) require_finite(component);
  return std::make_shared<ForceLoad<Kernel>>(kernel, LoadFunctions<Kernel::dimension>(std::move(components)));
}

template <int Dim>
std::shared_ptr<const DomainLoad<Dim>> centrifugal_load(const Elasticity<Dim>& kernel, const Rotation& rotation) {
  const geometry::Vector3 axis = unit_axis(rotation, Dim);
  const double strength = rotation.density * rotation.angular_speed * rotation.angular_speed;
  // b = strength (1 - a a^T) (z - p).
  const Eigen::Matrix3d across = strength * (Eigen::Matrix3d::Identity() - axis * axis.transpose());
  const geometry::Vector3 at_origin = -(across * rotation.point);
  std::vector<Quadratic<Dim>> components(Dim);
  for (int i = 0; i < Dim; ++i) {
    components[static_cast<std::size_t>(i)].constant = at_origin[i];
    components[static_cast<std::size_t>(i)].linear = across.row(i).head<Dim>().transpose();
  }
  return polynomial_load(kernel, std::move(components));
}

template <class Kernel>
std::shared_ptr<const DomainLoad<Kernel::dimension>> expression_load(
    const Kernel& kernel, std::vector<quadrature::IntegrandFactory<Kernel::dimension>> components,
    const geometry::ElementTable<Kernel::dimension>& table, double tolerance, const std::string& name) {
  require_count<Kernel>(components);
  return std::make_shared<ForceLoad<Kernel>>(
      kernel, LoadFunctions<Kernel::dimension>(std::move(components), table, tolerance, name));
}

template <int Dim>
std::shared_ptr<const DomainLoad<Dim>> thermal_load(const Elasticity<Dim>& kernel, double stress_per_degree,
                                                    const Quadratic<Dim>& temperature) {
  require_finite(temperature);
  return std::make_shared<ThermalLoad<Dim>>(kernel, stress_per_degree,
                                            LoadFunctions<Dim>(std::vector<Quadratic<Dim>>{temperature}));
}

template <int Dim>
std::shared_ptr<const DomainLoad<Dim>> thermal_load(const Elasticity<Dim>& kernel, double stress_per_degree,
                                                    const quadrature::IntegrandFactory<Dim>& temperature,
                                                    const geometry::ElementTable<Dim>& table, double tolerance,
                                                    const std::string& name) {
  return std::make_shared<ThermalLoad<Dim>>(
      kernel, stress_per_degree,
      LoadFunctions<Dim>(std::vector<quadrature::IntegrandFactory<Dim>>{temperature}, table, tolerance, name));
}

template std::shared_ptr<const DomainLoad<2>> polynomial_load(const Laplace<2>&, std::vector<Quadratic<2>>);
template std::shared_ptr<const DomainLoad<3>> polynomial_load(const Laplace<3>&, std::vector<Quadratic<3>>);
template std::shared_ptr<const DomainLoad<2>> polynomial_load(const Elasticity<2>&, std::vector<Quadratic<2>>);
template std::shared_ptr<const DomainLoad<3>> polynomial_load(const Elasticity<3>&, std::vector<Quadratic<3>>);
template std::shared_ptr<const DomainLoad<2>> centrifugal_load(const Elasticity<2>&, const Rotation&);
template std::shared_ptr<const DomainLoad<3>> centrifugal_load(const Elasticity<3>&, const Rotation&);
template std::shared_ptr<const DomainLoad<2>> expression_load(const Laplace<2>&,
                                                              std::vector<quadrature::IntegrandFactory<2>>,
                                                              const geometry::ElementTable<2>&, double,
                                                              const std::string&);
template std::shared_ptr<const DomainLoad<3>> expression_load(const Laplace<3>&,
                                                              std::vector<quadrature::IntegrandFactory<3>>,
                                                              const geometry::ElementTable<3>&, double,
                                                              const std::string&);
template std::shared_ptr<const DomainLoad<2>> expression_load(const Elasticity<2>&,
                                                              std::vector<quadrature::IntegrandFactory<2>>,
                                                              const geometry::ElementTable<2>&, double,
                                                              const std::string&);
template std::shared_ptr<const DomainLoad<3>> expression_load(const Elasticity<3>&,
                                                              std::vector<quadrature::IntegrandFactory<3>>,
                                                              const geometry::ElementTable<3>&, double,
                                                              const std::string&);
template std::shared_ptr<const DomainLoad<2>> thermal_load(const Elasticity<2>&, double, const Quadratic<2>&);
template std::shared_ptr<const DomainLoad<3>> thermal_load(const Elasticity<3>&, double, const Quadratic<3>&);
template std::shared_ptr<const DomainLoad<2>> thermal_load(const Elasticity<2>&, double,
                                                           const quadrature::IntegrandFactory<2>&,
                                                           const geometry::ElementTable<2>&, double,
                                                           const std::string&);
template std::shared_ptr<const DomainLoad<3>> thermal_load(const Elasticity<3>&, double,
                                                           const quadrature::IntegrandFactory<3>&,
                                                           const geometry::ElementTable<3>&, double,
                                                           const std::string&);

}  // namespace isorim::solver
