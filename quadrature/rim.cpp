#include "quadrature/rim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/adaptive.h"
#include "quadrature/element_piece.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/parallel.h"
#include "quadrature/piece_samples.h"

namespace isorim::quadrature {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Differences of two rules below this, relative to the scale of rounding, are rounding.
constexpr double difference_noise = 4.0 * epsilon;

/// The integral; the integral of the absolute value, which tells how much cancels; and the same with the flux of the
/// rays replaced by its largest possible size, to which its rounding is relative.
using Values = Eigen::Array<double, 3, 1>;
constexpr int signed_value = 0;
constexpr int absolute_value = 1;
constexpr int rounding_scale = 2;

/// Integrands are functions of which nothing is known: no direction starts below this.
constexpr int least_order_for_functions = 8;

/// Of the first pass, which tells how large the integral is.
constexpr int low_order = 4;

/// What the tolerance is relative to: the integral, or a hundredth of the integral of |f| where it nearly vanishes.
double reference_size(const Values& sum) {
  return std::max(std::abs(sum[signed_value]), 0.01 * sum[absolute_value]);
}

template <int Dim>
std::string describe(const geometry::Point<Dim>& x) {
  std::string text = fmt::format("({:.6g}, {:.6g}", x[0], x[1]);
  for (int i = 2; i < Dim; ++i) text += fmt::format(", {:.6g}", x[i]);
  return text + ")";
}

/// What the evaluators of both kinds of integral share: the call of the integrand, the order to begin with, and the
/// sharing out of the tolerance, equally among elements and their halves.
template <int Dim>
class FunctionEvaluator {
 public:
  using Values = quadrature::Values;
  static constexpr int batch_size = 1;

  FunctionEvaluator(const Integrand<Dim>& integrand, std::size_t elements, double target, double tolerance)
      : integrand_(integrand), elements_(elements), target_(target), tolerance_(tolerance) {}

  bool same_kind(const ElementPiece<Dim>&, const ElementPiece<Dim>&) const { return false; }

  Values allowance(const ElementPiece<Dim>& piece, const Values& value) const {
    const double share = std::ldexp(1.0 / static_cast<double>(elements_), -piece.depth);
    Values allowed = noise(piece, value);
    allowed[signed_value] = std::max(allowed[signed_value], target_ * share);
    return allowed;
  }

  Values noise(const ElementPiece<Dim>&, const Values& value) const {
    Values noise = Values::Constant(std::numeric_limits<double>::max());
    noise[signed_value] = std::max(difference_noise * value[rounding_scale], std::numeric_limits<double>::min());
    return noise;
  }

  Values magnitude(const ElementPiece<Dim>&, const Values& value) const { return value.abs(); }

  template <class AnyOrders>
  void clear_exact(const ElementPiece<Dim>&, const AnyOrders&, Values&) const {}

 protected:
  /// What the element's map needs for the moments; the integrand adds to it, but seldom more than the error estimate
  /// then asks for.
  Orders<Dim - 1> element_orders(const ElementPiece<Dim>& piece) const {
    Orders<Dim - 1> orders = expected_orders(piece, tolerance_);
    for (int& order : orders) order = std::clamp(order + 1, least_order_for_functions, largest_adaptive_order);
    return orders;
  }

  /// Sum of weights[i] f(points_i), of its absolute values, and of those of scales[i] f(points_i). Throws
  /// NumericalError at a value that is not finite.
  Values weighted_sum(const geometry::Points<Dim>& points, const geometry::Points<Dim>& normals,
                      std::span<const double> weights, std::span<const double> scales) const {
    static thread_local std::vector<double> values;
    values.resize(weights.size());
    integrand_(points, normals, values);
    Values sum = Values::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (!std::isfinite(values[i])) {
        const geometry::Point<Dim> where = points.col(static_cast<Eigen::Index>(i));
        // A NaN may have a sign, which says nothing.
        const std::string found = std::isnan(values[i]) ? "nan" : fmt::format("{}", values[i]);
        throw NumericalError(fmt::format("the integrand is {} at {}", found, describe<Dim>(where)));
      }
      sum[signed_value] += weights[i] * values[i];
      sum[absolute_value] += std::abs(weights[i] * values[i]);
      sum[rounding_scale] += scales[i] * std::abs(values[i]);
    }
    return sum;
  }

