#include "solver/bem/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <variant>

#include "geometry/bezier/element_jet.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/parallel.h"
#include "solver/bem/boundary_integrals.h"
#include "solver/bem/representation.h"

namespace isorim::solver {

namespace {

/// A place at which the residual is taken, and what it weighs in its element's mean.
template <int Dim>
struct Sample {
  quadrature::Target<Dim> target;
  double weight = 0.0;
};

/// Gauss points in each direction: more than collocation has, of which there are about as many as functions that live
/// mostly on the element.
template <int Dim>
int samples_per_direction(int collocation_points) {
  const double per_direction = std::pow(static_cast<double>(std::max(1, collocation_points)), 1.0 / (Dim - 1));
  return static_cast<int>(std::ceil(per_direction - 1e-9)) + (Dim == 2 ? 2 : 1);
}

/// Tensor Gauss points of the cell, those of cut elements that the rule gives weight (they lie all over the cell; the
/// equation holds on what is kept alone, so the others are passed over).
template <int Dim>
std::vector<Sample<Dim>> samples_on(const FieldSpace<Dim>& space, std::size_t element, int collocation_points) {
  const quadrature::Rule& rule = quadrature::gauss_legendre(samples_per_direction<Dim>(collocation_points));
  const auto n = static_cast<std::size_t>(rule.size());
  const geometry::BezierElement<Dim>& bezier = space.table.elements[element];
  std::vector<Sample<Dim>> samples;
  for (std::size_t k = 0; k < (Dim == 2 ? n : n * n); ++k) {
    Sample<Dim> sample;
    sample.target.element = static_cast<int>(element);
    sample.target.place[0] = rule.nodes[k % n];
    sample.weight = rule.weights[k % n];
    if constexpr (Dim == 3) {
      sample.target.place[1] = rule.nodes[k / n];
      sample.weight *= rule.weights[k / n];
    }
    const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(space.table, bezier, sample.target.place);
    sample.target.position = jet.position;
    sample.weight *= jet.area_vector.norm();
    samples.push_back(sample);
  }
  return samples;
}

/// Of a cut element: its own collocation points, moved a little towards one another. They lie in what is kept, and so
/// do, as a rule, the points between them.
template <int Dim>
std::vector<Sample<Dim>> samples_between(const FieldSpace<Dim>& space, std::size_t element,
                                         const std::vector<int>& own) {
  std::vector<Sample<Dim>> samples;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const CollocationPoint<Dim>& here = space.points[static_cast<std::size_t>(own[k])];
    const CollocationPoint<Dim>& next = space.points[static_cast<std::size_t>(own[(k + 1) % own.size()])];
    Sample<Dim> sample;
    sample.target.element = static_cast<int>(element);
    const geometry::Point<Dim - 1> other =
        own.size() > 1 ? next.place : geometry::Point<Dim - 1>(geometry::Point<Dim - 1>::Constant(0.5));
    constexpr double part = 0.25;
    sample.target.place = here.place + part * (other - here.place);
    const geometry::ElementJet<Dim> jet =
        geometry::evaluate_jet(space.table, space.table.elements[element], sample.target.place);
    sample.target.position = jet.position;
    sample.weight = jet.area_vector.norm() / static_cast<double>(own.size());
    samples.push_back(sample);
  }
  return samples;
}

template <int Dim>
class ResidualEstimator {
 public:
  ResidualEstimator(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
                    const EvaluationOptions& options)
      : problem_(problem),
        space_(space),
        solution_(solution),
        options_(options),
        components_(static_cast<int>(solution.potential.cols())),
        rules_(space.table, {options.tolerance, largest_degree(space)}),
        representation_(problem, space, rules_, components_) {
    for (int i = 0; i < quadrature::thread_count(options.threads); ++i)
      rooms_.push_back(std::make_unique<RepresentationRoom<Dim>>(problem, space, solution));
  }

  std::vector<double> indicators() {
    collect_samples();
    std::vector<quadrature::Target<Dim>> targets;
    for (const Sample<Dim>& sample : samples_) targets.push_back(sample.target);
    const Eigen::MatrixXd loads = domain_potentials<Dim>(problem_.loads, space_.table, rules_, targets,
                                                         {options_.tolerance, options_.threads}, space_.coarse.get());
    const std::vector<double> squares = squared_residuals(loads);
    std::vector<double> result(space_.elements.size(), 0.0);
    for (std::size_t e = 0; e < result.size(); ++e) {
      double sum = 0.0;
      double measure = 0.0;
      for (std::size_t i = first_[e]; i < first_[e + 1]; ++i) {
        sum += squares[i];
        measure += samples_[i].weight;
      }
      const double size = Dim == 2 ? measure : std::sqrt(measure);
      if (size > 0.0) result[e] = std::sqrt(sum / size);
    }
    return result;
  }

 private:
  static int largest_degree(const FieldSpace<Dim>& space) {
    int largest = 1;
    for (const FieldElement<Dim>& element : space.elements) {
      for (const int degree : element.degree) largest = std::max(largest, degree);
    }
    return largest;
  }

  void collect_samples() {
    std::vector<std::vector<int>> own(space_.elements.size());
    for (std::size_t i = 0; i < space_.points.size(); ++i)
      own[static_cast<std::size_t>(space_.points[i].element)].push_back(static_cast<int>(i));
    for (std::size_t e = 0; e < space_.elements.size(); ++e) {
      first_.push_back(samples_.size());
      const std::vector<Sample<Dim>> more = space_.table.elements[e].is_cut()
                                                ? samples_between(space_, e, own[e])
                                                : samples_on(space_, e, static_cast<int>(own[e].size()));
      samples_.insert(samples_.end(), more.begin(), more.end());
    }
    first_.push_back(samples_.size());
  }

