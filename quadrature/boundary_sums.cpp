#include "quadrature/boundary_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "quadrature/adaptive.h"
#include "quadrature/element_piece.h"
#include "quadrature/parallel.h"

namespace isorim::quadrature {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Differences of two rules below this, relative to measure times distance from the pole, are rounding.
constexpr double difference_noise = 4.0 * epsilon;

/// Elements that one task integrates: few enough to share out, enough to fill the vector lanes.
constexpr std::size_t elements_per_task = 64;

/// How large a shape is, from a first pass with a low rule.
template <int Dim>
struct Scales {
  /// Largest distance of a control point from the pole, and largest absolute coordinate (of the pole, too: positions
  /// are taken relative to it).
  double radius = 0.0;
  double coordinate = 0.0;
  ElementSums<Dim> sums = ElementSums<Dim>::Zero();
  std::size_t elements = 0;
};

template <int Dim>
ElementBatch<Dim> batch_of(const ElementPiece<Dim>& first) {
  ElementBatch<Dim> batch;
  for (std::size_t d = 0; d < Dim - 1; ++d) batch.degree[d] = first.element->degree[d];
  batch.polynomial = first.element->polynomial;
  return batch;
}

/// The largest power of the distance from the pole in each sum.
template <int Dim>
constexpr int power_of_distance(int sum) {
  using Layout = SumLayout<Dim>;
  if (sum < Layout::content) return 0;
  if (sum < Layout::first) return 1;
  return sum < Layout::second ? 2 : 3;
}

template <int Dim>
class SumsEvaluator {
 public:
  using Piece = ElementPiece<Dim>;
  using Values = ElementSums<Dim>;
  using Layout = SumLayout<Dim>;
  static constexpr int directions = Dim - 1;
  static constexpr int batch_size = kernel_lanes;

  SumsEvaluator(const geometry::Point<Dim>& pole, const Scales<Dim>& scales, SumScope scope, double tolerance)
      : pole_(pole), scales_(scales), tolerance_(tolerance) {
    target_.fill(std::numeric_limits<double>::max());
    target_[Layout::measure] = tolerance * scales.sums[Layout::measure];
    if (scope == SumScope::all) set_domain_targets();
  }

  /// Errors of the sums over all pieces that the tolerance asks for.
  const Values& target() const { return target_; }

  Orders<directions> start_orders(const Piece& piece) const { return expected_orders(piece, tolerance_); }

  bool same_kind(const Piece& a, const Piece& b) const {
    return a.element->degree == b.element->degree && a.element->polynomial == b.element->polynomial &&
           a.is_cut() == b.is_cut();
  }

  void evaluate(std::span<const Piece* const> pieces, const Orders<directions>& orders,
                std::span<Values> values) const {
    ElementBatch<Dim> batch = batch_of(*pieces.front());
    const Orders<directions> nodes = nodes_of_rule(*pieces.front(), orders);
    for (const Piece* piece : pieces) {
      const auto lane = static_cast<std::size_t>(batch.size++);
      batch.nets[lane] = piece->net();
      if constexpr (Dim == 3) {
        if (piece->is_cut()) batch.regions[lane] = &piece->region->moments(nodes);
      }
    }
    sum_over_elements(batch, pole_, nodes, values.first(pieces.size()));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      values[i].template tail<Layout::count - 1>() *= pieces[i]->element->orientation;
    }
  }

  std::int64_t points(const Piece& piece, const Orders<directions>& orders) const {
    return points_of_rule(piece, orders);
  }

  Values magnitude(const Piece& piece, const Values& value) const { return amplification(piece) * value.abs(); }

  std::pair<Piece, Piece> split(const Piece& piece, int direction) const { return bisect(piece, direction); }

  /// Half of the target is shared out by measure, half equally among elements and their halves; and a piece may always
  /// err by rounding.
  Values allowance(const Piece& piece, const Values& value) const {
    const double measure = std::max(0.0, value[Layout::measure]);
    const double share = 0.5 * std::ldexp(1.0 / static_cast<double>(scales_.elements), -piece.depth) +
                         0.5 * measure / scales_.sums[Layout::measure];
    return (target_ * share).max(noise(piece, value));
  }

  Values noise(const Piece& piece, const Values& value) const {
    const double measure = amplification(piece) * std::abs(value[Layout::measure]);
    Values noise;
    for (int k = 0; k < Layout::count; ++k) {
      const double scale = measure * std::pow(scales_.radius, power_of_distance<Dim>(k));
      noise[k] = std::max(difference_noise * scale, std::numeric_limits<double>::min());
    }
    return noise;
  }

