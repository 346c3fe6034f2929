#include "solver/bem/boundary_integrals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "quadrature/target_rules.h"
#include "solver/bem/field_densities.h"

namespace isorim::solver {

namespace {

using quadrature::NodeView;

/// Rules for products of two fields, at nodes spread over all of each element.
template <int Dim>
class ElementSweep {
 public:
  ElementSweep(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
               const EvaluationOptions& options)
      : problem_(problem),
        space_(space),
        solution_(solution),
        threads_(options.threads),
        rules_(space.table, {options.tolerance, 2 * largest_degree(space)}) {}

  /// body(element, nodes, densities, thread) for every element.
  void run(const std::function<void(std::size_t, const NodeView<Dim>&, const Densities&, int)>& body) const {
    std::vector<std::unique_ptr<FieldDensities<Dim>>> fields(
        static_cast<std::size_t>(quadrature::thread_count(threads_)));
    quadrature::parallel_for(space_.elements.size(), threads_, [&](std::size_t e, int thread) {
      std::unique_ptr<FieldDensities<Dim>>& own = fields[static_cast<std::size_t>(thread)];
      if (!own) own = std::make_unique<FieldDensities<Dim>>(problem_, space_, solution_);
      // Kernels seen from one radius away vary more than fields do.
      const NodeView<Dim> nodes = rules_.far_nodes(static_cast<int>(e), rules_.sphere(static_cast<int>(e)).radius);
      Densities densities;
      own->at_nodes(static_cast<int>(e), nodes, densities);
      body(e, nodes, densities, thread);
    });
  }

 private:
  static int largest_degree(const FieldSpace<Dim>& space) {
    int largest = 1;
    for (const FieldElement<Dim>& element : space.elements) {
      for (const int degree : element.degree) largest = std::max(largest, degree);
    }
    return largest;
  }

  const Problem<Dim>& problem_;
  const FieldSpace<Dim>& space_;
  const Solution<Dim>& solution_;
  int threads_;
  quadrature::TargetRules<Dim> rules_;
};

template <int Dim>
geometry::Vector<Dim> gather(const std::array<std::span<const double>, Dim>& rows, std::size_t node) {
  geometry::Vector<Dim> x;
  for (std::size_t i = 0; i < Dim; ++i) x[static_cast<Eigen::Index>(i)] = rows[i][node];
  return x;
}

int moment_count(int components, int dimension) {
  if (components == 1) return 0;
  return dimension == 2 ? 1 : 3;
}

template <int Dim>
FieldIntegrals<Dim> nothing(int components) {
  return {0.0, Eigen::VectorXd::Zero(components), Eigen::VectorXd::Zero(moment_count(components, Dim)),
          Eigen::VectorXd::Zero(components), Eigen::MatrixXd::Zero(components, Dim)};
}

template <int Dim>
void add(const FieldIntegrals<Dim>& part, FieldIntegrals<Dim>& sum) {
  sum.measure += part.measure;
  sum.flux += part.flux;
  sum.moment += part.moment;
  sum.potential += part.potential;
  sum.potential_normal += part.potential_normal;
  sum.work += part.work;
  sum.potential_squared += part.potential_squared;
  sum.flux_magnitude += part.flux_magnitude;
}

/// arm x force.
template <int Dim>
void add_moment(const geometry::Vector<Dim>& arm, const Eigen::VectorXd& force, Eigen::VectorXd& moment) {
  if (moment.size() == 1) moment[0] += arm[0] * force[1] - arm[1] * force[0];
  if (moment.size() != 3) return;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index j = (i + 1) % 3;
    const Eigen::Index k = (i + 2) % 3;
    moment[i] += arm[j] * force[k] - arm[k] * force[j];
  }
}

template <int Dim>
FieldIntegrals<Dim> integrate(const NodeView<Dim>& nodes, const Densities& densities,
                              const geometry::Point<Dim>& point) {
  FieldIntegrals<Dim> sum = nothing<Dim>(static_cast<int>(densities.flux.cols()));
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    const auto row = static_cast<Eigen::Index>(q);
    const double weight = nodes.weight[q];
    const Eigen::VectorXd u = densities.potential.row(row).transpose();
    const Eigen::VectorXd t = weight * densities.flux.row(row).transpose();
    sum.measure += weight;
    sum.flux += t;
    sum.potential += weight * u;
    sum.potential_normal += weight * u * gather<Dim>(nodes.normal, q).transpose();
    sum.work += u.dot(t);
    sum.potential_squared += weight * u.squaredNorm();
    sum.flux_magnitude += weight * densities.flux.row(row).norm();
    add_moment<Dim>(gather<Dim>(nodes.position, q) - point, t, sum.moment);
  }
  return sum;
}

