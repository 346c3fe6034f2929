#include "io/analysis/boundary_value_problem.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/errors.h"
#include "io/analysis/case_loads.h"
#include "io/case/analysis_checks.h"

namespace isorim::io {
namespace {

template <int Dim>
using Factory = quadrature::IntegrandFactory<Dim>;
template <int Dim>
using Frame = Eigen::Matrix<double, Dim, Dim>;

template <int Dim>
Factory<Dim> compile(const ExpressionText& text, const CaseFile& file) {
  return compile_integrand<Dim>(text.text, ExpressionScope::boundary, file.definitions);
}

/// sum_i coefficient_i(normal) f_i; an empty function is zero, and so is the sum of none.
template <int Dim>
struct Term {
  Factory<Dim> function;
  /// The function is multiplied by direction . 1 (a number), or by this component of the normal.
  double factor = 1.0;
  int normal_component = -1;
};

template <int Dim>
Factory<Dim> sum_of(std::vector<Term<Dim>> terms) {
  std::erase_if(terms, [](const Term<Dim>& term) { return !term.function || term.factor == 0.0; });
  if (terms.empty()) return {};
  if (terms.size() == 1 && terms.front().factor == 1.0 && terms.front().normal_component < 0) {
    return terms.front().function;
  }
  return [terms]() -> quadrature::Integrand<Dim> {
    std::vector<quadrature::Integrand<Dim>> functions;
    for (const Term<Dim>& term : terms) functions.push_back(term.function());
    return [terms, functions, room = std::vector<double>()](const Eigen::Ref<const geometry::Points<Dim>>& points,
                                                            const Eigen::Ref<const geometry::Points<Dim>>& normals,
                                                            std::span<double> values) mutable {
      room.resize(values.size());
      std::fill(values.begin(), values.end(), 0.0);
      for (std::size_t t = 0; t < terms.size(); ++t) {
        functions[t](points, normals, room);
        const int k = terms[t].normal_component;
        for (std::size_t i = 0; i < values.size(); ++i) {
          values[i] += terms[t].factor * (k < 0 ? 1.0 : normals(k, static_cast<Eigen::Index>(i))) * room[i];
        }
      }
    };
  };
}

template <int Dim>
Factory<Dim> axis_function(const std::optional<ComponentTexts>& texts, int axis, const CaseFile& file) {
  if (!texts || !texts->axes[static_cast<std::size_t>(axis)]) return {};
  return compile<Dim>(*texts->axes[static_cast<std::size_t>(axis)], file);
}

/// The component of a vector of expressions along a row of the frame.
template <int Dim>
Factory<Dim> along(const std::optional<ComponentTexts>& texts, const Frame<Dim>& frame, int row, const CaseFile& file) {
  std::vector<Term<Dim>> terms;
  for (int k = 0; k < Dim; ++k) terms.push_back({axis_function<Dim>(texts, k, file), frame(row, k)});
  if (texts && texts->normal && row == 0) terms.push_back({compile<Dim>(*texts->normal, file)});
  return sum_of(std::move(terms));
}

// --- Conditions -------------------------------------------------------------------------------------------------

/// It speaks of the normal direction and the plane across it.
bool needs_frame(const BoundaryConditionKeys& keys) {
  const auto has_normal = [](const std::optional<ComponentTexts>& texts) { return texts && texts->normal; };
  return keys.kind == BoundaryKind::symmetry || (keys.kind == BoundaryKind::displacement && has_normal(keys.value)) ||
         (keys.kind == BoundaryKind::foundation && has_normal(keys.coefficient));
}

template <int Dim>
solver::Condition<Dim> potential_condition(const BoundaryConditionKeys& keys, const CaseFile& file) {
  const auto function = [&](const std::optional<ComponentTexts>& texts) {
    return texts ? compile<Dim>(*texts->single, file) : Factory<Dim>();
  };
  solver::ComponentCondition<Dim> component;
  component.value = function(keys.value);
  if (keys.kind == BoundaryKind::value) component.kind = solver::ConditionKind::value;
  if (keys.kind == BoundaryKind::robin) {
    component.kind = solver::ConditionKind::robin;
    component.value = function(keys.reference);
    component.coefficient = function(keys.coefficient);
  }
  solver::Condition<Dim> condition;
  condition.components.push_back(std::move(component));
  return condition;
}

/// The traction of component `axis`: value, normal value and pressure together.
template <int Dim>
Factory<Dim> traction_function(const BoundaryConditionKeys& keys, int axis, const CaseFile& file) {
  std::vector<Term<Dim>> terms{{axis_function<Dim>(keys.value, axis, file)}};
  if (keys.value && keys.value->normal) terms.push_back({compile<Dim>(*keys.value->normal, file), 1.0, axis});
  if (keys.pressure) terms.push_back({compile<Dim>(*keys.pressure, file), -1.0, axis});
  return sum_of(std::move(terms));
}

/// Of displacement, foundation and symmetry: `frame` holds the components' axes.
template <int Dim>
solver::ComponentCondition<Dim> support_component(const BoundaryConditionKeys& keys, const Frame<Dim>& frame, int row,
                                                  const CaseFile& file) {
  const bool framed = needs_frame(keys);
  solver::ComponentCondition<Dim> component;
  const auto is_given = [&](const std::optional<ComponentTexts>& texts) {
    return framed ? row == 0 : texts->single || texts->axes[static_cast<std::size_t>(row)].has_value();
  };
  if (keys.kind == BoundaryKind::foundation && is_given(keys.coefficient)) {
    component.kind = solver::ConditionKind::robin;
    component.value = along<Dim>(keys.reference, frame, row, file);
    component.coefficient = keys.coefficient->single ? compile<Dim>(*keys.coefficient->single, file)
                                                     : along<Dim>(keys.coefficient, frame, row, file);
  } else if (keys.kind == BoundaryKind::symmetry
                 ? row == 0
                 : keys.kind == BoundaryKind::displacement && (!keys.value || is_given(keys.value))) {
    component.kind = solver::ConditionKind::value;
    component.value = along<Dim>(keys.value, frame, row, file);
  } else {
    component.value = along<Dim>(keys.traction, frame, row, file);
  }
  return component;
}

template <int Dim>
solver::Condition<Dim> elastic_condition(const BoundaryConditionKeys& keys, const std::optional<Frame<Dim>>& frame,
                                         const CaseFile& file) {
  solver::Condition<Dim> condition;
  condition.frame = frame;
  for (int i = 0; i < Dim; ++i) {
    if (keys.kind == BoundaryKind::traction) {
      solver::ComponentCondition<Dim> component;
      component.value = traction_function<Dim>(keys, i, file);
      condition.components.push_back(std::move(component));
    } else {
      condition.components.push_back(support_component<Dim>(keys, frame.value_or(Frame<Dim>::Identity()), i, file));
    }
  }
  return condition;
}

// --- Frames -----------------------------------------------------------------------------------------------------

/// Rows: the normal and unit tangents.
Frame<2> frame_about(const geometry::Vector2& normal) {
  Frame<2> frame;
  frame << normal.x(), normal.y(), -normal.y(), normal.x();
  return frame;
}
Frame<3> frame_about(const geometry::Vector3& normal) {
  const geometry::Vector3 first = normal.unitOrthogonal();
  Frame<3> frame;
  frame.row(0) = normal.transpose();
  frame.row(1) = first.transpose();
  frame.row(2) = normal.cross(first).transpose();
  return frame;
}

/// The middle of an element's cell.
template <int Dim>
geometry::ElementJet<Dim> middle_of(const geometry::ElementTable<Dim>& table,
                                    const geometry::BezierElement<Dim>& element) {
  return geometry::evaluate_jet<Dim>(table, element, geometry::Point<Dim - 1>::Constant(0.5));
}

/// Places over the element's cell, some near its corners.
template <int Dim>
std::vector<geometry::Point<Dim - 1>> sample_places() {
  std::vector<geometry::Point<Dim - 1>> places;
  for (const double s : {0.05, 0.5, 0.95}) {
    if constexpr (Dim == 2) {
      places.push_back(geometry::Point<1>(s));
    } else {
      for (const double t : {0.05, 0.5, 0.95}) places.push_back({s, t});
    }
  }
  return places;
}

/// The normal of a flat element. Throws InputError where it turns.
template <int Dim>
geometry::Vector<Dim> flat_normal(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element,
                                  const std::string& what) {
  const geometry::Vector<Dim> normal = middle_of(table, element).normal();
  for (const geometry::Point<Dim - 1>& place : sample_places<Dim>()) {
    const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(table, element, place);
    // Beside a pole there is none.
    if (jet.area_vector.isZero(0.0) || (jet.normal() - normal).norm() < 1e-8) continue;
    throw InputError(
        fmt::format("{}: the boundary is not flat at ({}); expected a plane, or components along x, y and "
                    "z",
                    what, fmt::join(jet.position.begin(), jet.position.end(), ", ")));
  }
  return normal;
}

// --- Putting it together ----------------------------------------------------------------------------------------

template <int Dim>
class ProblemBuilder {
 public:
  ProblemBuilder(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary,
                 ConditionSelector<Dim>& selector, solver::FieldSpace<Dim> space)
      : file_(file), boundary_(boundary.boundary), selector_(selector) {
    result_.space = std::move(space);
  }