 private:
  const Integrand<Dim>& integrand_;
  std::size_t elements_;
  double target_;
  double tolerance_;
};

/// int f dS over pieces of the boundary.
template <int Dim>
class BoundaryEvaluator : public FunctionEvaluator<Dim> {
 public:
  using Piece = ElementPiece<Dim>;
  static constexpr int directions = Dim - 1;

  BoundaryEvaluator(const Integrand<Dim>& integrand, const geometry::Point<Dim>&, std::size_t elements, double target,
                    double tolerance)
      : FunctionEvaluator<Dim>(integrand, elements, target, tolerance) {}

  static Piece make_piece(ElementPiece<Dim> piece) { return piece; }

  Orders<directions> start_orders(const Piece& piece) const { return this->element_orders(piece); }

  void evaluate(std::span<const Piece* const> pieces, const Orders<directions>& orders,
                std::span<Values> values) const {
    static thread_local PieceSamples<Dim> samples;
    static thread_local std::vector<double> weights;
    sample_piece(*pieces.front(), orders, samples);
    static thread_local std::vector<double> scales;
    weights.resize(samples.weights.size());
    scales.resize(samples.weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
      auto normal = samples.normals.col(static_cast<Eigen::Index>(i));
      const double measure = normal.norm();
      weights[i] = samples.weights[i] * measure;
      scales[i] = std::abs(weights[i]);
      if (measure > 0.0) normal /= measure;
    }
    values.front() = this->weighted_sum(samples.points, samples.normals, weights, scales);
  }

  std::int64_t points(const Piece& piece, const Orders<directions>& orders) const {
    return points_of_rule(piece, orders);
  }

  std::pair<Piece, Piece> split(const Piece& piece, int direction) const { return bisect(piece, direction); }
};

/// A frustum of the cone from the pole over a piece of the boundary: the rays' part t in `radial`.
template <int Dim>
struct ConePiece : ElementPiece<Dim> {
  geometry::Interval radial;
};

/// int_Omega f over cones: the element's directions and, last, the direction of the rays.
template <int Dim>
class ConeEvaluator : public FunctionEvaluator<Dim> {
 public:
  using Piece = ConePiece<Dim>;
  static constexpr int directions = Dim;

  ConeEvaluator(const Integrand<Dim>& integrand, const geometry::Point<Dim>& pole, std::size_t elements, double target,
                double tolerance)
      : FunctionEvaluator<Dim>(integrand, elements, target, tolerance), pole_(pole) {}

  static Piece make_piece(ElementPiece<Dim> piece) { return {std::move(piece), {0.0, 1.0}}; }

  Orders<directions> start_orders(const Piece& piece) const {
    const Orders<Dim - 1> on_element = this->element_orders(piece);
    Orders<directions> orders;
    std::copy(on_element.begin(), on_element.end(), orders.begin());
    orders[Dim - 1] = least_order_for_functions;
    return orders;
  }
  void evaluate(std::span<const Piece* const> pieces, const Orders<directions>& orders,
                std::span<Values> values) const {
    static thread_local PieceSamples<Dim> samples;
    static thread_local geometry::Points<Dim> points;
    static thread_local std::vector<double> weights;
    static thread_local std::vector<double> scales;
    const Piece& piece = *pieces.front();
    Orders<Dim - 1> on_element;
    std::copy_n(orders.begin(), Dim - 1, on_element.begin());
    sample_piece<Dim>(piece, on_element, samples);
    const Rule& rule = gauss_legendre(orders[Dim - 1]);
    const Eigen::Index rays = samples.points.cols();
    points.resize(Dim, rays * rule.size());
    weights.resize(static_cast<std::size_t>(points.cols()));
    scales.resize(weights.size());
    for (int k = 0; k < rule.size(); ++k) {
      const auto node = static_cast<std::size_t>(k);
      const double t = piece.radial.first + rule.nodes[node] * piece.radial.length();
      const double radial_weight = rule.weights[node] * piece.radial.length() * std::pow(t, Dim - 1);
      for (Eigen::Index i = 0; i < rays; ++i) {
        const geometry::Vector<Dim> d = samples.points.col(i) - pole_;
        const Eigen::Index point = k * rays + i;
        points.col(point) = pole_ + t * d;
        const double weight = radial_weight * samples.weights[static_cast<std::size_t>(i)];
        weights[static_cast<std::size_t>(point)] = weight * d.dot(samples.normals.col(i));
        scales[static_cast<std::size_t>(point)] = std::abs(weight) * d.norm() * samples.normals.col(i).norm();
      }
    }
    static const geometry::Points<Dim> no_normals(Dim, 0);
    values.front() = this->weighted_sum(points, no_normals, weights, scales);
  }