/// The values of one set of functions at the nodes: nodes x components.
template <int Dim>
Eigen::MatrixXd evaluate(const std::vector<quadrature::Integrand<Dim>>& functions, const NodeView<Dim>& nodes) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  geometry::Points<Dim> points(Dim, count);
  geometry::Points<Dim> normals(Dim, count);
  for (Eigen::Index q = 0; q < count; ++q) {
    points.col(q) = gather<Dim>(nodes.position, static_cast<std::size_t>(q));
    normals.col(q) = gather<Dim>(nodes.normal, static_cast<std::size_t>(q));
  }
  Eigen::MatrixXd values(count, static_cast<Eigen::Index>(functions.size()));
  for (std::size_t c = 0; c < functions.size(); ++c)
    functions[c](points, normals, {values.col(static_cast<Eigen::Index>(c)).data(), nodes.size()});
  return values;
}

/// Squares of l2 norms, largest values as they are.
ErrorNorms compare(const Eigen::MatrixXd& found, const Eigen::MatrixXd& exact, std::span<const double> weight) {
  ErrorNorms norms;
  for (Eigen::Index q = 0; q < found.rows(); ++q) {
    const double error = (found.row(q) - exact.row(q)).norm();
    const double size = exact.row(q).norm();
    norms.l2 += weight[static_cast<std::size_t>(q)] * error * error;
    norms.exact_l2 += weight[static_cast<std::size_t>(q)] * size * size;
    norms.max = std::max(norms.max, error);
    norms.exact_max = std::max(norms.exact_max, size);
  }
  return norms;
}

ErrorNorms combine(const std::vector<ErrorNorms>& parts) {
  ErrorNorms all;
  for (const ErrorNorms& part : parts) {
    all.l2 += part.l2;
    all.exact_l2 += part.exact_l2;
    all.max = std::max(all.max, part.max);
    all.exact_max = std::max(all.exact_max, part.exact_max);
  }
  // Weights on cut elements may be negative.
  all.l2 = std::sqrt(std::max(all.l2, 0.0));
  all.exact_l2 = std::sqrt(std::max(all.exact_l2, 0.0));
  return all;
}

template <int Dim>
void require_count(const std::vector<quadrature::IntegrandFactory<Dim>>& functions, Eigen::Index components) {
  if (!functions.empty() && static_cast<Eigen::Index>(functions.size()) != components)
    throw InputError(
        fmt::format("found {} exact functions; expected one for each of {} components", functions.size(), components));
}

/// The functions of one exact field, made for each thread when it needs them.
template <int Dim>
class ExactField {
 public:
  ExactField(const std::vector<quadrature::IntegrandFactory<Dim>>& factories, int threads, std::size_t elements)
      : factories_(factories),
        functions_(static_cast<std::size_t>(quadrature::thread_count(threads))),
        norms_(elements) {}

  void look(std::size_t element, const NodeView<Dim>& nodes, const Eigen::MatrixXd& found, int thread) {
    if (factories_.empty()) return;
    std::vector<quadrature::Integrand<Dim>>& own = functions_[static_cast<std::size_t>(thread)];
    if (own.empty()) {
      for (const auto& make : factories_) own.push_back(make());
    }
    norms_[element] = compare(found, evaluate<Dim>(own, nodes), nodes.weight);
  }

  std::optional<ErrorNorms> norms() const {
    if (factories_.empty()) return std::nullopt;
    return combine(norms_);
  }

 private:
  const std::vector<quadrature::IntegrandFactory<Dim>>& factories_;
  std::vector<std::vector<quadrature::Integrand<Dim>>> functions_;
  std::vector<ErrorNorms> norms_;
};

}  // namespace

template <int Dim>
BoundaryIntegrals<Dim> field_integrals(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                       const Solution<Dim>& solution, const EvaluationOptions& options,
                                       const geometry::Point<Dim>& point) {
  const int components = static_cast<int>(solution.flux.cols());
  std::vector<FieldIntegrals<Dim>> parts(space.elements.size());
  ElementSweep<Dim>(problem, space, solution, options)
      .run([&](std::size_t e, const NodeView<Dim>& nodes, const Densities& densities, int) {
        parts[e] = integrate<Dim>(nodes, densities, point);
      });
  int patch_count = 0;
  for (const auto& element : space.table.elements) patch_count = std::max(patch_count, element.patch + 1);
  const FieldIntegrals<Dim> zero = nothing<Dim>(components);
  BoundaryIntegrals<Dim> result{zero, {}, {}};
  result.patches.assign(static_cast<std::size_t>(patch_count), zero);
  result.conditions.assign(problem.conditions.size(), zero);
  for (std::size_t e = 0; e < parts.size(); ++e) {
    add(parts[e], result.total);
    add(parts[e], result.patches[static_cast<std::size_t>(space.table.elements[e].patch)]);
    add(parts[e], result.conditions[static_cast<std::size_t>(problem.condition_of[e])]);
  }
  return result;
}