  BoundaryValueProblem<Dim> build() {
    const AnalysisKeys& analysis = *file_.keys.analysis;
    result_.problem.equation = equation<Dim>(file_.keys, result_.space.table);
    result_.problem.exterior = analysis.exterior;
    if (analysis.state == PlaneState::stress) result_.problem.plane_state = solver::PlaneState::stress;
    assign_conditions();
    warn_of_cut_selections();
    result_.problem.loads = case_loads<Dim>(file_, result_.problem.equation, result_.space.table);
    return std::move(result_);
  }

 private:
  std::string place_of(int condition) const {
    const KeyPlace& where = file_.keys.boundary_condition[static_cast<std::size_t>(condition)].where;
    return fmt::format("{}: {}", where.place.describe(), where.path);
  }

  void assign_conditions() {
    const auto& elements = result_.space.table.elements;
    std::map<std::string, int> uncovered;
    std::vector<char> used(file_.keys.boundary_condition.size(), 0);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const int condition = result_.space.groups[e];
      if (condition < 0) {
        ++uncovered[boundary_.patches[static_cast<std::size_t>(elements[e].patch)].name];
        continue;
      }
      used[static_cast<std::size_t>(condition)] = 1;
      result_.problem.condition_of.push_back(solver_condition(condition, elements[e]));
    }
    refuse_uncovered(uncovered);
    refuse_unused(used);
  }

