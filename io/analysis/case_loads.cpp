#include "io/analysis/case_loads.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/case/analysis_checks.h"
#include "io/case/curve_builder.h"

namespace isorim::io {
namespace {

template <int Dim>
solver::Quadratic<Dim> constant(double value) {
  solver::Quadratic<Dim> polynomial;
  polynomial.constant = value;
  return polynomial;
}

/// Of moments along rays.
constexpr double load_tolerance = 1e-12;

double density_of(const CaseKeys& keys) {
  return keys.material && keys.material->density ? *keys.material->density : *keys.properties.density;
}

/// A source or force from one expression a component; a missing one is zero.
template <class Kernel>
std::shared_ptr<const solver::DomainLoad<Kernel::dimension>> load_of(
    const Kernel& kernel, const std::vector<std::optional<ExpressionText>>& texts, const CaseFile& file,
    const geometry::ElementTable<Kernel::dimension>& table, const std::string& key) {
  constexpr int dim = Kernel::dimension;
  std::vector<solver::Quadratic<dim>> constants;
  std::vector<quadrature::IntegrandFactory<dim>> functions;
  for (const std::optional<ExpressionText>& text : texts) {
    const std::string expression = text ? text->text : "0";
    if (const auto value = constant_value(expression, dim, file.definitions)) {
      constants.push_back(constant<dim>(*value));
    }
    functions.push_back(compile_integrand<dim>(expression, ExpressionScope::domain, file.definitions));
  }
  if (constants.size() == texts.size()) return solver::polynomial_load(kernel, std::move(constants));
  return solver::expression_load(kernel, std::move(functions), table, load_tolerance, key);
}

template <int Dim>
std::shared_ptr<const solver::DomainLoad<Dim>> rotation_load(const solver::Elasticity<Dim>& kernel,
                                                             const CentrifugalKeys& keys, double density) {
  solver::Rotation rotation;
  for (std::size_t i = 0; i < keys.point.values.size(); ++i) {
    rotation.point[static_cast<Eigen::Index>(i)] = keys.point.values[i];
  }
  rotation.direction = keys.direction.value_or(Eigen::Vector3d::UnitZ());
  rotation.angular_speed = keys.speed;
  rotation.density = density;
  return solver::centrifugal_load(kernel, rotation);
}

/// Stress per degree of a body that cannot expand.
template <int Dim>
double thermal_stress(const CaseKeys& keys) {
  const double young = *keys.material->young;
  const double poisson = *keys.material->poisson;
  const double expansion = *keys.material->expansion;
  const bool plane_stress = keys.analysis->state == PlaneState::stress;
  return plane_stress ? young * expansion / (1.0 - poisson) : young * expansion / (1.0 - 2.0 * poisson);
}

template <int Dim>
std::shared_ptr<const solver::DomainLoad<Dim>> temperature_load(const solver::Elasticity<Dim>& kernel,
                                                                const CaseFile& file,
                                                                const geometry::ElementTable<Dim>& table) {
  const std::string& text = file.keys.body_force->temperature->text;
  const double stress = thermal_stress<Dim>(file.keys);
  if (const auto value = constant_value(text, Dim, file.definitions)) {
    return solver::thermal_load(kernel, stress, constant<Dim>(*value));
  }
  return solver::thermal_load(kernel, stress, compile_integrand<Dim>(text, ExpressionScope::domain, file.definitions),
                              table, load_tolerance, "[body_force] temperature");
}

template <int Dim>
solver::Loads<Dim> body_forces(const CaseFile& file, const solver::Elasticity<Dim>& kernel,
                               const geometry::ElementTable<Dim>& table) {
  const BodyForceKeys& keys = *file.keys.body_force;
  solver::Loads<Dim> loads;
  if (keys.gravity) {
    const geometry::Vector<Dim> force = density_of(file.keys) * point_of<Dim>(*keys.gravity);
    std::vector<solver::Quadratic<Dim>> components;
    for (int i = 0; i < Dim; ++i) components.push_back(constant<Dim>(force[i]));
    loads.push_back(solver::polynomial_load(kernel, std::move(components)));
  }
  if (keys.centrifugal) loads.push_back(rotation_load(kernel, *keys.centrifugal, density_of(file.keys)));
  if (keys.force) {
    const auto& axes = keys.force->axes;
    loads.push_back(load_of(kernel, {axes.begin(), axes.begin() + Dim}, file, table, "[body_force] force"));
  }
  if (keys.temperature) loads.push_back(temperature_load(kernel, file, table));
  return loads;
}

}  // namespace

template <int Dim>
solver::Equation<Dim> equation(const CaseKeys& keys, const geometry::ElementTable<Dim>& table) {
  const double length = solver::logarithm_length(table);
  if (keys.analysis->equation != EquationKind::elasticity) {
    solver::Laplace<Dim> laplace;
    laplace.conductivity = keys.material ? keys.material->conductivity.value_or(1.0) : 1.0;
    laplace.length = length;
    return laplace;
  }
  const double poisson = *keys.material->poisson;
  solver::Elasticity<Dim> elasticity;
  elasticity.shear_modulus = *keys.material->young / (2.0 * (1.0 + poisson));
  elasticity.poisson = keys.analysis->state == PlaneState::stress ? poisson / (1.0 + poisson) : poisson;
  elasticity.length = length;
  return elasticity;
}

template <int Dim>
solver::Loads<Dim> case_loads(const CaseFile& file, const solver::Equation<Dim>& equation,
                              const geometry::ElementTable<Dim>& table) {
  if (const auto* laplace = std::get_if<solver::Laplace<Dim>>(&equation)) {
    if (!file.keys.source.term) return {};
    return {load_of(*laplace, {file.keys.source.term->value}, file, table, "[source] value")};
  }
  if (!file.keys.body_force) return {};
  return body_forces(file, std::get<solver::Elasticity<Dim>>(equation), table);
}

template solver::Equation<2> equation(const CaseKeys&, const geometry::ElementTable<2>&);
template solver::Equation<3> equation(const CaseKeys&, const geometry::ElementTable<3>&);
template solver::Loads<2> case_loads(const CaseFile&, const solver::Equation<2>&, const geometry::ElementTable<2>&);
template solver::Loads<3> case_loads(const CaseFile&, const solver::Equation<3>&, const geometry::ElementTable<3>&);

}  // namespace isorim::io
