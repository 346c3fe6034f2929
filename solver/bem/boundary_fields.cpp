#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/bezier/element_jet.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/field_densities.h"
#include "solver/bem/simple_solution.h"

namespace isorim::solver {

template <int Dim>
struct BoundaryFields<Dim>::State {
  State(const Problem<Dim>& given, const FieldSpace<Dim>& in, const Solution<Dim>& solution)
      : problem(given), space(in), densities(given, in, solution) {
    for (const auto& load : given.loads) {
      if (load->is_thermal()) temperatures.push_back(load->integrand());
    }
  }

  BoundaryValue<Dim> regular(int element, const geometry::Point<Dim - 1>& place, const geometry::ElementJet<Dim>& jet) {
    BoundaryValue<Dim> result{jet.position, jet.normal(), {}, {}};
    Densities here;
    densities.at_place(element, place, result.position, result.normal, here);
    result.field.value = here.potential.row(0).transpose();
    result.flux = here.flux.row(0).transpose();
    double uniform_stress = 0.0;
    for (const auto& temperature : temperatures) uniform_stress += temperature->uniform_stress(result.position);
    result.field.gradient =
        boundary_gradient<Dim>(problem.equation, jet.tangents, result.normal,
                               densities.potential_derivatives(element, place), result.flux, uniform_stress);
    set_stress(problem, uniform_stress, result.field);
    return result;
  }

  const Problem<Dim>& problem;
  const FieldSpace<Dim>& space;
  FieldDensities<Dim> densities;
  std::vector<std::unique_ptr<LoadIntegrand<Dim>>> temperatures;
};

template <int Dim>
BoundaryFields<Dim>::BoundaryFields(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const Solution<Dim>& solution)
    : state_(std::make_unique<State>(problem, space, solution)) {}

template <int Dim>
BoundaryFields<Dim>::~BoundaryFields() = default;

namespace {

/// The tangents span no area to speak of, relative to the cell's size.
template <int Dim>
bool is_degenerate(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element,
                   const geometry::ElementJet<Dim>& jet) {
  constexpr double least = 1e-4;
  const geometry::Point<Dim - 1> middle = geometry::Point<Dim - 1>::Constant(0.5);
  return jet.area_vector.norm() < least * geometry::evaluate_jet(table, element, middle).area_vector.norm();
}

}  // namespace

template <int Dim>
BoundaryValue<Dim> BoundaryFields<Dim>::operator()(int element, const geometry::Point<Dim - 1>& place) {
  const geometry::ElementTable<Dim>& table = state_->space.table;
  const geometry::BezierElement<Dim>& bezier = table.elements[static_cast<std::size_t>(element)];
  const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(table, bezier, place);
  if (!is_degenerate(table, bezier, jet)) return state_->regular(element, place, jet);
  // Extrapolated from three places on the way to the middle of the cell.
  constexpr double step = 1e-3;
  constexpr std::array<double, 3> weights{3.0, -3.0, 1.0};
  BoundaryValue<Dim> limit;
  for (int k = 0; k < 3; ++k) {
    const geometry::Point<Dim - 1> beside = place + (k + 1) * step * (geometry::Point<Dim - 1>::Constant(0.5) - place);
    const BoundaryValue<Dim> near = state_->regular(element, beside, geometry::evaluate_jet(table, bezier, beside));
    if (k == 0) limit = {jet.position, geometry::Vector<Dim>::Zero(), {}, {}};
    const double weight = weights[static_cast<std::size_t>(k)];
    const auto add = [&](auto& sum, const auto& value) {
      if (k == 0)
        sum = weight * value;
      else
        sum += weight * value;
    };
    add(limit.normal, near.normal);
    add(limit.flux, near.flux);
    add(limit.field.value, near.field.value);
    add(limit.field.gradient, near.field.gradient);
    add(limit.field.stress, near.field.stress);
    add(limit.field.stress_across, near.field.stress_across);
  }
  limit.normal.normalize();
  return limit;
}

template <int Dim>
BoundaryValue<Dim> evaluate_on_boundary(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                        const Solution<Dim>& solution, int element,
                                        const geometry::Point<Dim - 1>& place) {
  return BoundaryFields<Dim>(problem, space, solution)(element, place);
}

template class BoundaryFields<2>;
template class BoundaryFields<3>;
template BoundaryValue<2> evaluate_on_boundary(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&, int,
                                               const geometry::Point<1>&);
template BoundaryValue<3> evaluate_on_boundary(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&, int,
                                               const geometry::Point<2>&);

}  // namespace isorim::solver