  void refuse_uncovered(const std::map<std::string, int>& uncovered) const {
    if (uncovered.empty()) return;
    std::vector<std::string> names;
    for (const auto& [name, count] : uncovered) names.push_back(fmt::format("\"{}\"", name));
    throw InputError(
        fmt::format("no boundary condition holds on {} {}; expected one everywhere, for example "
                    "[[boundary_condition]] without \"on\" for what the others leave",
                    names.size() == 1 ? "patch" : "all of patches", fmt::join(names, ", ")));
  }

  /// What is for all may find nothing left; what names a part is meant to hold there.
  void refuse_unused(const std::vector<char>& used) const {
    for (std::size_t i = 0; i < used.size(); ++i) {
      const BoundaryConditionKeys& keys = file_.keys.boundary_condition[i];
      const bool for_all = !keys.selection && (keys.on.items.empty() || keys.on.items.front() == "all");
      if (used[i] == 1 || for_all) continue;
      throw InputError(place_of(static_cast<int>(i)) +
                       (keys.selection ? ": holds nowhere: the middle of no element is selected by \"where\""
                                       : ": holds nowhere: conditions with \"where\" take all of it"));
    }
  }

  /// The index of the solver's condition, made when it is first needed.
  std::int32_t solver_condition(int condition, const geometry::BezierElement<Dim>& element) {
    const BoundaryConditionKeys& keys = file_.keys.boundary_condition[static_cast<std::size_t>(condition)];
    const bool elastic = file_.keys.analysis->equation == EquationKind::elasticity;
    std::optional<Frame<Dim>> frame;
    if (elastic && needs_frame(keys)) {
      frame = frame_about(flat_normal(result_.space.table, element, place_of(condition)));
    }
    for (std::size_t i = 0; i < result_.problem.conditions.size(); ++i) {
      if (result_.case_condition[i] != condition) continue;
      const auto& known = result_.problem.conditions[i].frame;
      if (!frame || (known->row(0) - frame->row(0)).norm() < 1e-8) return static_cast<std::int32_t>(i);
    }
    solver::Condition<Dim> made =
        elastic ? elastic_condition<Dim>(keys, frame, file_) : potential_condition<Dim>(keys, file_);
    made.name = condition_name(file_.keys, static_cast<std::size_t>(condition));
    result_.problem.conditions.push_back(std::move(made));
    result_.case_condition.push_back(condition);
    return static_cast<std::int32_t>(result_.problem.conditions.size() - 1);
  }