  void clear_exact(const Piece& piece, const Orders<directions>& orders, Values& difference) const {
    if (!piece.element->polynomial) return;
    for (std::size_t d = 0; d < directions; ++d) {
      if (orders[d] < exact_order<Dim>(piece.element->degree[d])) return;
    }
    difference.template tail<Layout::count - 1>().setZero();
  }

 private:
  /// Such that the content, the centroid relative to the size, and the inertia about the centroid meet the tolerance.
  /// The last is what a pole far from the centroid makes hard: errors of content and first moments enter it with
  /// powers of that distance.
  void set_domain_targets() {
    const Values& sums = scales_.sums;
    const double content = std::abs(sums[Layout::content]);
    const double measure = content / Dim;
    const double first = sums.template segment<Dim>(Layout::first).matrix().norm() / (Dim + 1);
    const double about_pole = std::abs(sums.template segment<Dim>(Layout::second).sum()) / (Dim + 2);
    const double about_centroid = std::max(about_pole - first * first / measure, 1e-3 * about_pole);
    const double offset = first / measure;
    const double inertia_error = tolerance_ * (Dim - 1) * about_centroid;
    target_.template segment<Dim>(Layout::normal).fill(tolerance_ * sums[Layout::measure]);
    target_[Layout::content] = std::min(tolerance_ * content, 0.2 * Dim * inertia_error / (offset * offset));
    target_.template segment<Dim>(Layout::first)
        .fill(std::min(tolerance_ * content * scales_.radius, 0.1 * (Dim + 1) / Dim * inertia_error / offset));
    target_.template tail<Layout::count - Layout::second>().fill(0.5 * (Dim + 2) / Dim * inertia_error);
  }

  /// A piece that has been evaluated: see RegionMoments.
  static double amplification(const Piece& piece) {
    return piece.is_cut() ? piece.region->moments({}).amplification() : 1.0;
  }

  geometry::Point<Dim> pole_;
  const Scales<Dim>& scales_;
  double tolerance_;
  Values target_;
};

template <int Dim>
std::size_t task_count(const geometry::ElementTable<Dim>& table) {
  return (table.elements.size() + elements_per_task - 1) / elements_per_task;
}

/// body(range) over the elements in ranges of elements_per_task, the tasks' totals added in order.
template <int Dim, class Body>
AdaptiveTotals<ElementSums<Dim>> sum_in_tasks(const geometry::ElementTable<Dim>& table, const Options& options,
                                              const std::function<void(double)>& progress, Body body) {
  const std::span<const geometry::BezierElement<Dim>> elements(table.elements);
  const std::size_t tasks = task_count(table);
  std::vector<AdaptiveTotals<ElementSums<Dim>>> totals(tasks);
  const auto run = [&](std::size_t task, int) {
    const std::size_t begin = task * elements_per_task;
    totals[task] = body(elements.subspan(begin, std::min(elements_per_task, elements.size() - begin)));
  };
  parallel_for(tasks, options.threads, run, progress);
  // Pairwise, so that rounding grows with the logarithm of the number of tasks.
  for (std::size_t step = 1; step < tasks; step *= 2) {
    for (std::size_t i = 0; i + step < tasks; i += 2 * step) totals[i].add(totals[i + step]);
  }
  return tasks > 0 ? totals.front() : AdaptiveTotals<ElementSums<Dim>>{};
}

template <int Dim>
std::vector<ElementPiece<Dim>> pieces_of(const geometry::ElementTable<Dim>& table,
                                         std::span<const geometry::BezierElement<Dim>> elements) {
  std::vector<ElementPiece<Dim>> pieces;
  pieces.reserve(elements.size());
  for (const geometry::BezierElement<Dim>& element : elements) {
    for (ElementPiece<Dim>& piece : pieces_of_element(table, element, CutForm::region))
      pieces.push_back(std::move(piece));
  }
  return pieces;
}

template <int Dim>
Scales<Dim> measure_scales(const geometry::ElementTable<Dim>& table, const geometry::Point<Dim>& pole,
                           const Options& options) {
  Scales<Dim> scales;
  const geometry::BoundingBox<Dim> box = geometry::bounding_box(table);
  scales.radius = (box.lower - pole).cwiseAbs().cwiseMax((box.upper - pole).cwiseAbs()).norm();
  scales.coordinate =
      std::max({box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff(), pole.cwiseAbs().maxCoeff()});
  scales.elements = table.elements.size();
  const SumsEvaluator<Dim> evaluator(pole, scales, SumScope::measure_only, options.tolerance);
  constexpr int low_order = 3;
  const auto body = [&](std::span<const geometry::BezierElement<Dim>> elements) {
    return AdaptiveIntegrator(evaluator, options, 0).apply_rule(pieces_of(table, elements), low_order);
  };
  scales.sums = sum_in_tasks(table, options, {}, body).sum;
  return scales;
}