template <int Dim>
ResultIntegrals<Dim> result_integrals(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                      const Solution<Dim>& solution, const geometry::Point<Dim>& point,
                                      const EvaluationOptions& options) {
  ResultIntegrals<Dim> result{field_integrals(problem, space, solution, options, point), {}, {}, {}};
  const int components = static_cast<int>(solution.flux.cols());
  result.load = {Eigen::VectorXd::Zero(components), Eigen::VectorXd::Zero(moment_count(components, Dim))};
  if (!problem.loads.empty())
    result.load = load_resultant<Dim>(problem.loads, space.table, point, options.tolerance, options.threads);
  if (!problem.exterior) {
    result.force_imbalance = result.total.flux + result.load.force;
    result.moment_imbalance = result.total.moment + result.load.moment;
  }
  return result;
}

template <int Dim>
Eigen::VectorXd integrate_fields(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                 const Solution<Dim>& solution, int count,
                                 const std::function<FieldFunction<Dim>()>& make, const EvaluationOptions& options) {
  std::vector<FieldFunction<Dim>> functions(static_cast<std::size_t>(quadrature::thread_count(options.threads)));
  Eigen::MatrixXd parts = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(space.elements.size()));
  ElementSweep<Dim>(problem, space, solution, options)
      .run([&](std::size_t e, const NodeView<Dim>& nodes, const Densities& densities, int thread) {
        FieldFunction<Dim>& function = functions[static_cast<std::size_t>(thread)];
        if (!function) function = make();
        const std::size_t n = nodes.size();
        std::vector<double> values(static_cast<std::size_t>(count) * n);
        function(nodes, densities, values);
        for (int i = 0; i < count; ++i)
          for (std::size_t q = 0; q < n; ++q)
            parts(i, static_cast<Eigen::Index>(e)) += nodes.weight[q] * values[static_cast<std::size_t>(i) * n + q];
      });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count);
  for (Eigen::Index e = 0; e < parts.cols(); ++e) sum += parts.col(e);
  return sum;
}

template <int Dim>
double integrate_fields(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
                        const std::function<FieldFunction<Dim>()>& make, const EvaluationOptions& options) {
  return integrate_fields<Dim>(problem, space, solution, 1, make, options)[0];
}

template <int Dim>
BoundaryErrors<Dim> boundary_errors(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const Solution<Dim>& solution, const ExactData<Dim>& exact,
                                    const EvaluationOptions& options) {
  require_count<Dim>(exact.potential, solution.potential.cols());
  require_count<Dim>(exact.flux, solution.flux.cols());
  ExactField<Dim> potential(exact.potential, options.threads, space.elements.size());
  ExactField<Dim> flux(exact.flux, options.threads, space.elements.size());
  ElementSweep<Dim>(problem, space, solution, options)
      .run([&](std::size_t e, const NodeView<Dim>& nodes, const Densities& densities, int thread) {
        potential.look(e, nodes, densities.potential, thread);
        flux.look(e, nodes, densities.flux, thread);
      });
  return {potential.norms(), flux.norms()};
}

template BoundaryIntegrals<2> field_integrals(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&,
                                              const EvaluationOptions&, const geometry::Point<2>&);
template BoundaryIntegrals<3> field_integrals(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&,
                                              const EvaluationOptions&, const geometry::Point<3>&);
template ResultIntegrals<2> result_integrals(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&,
                                             const geometry::Point<2>&, const EvaluationOptions&);
template ResultIntegrals<3> result_integrals(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&,
                                             const geometry::Point<3>&, const EvaluationOptions&);
template Eigen::VectorXd integrate_fields(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&, int,
                                          const std::function<FieldFunction<2>()>&, const EvaluationOptions&);
template double integrate_fields(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&,
                                 const std::function<FieldFunction<2>()>&, const EvaluationOptions&);
template Eigen::VectorXd integrate_fields(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&, int,
                                          const std::function<FieldFunction<3>()>&, const EvaluationOptions&);
template double integrate_fields(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&,
                                 const std::function<FieldFunction<3>()>&, const EvaluationOptions&);
template BoundaryErrors<2> boundary_errors(const Problem<2>&, const FieldSpace<2>&, const Solution<2>&,
                                           const ExactData<2>&, const EvaluationOptions&);
template BoundaryErrors<3> boundary_errors(const Problem<3>&, const FieldSpace<3>&, const Solution<3>&,
                                           const ExactData<3>&, const EvaluationOptions&);

}  // namespace isorim::solver