  /// A condition that ends inside an element holds on all of it, or on none.
  void warn_of_cut_selections() {
    std::map<std::string, int> cut;
    const geometry::ElementTable<Dim>& table = result_.space.table;
    for (std::size_t e = 0; e < table.elements.size(); ++e) {
      const geometry::BezierElement<Dim>& element = table.elements[e];
      if (element.is_cut()) continue;
      const int chosen = result_.case_condition[static_cast<std::size_t>(result_.problem.condition_of[e])];
      for (const geometry::Point<Dim - 1>& place : sample_places<Dim>()) {
        const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(table, element, place);
        if (selector_.select(element.patch, jet.position, jet.normal()) == chosen) continue;
        ++cut[boundary_.patches[static_cast<std::size_t>(element.patch)].name];
        break;
      }
    }
    for (const auto& [name, count] : cut) {
      result_.warnings.push_back(
          fmt::format("boundary conditions end inside {} element{} of patch \"{}\"; each holds on whole elements, by "
                      "their middles",
                      count, count == 1 ? "" : "s", name));
    }
  }

  const CaseFile& file_;
  const geometry::Boundary<Dim>& boundary_;
  ConditionSelector<Dim>& selector_;
  BoundaryValueProblem<Dim> result_;
};

}  // namespace

template <int Dim>
ProblemStatement<Dim>::ProblemStatement(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary)
    : file_(&file), boundary_(&boundary), selector_(std::make_shared<ConditionSelector<Dim>>(file, boundary.boundary)) {
  geometry::require_closed(boundary);
}

template <int Dim>
solver::DiscretisationOptions<Dim> ProblemStatement<Dim>::discretisation() const {
  solver::DiscretisationOptions<Dim> options;
  options.group = [selector = selector_](int patch, const geometry::Point<Dim>& point,
                                         const geometry::Vector<Dim>& normal) {
    return selector->select(patch, point, normal);
  };
  if (!file_->keys.discretisation) return options;
  const DiscretisationKeys& keys = *file_->keys.discretisation;
  options.degree = keys.degree;
  options.refine = keys.refine;
  for (const PatchDiscretisationKeys& patch : keys.patch) {
    for (const std::string& name : patch.on.items) {
      options.patches.push_back({name, {.degree = patch.degree, .refine = patch.refine}});
    }
  }
  return options;
}

template <int Dim>
BoundaryValueProblem<Dim> ProblemStatement<Dim>::on(solver::FieldSpace<Dim> space) const {
  return ProblemBuilder<Dim>(*file_, *boundary_, *selector_, std::move(space)).build();
}

template class ProblemStatement<2>;
template class ProblemStatement<3>;

}  // namespace isorim::io
