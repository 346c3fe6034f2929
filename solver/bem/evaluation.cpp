#include "solver/bem/evaluation.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "quadrature/parallel.h"
#include "quadrature/target_rules.h"
#include "solver/bem/boundary_locator.h"
#include "solver/bem/representation.h"
#include "solver/bem/simple_solution.h"

namespace isorim::solver {

namespace {

/// Relative to the diagonal of the bounding box.
constexpr double on_boundary = 1e-10;
/// Nearer than this, in units of the nearest element's size, the linear simple solution is taken off.
constexpr double near_boundary = 1.0;

/// From so many points on it is worth while to divide the domain into cells.
constexpr std::size_t many_points = 200;

/// Of all elements, so that densities are as exact as the rules.
template <int Dim>
int largest_field_degree(const FieldSpace<Dim>& space) {
  int largest = 1;
  for (const FieldElement<Dim>& element : space.elements) {
    for (const int degree : element.degree) largest = std::max(largest, degree);
  }
  return largest;
}

template <int Dim>
class Evaluator {
 public:
  Evaluator(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
            const Eigen::Ref<const geometry::Points<Dim>>& points, const EvaluationOptions& options)
      : problem_(problem),
        space_(space),
        solution_(solution),
        points_(points),
        options_(options),
        rules_(space.table, {options.tolerance, largest_field_degree(space)}),
        locator_(space.table),
        representation_(problem, space, rules_, static_cast<int>(solution.potential.cols())),
        contact_(on_boundary * geometry::bounding_box(space.table).diagonal()),
        results_(static_cast<std::size_t>(points.cols())),
        places_(results_.size()) {
    for (int i = 0; i < quadrature::thread_count(options.threads); ++i)
      threads_.push_back(std::make_unique<Thread>(problem, space, solution));
  }

  std::vector<PointEvaluation<Dim>> run() {
    if (results_.size() >= many_points) locator_.prepare(results_.size(), 2.0 * contact_, options_.threads);
    for_points([&](std::size_t i, Thread& thread) { locate(i, thread); });
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < results_.size(); ++i) {
      if (results_[i].location == Location::inside) inside.push_back(i);
    }
    std::vector<quadrature::Target<Dim>> targets;
    for (const std::size_t i : inside) targets.push_back(target(i));
    loads_ = domain_jets<Dim>(problem_.loads, space_.table, rules_, targets, {options_.tolerance, options_.threads},
                              space_.coarse.get());
    constexpr std::size_t batch = Representation<Dim>::batch;
    quadrature::parallel_for((inside.size() + batch - 1) / batch, options_.threads, [&](std::size_t task, int thread) {
      const std::size_t first = task * batch;
      evaluate_inside(std::span(inside).subspan(first, std::min(batch, inside.size() - first)),
                      static_cast<Eigen::Index>(first), *threads_[static_cast<std::size_t>(thread)]);
    });
    for_points([&](std::size_t i, Thread& thread) {
      const BoundaryPlace<Dim>& place = places_[i];
      if (results_[i].location == Location::on_boundary)
        results_[i].field = thread.boundary(place.element, place.place).field;
    });
    return std::move(results_);
  }

 private:
  struct Thread {
    Thread(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution)
        : boundary(problem, space, solution), room(problem, space, solution) {}
    BoundaryFields<Dim> boundary;
    RepresentationRoom<Dim> room;
  };

  template <class Body>
  void for_points(const Body& body) {
    quadrature::parallel_for(results_.size(), options_.threads,
                             [&](std::size_t i, int thread) { body(i, *threads_[static_cast<std::size_t>(thread)]); });
  }

  quadrature::Target<Dim> target(std::size_t point) const {
    quadrature::Target<Dim> target;
    target.position = points_.col(static_cast<Eigen::Index>(point));
    return target;
  }