/// The sums that scale the tolerance differ by a tenth at most.
template <int Dim>
bool similar_size(const ElementSums<Dim>& a, const ElementSums<Dim>& b) {
  using Layout = SumLayout<Dim>;
  const auto similar = [](double x, double y) { return std::abs(x - y) <= 0.1 * std::abs(y); };
  return similar(a[Layout::measure], b[Layout::measure]) && similar(a[Layout::content], b[Layout::content]) &&
         similar(a.template segment<Dim>(Layout::second).sum(), b.template segment<Dim>(Layout::second).sum());
}

/// What rounding may cost: of the sums themselves, and of positions that are known to a relative epsilon. The latter
/// turns each element's tangents by its error over the element's size; over many elements that adds up like a random
/// walk, to the error times the square root of the area (of the number of elements in the plane).
template <int Dim>
ElementSums<Dim> rounding_error(const Scales<Dim>& scales, const AdaptiveTotals<ElementSums<Dim>>& totals) {
  using Layout = SumLayout<Dim>;
  ElementSums<Dim> error = 2.0 * epsilon * totals.magnitude;
  const double position = epsilon * scales.coordinate;
  const double measure = totals.sum[Layout::measure];
  error[Layout::measure] += 4.0 * position * std::sqrt(Dim == 3 ? measure : static_cast<double>(scales.elements));
  for (int k = Layout::content; k < Layout::count; ++k) {
    error[k] += position * measure * std::pow(scales.radius, power_of_distance<Dim>(k) - 1);
  }
  return error;
}

}  // namespace

template <int Dim>
BoundarySums<Dim> boundary_sums(const geometry::ElementTable<Dim>& table, const geometry::Point<Dim>& pole,
                                SumScope scope, const Options& options) {
  using Layout = SumLayout<Dim>;
  Scales<Dim> scales = measure_scales(table, pole, options);
  AdaptiveTotals<ElementSums<Dim>> totals;
  const std::int64_t bisections = bisection_share(options, task_count(table));
  // The first pass may overrate the sums, above all the content of a thin body; then the targets were too wide.
  for (int attempt = 0; attempt < 3; ++attempt) {
    const SumsEvaluator<Dim> evaluator(pole, scales, scope, options.tolerance);
    const auto body = [&](std::span<const geometry::BezierElement<Dim>> elements) {
      return AdaptiveIntegrator(evaluator, options, bisections).integrate(pieces_of(table, elements));
    };
    totals = sum_in_tasks(table, options, options.progress, body);
    const bool scales_were_right = similar_size<Dim>(totals.sum, scales.sums);
    scales.sums = totals.sum;
    const ElementSums<Dim> wanted = SumsEvaluator<Dim>(pole, scales, scope, options.tolerance).target();
    if (options.fixed_points > 0 || scales_were_right || (totals.error <= wanted).all()) break;
  }
  using Element = geometry::BezierElement<Dim>;
  const bool adaptive = options.fixed_points == 0;
  const bool exact = adaptive && std::all_of(table.elements.begin(), table.elements.end(),
                                             [](const Element& element) { return element.polynomial; });
  const bool exact_measure = exact && std::all_of(table.elements.begin(), table.elements.end(),
                                                  [&](const Element& element) { return is_affine(table, element); });
  const ElementSums<Dim> rounding = rounding_error(scales, totals);
  ElementSums<Dim> noise = ElementSums<Dim>::Constant(difference_noise * totals.sum[Layout::measure]);
  for (int k = 0; k < Layout::count; ++k) noise[k] *= std::pow(scales.radius, power_of_distance<Dim>(k));
  return {totals.sum, totals.error + rounding, rounding + noise, totals.evaluations, exact, exact_measure};
}

template BoundarySums<2> boundary_sums(const geometry::ElementTable<2>&, const geometry::Point<2>&, SumScope,
                                       const Options&);
template BoundarySums<3> boundary_sums(const geometry::ElementTable<3>&, const geometry::Point<3>&, SumScope,
                                       const Options&);

}  // namespace isorim::quadrature