  std::int64_t points(const Piece& piece, const Orders<directions>& orders) const {
    Orders<Dim - 1> on_element;
    std::copy_n(orders.begin(), Dim - 1, on_element.begin());
    return orders[Dim - 1] * points_of_rule<Dim>(piece, on_element);
  }

  std::pair<Piece, Piece> split(const Piece& piece, int direction) const {
    if (direction < Dim - 1) {
      auto [first, second] = bisect<Dim>(piece, direction);
      return {Piece{std::move(first), piece.radial}, Piece{std::move(second), piece.radial}};
    }
    Piece first = piece;
    ++first.depth;
    Piece second = first;
    first.radial.last = second.radial.first = piece.radial.middle();
    return {std::move(first), std::move(second)};
  }

 private:
  geometry::Point<Dim> pole_;
};

/// Integrals over the elements, a few in a task (an integrand costs far more than the geometry).
template <int Dim, template <int> class Evaluator>
class Integration {
 public:
  Integration(const geometry::ElementTable<Dim>& table, const IntegrandFactory<Dim>& factory,
              const geometry::Point<Dim>& pole, const Options& options, CutForm cut_form)
      : table_(table), factory_(factory), pole_(pole), options_(options), cut_form_(cut_form) {
    integrands_.resize(static_cast<std::size_t>(thread_count(options.threads)));
  }

  IntegralResult run() {
    Values reference = in_tasks(0.0, {}, [](auto& integrator, auto pieces) {
                         return integrator.apply_rule(std::move(pieces), low_order);
                       }).sum;
    AdaptiveTotals<Values> totals;
    // The first pass may overrate an integral in which much cancels; then the target was too wide.
    for (int attempt = 0; attempt < 3; ++attempt) {
      const double aimed_at = reference_size(reference);
      totals = in_tasks(options_.tolerance * aimed_at, options_.progress,
                        [](auto& integrator, auto pieces) { return integrator.integrate(std::move(pieces)); });
      reference = totals.sum;
      if (options_.fixed_points > 0 || reference_size(reference) > 0.5 * aimed_at) break;
    }
    return result(totals);
  }

 private:
  static constexpr std::size_t elements_per_task = 4;

  IntegralResult result(const AdaptiveTotals<Values>& totals) const {
    const double rounding = 2.0 * epsilon * totals.sum[rounding_scale];
    IntegralResult result{{totals.sum[signed_value], totals.error[signed_value] + rounding}, totals.evaluations, {}};
    const double allowed = options_.tolerance * reference_size(totals.sum);
    const double noise = rounding + difference_noise * totals.sum[rounding_scale];
    result.status = judge(result.integral.error, allowed, noise, options_);
    return result;
  }

  const Integrand<Dim>& integrand_of(int thread) {
    Integrand<Dim>& integrand = integrands_[static_cast<std::size_t>(thread)];
    if (!integrand) integrand = factory_();
    return integrand;
  }