  void locate(std::size_t i, Thread& thread) {
    const geometry::Point<Dim> x = points_.col(static_cast<Eigen::Index>(i));
    const std::optional<bool> known = locator_.known_inside(x);
    if (known) {
      results_[i].location = *known == problem_.exterior ? Location::outside : Location::inside;
      if (results_[i].location == Location::inside) places_[i] = locator_.nearest(x);
      return;
    }
    places_[i] = locator_.nearest(x);
    if (places_[i].distance <= contact_ && locator_.is_kept(places_[i], thread.room.buffer)) {
      results_[i].location = Location::on_boundary;
      return;
    }
    const bool in_body = locator_.winding_number(x, thread.room.buffer) > 0.5;
    results_[i].location = in_body == problem_.exterior ? Location::outside : Location::inside;
  }

  /// Near the boundary the linear field there; elsewhere a constant, or for exterior problems nothing.
  SimpleSolution<Dim> subtracted(const BoundaryPlace<Dim>& place, double uniform_stress, Thread& thread) const {
    const BoundaryValue<Dim> nearest = thread.boundary(place.element, place.place);
    const Eigen::Index components = nearest.flux.size();
    const bool is_near = place.distance < near_boundary * place.element_size;
    Eigen::VectorXd value = nearest.field.value;
    if (problem_.exterior && !is_near) value.setZero();
    const Eigen::MatrixXd gradient =
        is_near ? nearest.field.gradient : Eigen::MatrixXd(Eigen::MatrixXd::Zero(components, Dim));
    return simple_solution<Dim>(problem_.equation, nearest.position, value, gradient, uniform_stress);
  }

  /// Points of which the loads' columns begin with `column`.
  void evaluate_inside(std::span<const std::size_t> points, Eigen::Index column, Thread& thread) {
    std::vector<typename Representation<Dim>::Place> places;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double uniform_stress = loads_.uniform_stress[column + static_cast<Eigen::Index>(k)];
      places.push_back({target(points[k]), subtracted(places_[points[k]], uniform_stress, thread)});
    }
    const auto sums = representation_.at(places, thread.room);
    for (std::size_t k = 0; k < points.size(); ++k)
      set_field(places[k], sums[k], column + static_cast<Eigen::Index>(k), results_[points[k]].field);
  }

  void set_field(const typename Representation<Dim>::Place& place, const typename Representation<Dim>::Sums& sums,
                 Eigen::Index column, FieldValue<Dim>& field) const {
    if (problem_.exterior) {
      field.value = -sums.value;
      field.gradient = -sums.gradient;
      if (solution_.at_infinity.size() > 0) field.value += solution_.at_infinity;
    } else {
      field.value = place.simple.at(place.target.position) + sums.value;
      field.gradient = place.simple.gradient + sums.gradient;
    }
    if (!problem_.loads.empty()) {
      field.value += loads_.value.col(column);
      field.gradient += Eigen::Map<const Eigen::MatrixXd>(loads_.gradient.col(column).data(), field.value.size(), Dim);
    }
    set_stress(problem_, loads_.uniform_stress[column], field);
  }

  const Problem<Dim>& problem_;
  const FieldSpace<Dim>& space_;
  const Solution<Dim>& solution_;
  Eigen::Ref<const geometry::Points<Dim>> points_;
  EvaluationOptions options_;
  quadrature::TargetRules<Dim> rules_;
  BoundaryLocator<Dim> locator_;
  Representation<Dim> representation_;
  /// Nearer to the boundary than this is on it.
  double contact_;
  std::vector<PointEvaluation<Dim>> results_;
  std::vector<BoundaryPlace<Dim>> places_;
  DomainJets loads_;
  std::vector<std::unique_ptr<Thread>> threads_;
};

}  // namespace

template <int Dim>
std::vector<PointEvaluation<Dim>> evaluate_at(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                              const Solution<Dim>& solution,
                                              const Eigen::Ref<const geometry::Points<Dim>>& points,
                                              const EvaluationOptions& options) {
  return Evaluator<Dim>(problem, space, solution, points, options).run();
}

template std::vector<PointEvaluation<2>> evaluate_at(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&,
                                                     const Eigen::Ref<const geometry::Points<2>>&,
                                                     const EvaluationOptions&);
template std::vector<PointEvaluation<3>> evaluate_at(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&,
                                                     const Eigen::Ref<const geometry::Points<3>>&,
                                                     const EvaluationOptions&);

}  // namespace isorim::solver