  /// Weighted squares of the samples' residuals.
  std::vector<double> squared_residuals(const Eigen::MatrixXd& loads) {
    constexpr std::size_t batch = Representation<Dim>::batch;
    std::vector<double> squares(samples_.size());
    quadrature::parallel_for(
        (samples_.size() + batch - 1) / batch, options_.threads, [&](std::size_t task, int thread) {
          const std::size_t first = task * batch;
          const std::size_t count = std::min(batch, samples_.size() - first);
          const Eigen::MatrixXd residuals = equations(first, count, *rooms_[static_cast<std::size_t>(thread)]);
          for (std::size_t i = 0; i < count; ++i) {
            Eigen::VectorXd residual = residuals.col(static_cast<Eigen::Index>(i));
            if (!problem_.loads.empty()) residual += loads.col(static_cast<Eigen::Index>(first + i));
            squares[first + i] = samples_[first + i].weight * residual.squaredNorm();
          }
        });
    return squares;
  }

  Eigen::VectorXd potential_at(const quadrature::Target<Dim>& target, RepresentationRoom<Dim>& room) const {
    const auto element = static_cast<std::size_t>(target.element);
    const geometry::ElementJet<Dim> jet =
        geometry::evaluate_jet(space_.table, space_.table.elements[element], target.place);
    Densities here;
    room.densities.at_place(target.element, target.place, jet.position, jet.normal(), here);
    return here.potential.row(0).transpose();
  }

  /// int U t dS - int T (u - u(x)) dS, and for exterior problems + u(x) less what the field tends to: with the loads,
  /// the residual. A column for each of the samples.
  Eigen::MatrixXd equations(std::size_t first, std::size_t count, RepresentationRoom<Dim>& room) const {
    const Eigen::MatrixXd flat = Eigen::MatrixXd::Zero(components_, Dim);
    std::vector<typename Representation<Dim>::Place> places;
    for (std::size_t i = first; i < first + count; ++i) {
      const quadrature::Target<Dim>& target = samples_[i].target;
      places.push_back(
          {target, simple_solution<Dim>(problem_.equation, target.position, potential_at(target, room), flat, 0.0)});
    }
    const auto sums = representation_.values(places, room);
    Eigen::MatrixXd residuals(components_, static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      auto residual = residuals.col(static_cast<Eigen::Index>(i));
      residual = sums[i].value;
      if (!problem_.exterior) continue;
      residual += places[i].simple.value;
      if (solution_.at_infinity.size() > 0) residual -= solution_.at_infinity;
    }
    return residuals;
  }

  const Problem<Dim>& problem_;
  const FieldSpace<Dim>& space_;
  const Solution<Dim>& solution_;
  EvaluationOptions options_;
  int components_;
  quadrature::TargetRules<Dim> rules_;
  Representation<Dim> representation_;
  std::vector<std::unique_ptr<RepresentationRoom<Dim>>> rooms_;
  std::vector<Sample<Dim>> samples_;
  /// The samples of element e are samples_[first_[e]] to samples_[first_[e + 1] - 1].
  std::vector<std::size_t> first_;
};

}  // namespace

template <int Dim>
std::vector<double> error_indicators(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                     const Solution<Dim>& solution, const EvaluationOptions& options) {
  return ResidualEstimator<Dim>(problem, space, solution, options).indicators();
}

double total_indicator(std::span<const double> indicators) {
  double sum = 0.0;
  for (const double indicator : indicators) sum += indicator * indicator;
  return std::sqrt(sum);
}

std::vector<int> mark_elements(std::span<const double> indicators, double share) {
  std::vector<int> order(indicators.size());
  std::iota(order.begin(), order.end(), 0);
  const auto of = [&](int element) { return indicators[static_cast<std::size_t>(element)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return of(a) > of(b); });
  const double total = total_indicator(indicators);
  const double wanted = share * total * total;
  constexpr double same = 1e-6;
  double sum = 0.0;
  std::size_t count = 0;
  while (count < order.size() && of(order[count]) > 0.0) {
    const bool is_tied = count > 0 && of(order[count]) >= (1.0 - same) * of(order[count - 1]);
    if (sum >= wanted && !is_tied) break;
    sum += of(order[count]) * of(order[count]);
    ++count;
  }
  order.resize(count);
  std::sort(order.begin(), order.end());
  return order;
}

template <int Dim>
double solution_size(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
                     const EvaluationOptions& options) {
  const FieldIntegrals<Dim> total = field_integrals(problem, space, solution, options).total;
  const auto* laplace = std::get_if<Laplace<Dim>>(&problem.equation);
  const double stiffness = laplace ? laplace->conductivity : std::get<Elasticity<Dim>>(problem.equation).shear_modulus;
  const double length = geometry::bounding_box(space.table).diagonal();
  const double flux = total.flux_magnitude / stiffness;
  return std::sqrt(std::max(total.potential_squared, 0.0) / length + flux * flux * std::pow(length, 2 - Dim));
}

template std::vector<double> error_indicators(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&,
                                              const EvaluationOptions&);
template std::vector<double> error_indicators(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&,
                                              const EvaluationOptions&);
template double solution_size(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&, const EvaluationOptions&);
template double solution_size(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&, const EvaluationOptions&);

}  // namespace isorim::solver