  template <class Step>
  AdaptiveTotals<Values> in_tasks(double target, const std::function<void(double)>& progress, Step step) {
    const std::size_t count = table_.elements.size();
    const std::size_t tasks = (count + elements_per_task - 1) / elements_per_task;
    std::vector<AdaptiveTotals<Values>> totals(tasks);
    const auto body = [&](std::size_t task, int thread) {
      const Evaluator<Dim> evaluator(integrand_of(thread), pole_, count, target, options_.tolerance);
      std::vector<typename Evaluator<Dim>::Piece> pieces;
      for (std::size_t e = task * elements_per_task; e < std::min(count, (task + 1) * elements_per_task); ++e) {
        for (ElementPiece<Dim>& piece : pieces_of_element(table_, table_.elements[e], cut_form_))
          pieces.push_back(Evaluator<Dim>::make_piece(std::move(piece)));
      }
      AdaptiveIntegrator<Evaluator<Dim>> integrator(evaluator, options_, bisection_share(options_, tasks));
      totals[task] = step(integrator, std::move(pieces));
    };
    parallel_for(tasks, options_.threads, body, progress);
    AdaptiveTotals<Values> sum;
    for (const AdaptiveTotals<Values>& part : totals) sum.add(part);
    return sum;
  }

  const geometry::ElementTable<Dim>& table_;
  const IntegrandFactory<Dim>& factory_;
  geometry::Point<Dim> pole_;
  const Options& options_;
  CutForm cut_form_;
  std::vector<Integrand<Dim>> integrands_;
};

/// Rules for cut elements have points outside what is kept. If the integrand is not finite there, sectors are tried,
/// whose points mostly lie inside.
template <int Dim, template <int> class Evaluator>
IntegralResult integrate(const geometry::ElementTable<Dim>& table, const IntegrandFactory<Dim>& factory,
                         const geometry::Point<Dim>& pole, const Options& options) {
  try {
    return Integration<Dim, Evaluator>(table, factory, pole, options, CutForm::region).run();
  } catch (const NumericalError&) {
    if (table.regions.empty()) throw;
  }
  return Integration<Dim, Evaluator>(table, factory, pole, options, CutForm::sectors).run();
}

}  // namespace

template <int Dim>
IntegralResult integrate_over_domain(const geometry::ElementTable<Dim>& table, const IntegrandFactory<Dim>& integrand,
                                     const std::optional<geometry::Point<Dim>>& pole, const Options& options) {
  const geometry::Point<Dim> centre = pole ? *pole : default_pole(table);
  try {
    return integrate<Dim, ConeEvaluator>(table, integrand, centre, options);
  } catch (NumericalError& error) {
    const std::string where = is_star_shaped_about(table, centre)
                                  ? "the domain is star-shaped about it, so the point lies in the domain"
                                  : "the domain is not star-shaped about it, so the point may lie outside the domain, "
                                    "where the integrand must be defined too; another pole may help";
    error.add_context(fmt::format("on a ray from the pole {} ({})", describe<Dim>(centre), where));
    throw;
  }
}

template <int Dim>
IntegralResult integrate_over_boundary(const geometry::ElementTable<Dim>& table, const IntegrandFactory<Dim>& integrand,
                                       const Options& options) {
  return integrate<Dim, BoundaryEvaluator>(table, integrand, geometry::Point<Dim>::Zero(), options);
}

template IntegralResult integrate_over_domain<2>(const geometry::ElementTable<2>&, const IntegrandFactory<2>&,
                                                 const std::optional<geometry::Point<2>>&, const Options&);
template IntegralResult integrate_over_domain<3>(const geometry::ElementTable<3>&, const IntegrandFactory<3>&,
                                                 const std::optional<geometry::Point<3>>&, const Options&);
template IntegralResult integrate_over_boundary<2>(const geometry::ElementTable<2>&, const IntegrandFactory<2>&,
                                                   const Options&);
template IntegralResult integrate_over_boundary<3>(const geometry::ElementTable<3>&, const IntegrandFactory<3>&,
                                                   const Options&);

}  // namespace isorim::quadrature
