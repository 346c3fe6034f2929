#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/errors.h"
#include "quadrature/element_sums.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/options.h"

/// The one adaptive scheme behind every integral: the order is raised in the directions that need it, then the piece
/// is bisected, until the estimated error meets the piece's allowance.
///
/// A piece is integrated by tensor Gauss-Legendre rules of n, n - 1 and n - 2 points in each direction; the first is
/// the value and its larger difference from the others the estimate (one difference alone can vanish by accident). It
/// is an estimate of the errors of the *lesser* rules, so for integrands that are analytic near the piece it is far
/// above the error of the value. Where more points gain little (a kink, a cusp, a pole nearby) the estimate is enlarged
/// by the sum of the geometric series that the observed gain suggests.
namespace isorim::quadrature {

/// What AdaptiveIntegrator asks of the thing to integrate: K integrals at once over pieces of D-dimensional cells.
template <class E>
concept PieceEvaluator = requires(const E& evaluator, const typename E::Piece& piece,
                                  std::span<const typename E::Piece* const> batch, const Orders<E::directions>& orders,
                                  std::span<typename E::Values> values, typename E::Values& difference) {
  // Bisections that led to the piece, and whether nothing of it is to be integrated.
  { piece.depth } -> std::convertible_to<int>;
  { piece.empty() } -> std::same_as<bool>;
  // Orders at which the error is expected to meet the allowance.
  { evaluator.start_orders(piece) } -> std::same_as<Orders<E::directions>>;
  // Two pieces may stand in one batch.
  { evaluator.same_kind(piece, piece) } -> std::same_as<bool>;
  { E::batch_size } -> std::convertible_to<int>;
  evaluator.evaluate(batch, orders, values);
  // Points of the rule of those orders.
  { evaluator.points(piece, orders) } -> std::same_as<std::int64_t>;
  // The two halves in a direction.
  { evaluator.split(piece, 0) } -> std::same_as<std::pair<typename E::Piece, typename E::Piece>>;
  // The absolute error, above zero, that each of the K integrals may have on a piece where they have that value.
  { evaluator.allowance(piece, difference) } -> std::same_as<typename E::Values>;
  // Sums of absolute values behind the integrals of a piece: what their rounding is relative to.
  { evaluator.magnitude(piece, difference) } -> std::same_as<typename E::Values>;
  // Sets the differences of what the rule integrates exactly to zero.
  evaluator.clear_exact(piece, orders, difference);
};

/// Sums over pieces, in the order in which they were finished.
template <class Values>
struct AdaptiveTotals {
  Values sum = Values::Zero();
  /// Estimated error of the sum, without rounding.
  Values error = Values::Zero();
  /// What rounding is relative to: see PieceEvaluator.
  Values magnitude = Values::Zero();
  /// Points at which the integrand was evaluated.
  std::int64_t evaluations = 0;
  /// Pieces given up at the greatest depth or after the most bisections.
  std::int64_t unfinished = 0;

  void add(const Values& value, const Values& estimate, const Values& size) {
    sum += value;
    error += estimate;
    magnitude += size;
  }
  void add(const AdaptiveTotals& other) {
    sum += other.sum;
    error += other.error;
    magnitude += other.magnitude;
    evaluations += other.evaluations;
    unfinished += other.unfinished;
  }
};

/// Orders above this gain less than a bisection does.
inline constexpr int largest_adaptive_order = 24;

/// The share of Options::max_bisections that one of several tasks may use.
inline std::int64_t bisection_share(const Options& options, std::size_t tasks) {
  constexpr std::int64_t least = 100;
  return std::max<std::int64_t>(least,
                                options.max_bisections / std::max<std::int64_t>(1, static_cast<std::int64_t>(tasks)));
}

template <PieceEvaluator Evaluator>
class AdaptiveIntegrator {
 public:
  using Piece = typename Evaluator::Piece;
  using Values = typename Evaluator::Values;
  static constexpr int directions = Evaluator::directions;

  /// Evaluator and options outlive the integrator, which bisects at most `bisections` times. options.fixed_points > 0:
  /// that rule alone, the estimate from rules with one and two more points. Throws InputError if options.fixed_points
  /// is out of its range.
  AdaptiveIntegrator(const Evaluator& evaluator, const Options& options, std::int64_t bisections)
      : evaluator_(evaluator), options_(options), bisections_left_(bisections) {
    if (options.fixed_points >= 0 && options.fixed_points <= max_fixed_points) return;
    throw InputError("found fixed_points = " + std::to_string(options.fixed_points) + "; expected 0 to " +
                     std::to_string(max_fixed_points));
  }

  /// One rule of `points` points in each direction over all pieces; no estimate of the error.
  AdaptiveTotals<Values> apply_rule(std::vector<Piece> pieces, int points) {
    totals_ = {};
    work_ = std::move(pieces);
    std::reverse(work_.begin(), work_.end());
    Orders<directions> orders;
    orders.fill(points);
    std::array<Values, lanes> values;
    while (!work_.empty()) {
      const std::vector<Piece> batch = take_batch([](const Piece&) { return true; });
      evaluate_batch(batch, orders, values);
      for (std::size_t i = 0; i < batch.size(); ++i) add(batch[i], values[i], Values::Zero());
    }
    return totals_;
  }

  /// Integrates over all pieces; the same pieces in the same order give the same bits.
  AdaptiveTotals<Values> integrate(std::vector<Piece> pieces) {
    totals_ = {};
    work_ = std::move(pieces);
    std::reverse(work_.begin(), work_.end());
    while (!work_.empty()) next_batch();
    return totals_;
  }

 private:
  static constexpr std::size_t lanes = Evaluator::batch_size;

  /// A piece with the value and estimate of the latest rule.
  struct State {
    Piece piece;
    Orders<directions> orders;
    Values value;
    Values difference;
  };

  static Orders<directions> shifted(Orders<directions> orders, int shift) {
    for (int& order : orders) order = std::max(1, order + shift);
    return orders;
  }

  Orders<directions> orders_for(const Piece& piece) const {
    if (options_.fixed_points == 0) return evaluator_.start_orders(piece);
    Orders<directions> orders;
    orders.fill(options_.fixed_points);
    return orders;
  }

  void add(const Piece& piece, const Values& value, const Values& estimate) {
    totals_.add(value, estimate, evaluator_.magnitude(piece, value));
  }

  void evaluate(std::span<const Piece* const> batch, const Orders<directions>& orders, std::span<Values> values) {
    for (const Piece* piece : batch) totals_.evaluations += evaluator_.points(*piece, orders);
    evaluator_.evaluate(batch, orders, values);
  }

  Values evaluate(const Piece& piece, const Orders<directions>& orders) {
    const Piece* pointer = &piece;
    Values value;
    evaluate({&pointer, 1}, orders, {&value, 1});
    return value;
  }

  /// Takes the top piece off the stack, and those below it that are of its kind and fit, as many as there are lanes.
  template <class Fits>
  std::vector<Piece> take_batch(Fits fits) {
    std::vector<Piece> batch;
    batch.reserve(lanes);
    do {
      batch.push_back(std::move(work_.back()));
      work_.pop_back();
    } while (batch.size() < lanes && !work_.empty() && evaluator_.same_kind(batch.front(), work_.back()) &&
             fits(work_.back()));
    return batch;
  }

  void evaluate_batch(const std::vector<Piece>& batch, const Orders<directions>& orders, std::span<Values> values) {
    std::array<const Piece*, lanes> pointers{};
    for (std::size_t i = 0; i < batch.size(); ++i) pointers[i] = &batch[i];
    evaluate({pointers.data(), batch.size()}, orders, values.first(batch.size()));
  }

  void next_batch() {
    const Orders<directions> orders = orders_for(work_.back());
    std::vector<Piece> batch = take_batch([&](const Piece& piece) { return orders_for(piece) == orders; });
    std::array<Values, lanes> values;
    std::array<Values, lanes> near;
    std::array<Values, lanes> far;
    const bool fixed = options_.fixed_points > 0;
    evaluate_batch(batch, orders, values);
    evaluate_batch(batch, shifted(orders, fixed ? 1 : -1), near);
    evaluate_batch(batch, shifted(orders, fixed ? 2 : -2), far);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      near[i] = (values[i] - near[i]).abs();
      far[i] = (values[i] - far[i]).abs();
      Values difference =
          fixed ? Values(far[i].max(near[i])) : estimate(far[i], near[i], evaluator_.noise(batch[i], values[i]));
      evaluator_.clear_exact(batch[i], orders, difference);
      State state{std::move(batch[i]), orders, values[i], difference};
      if (fixed || excess(state, state.difference) <= 1.0) {
        add(state.piece, state.value, state.difference);
      } else {
        refine(std::move(state));
      }
    }
  }

  /// The largest ratio of an estimate to its allowance.
  double excess(const State& state, const Values& difference) const {
    return (difference / evaluator_.allowance(state.piece, state.value)).maxCoeff();
  }

  /// A value differs by `far` from that of a rule and by `near` from that of a better one. Where the better rule gains
  /// little, what is still missing is the geometric series that this gain suggests, as a factor of the difference.
  static Values slowness(const Values& far, const Values& near, const Values& noise) {
    Values factor = Values::Ones();
    for (Eigen::Index k = 0; k < factor.size(); ++k) {
      if (std::max(near[k], far[k]) <= noise[k]) continue;
      const double gain = near[k] < 0.9 * far[k] ? near[k] / far[k] : 0.9;
      factor[k] = std::max(1.0, gain / (1.0 - gain));
    }
    return factor;
  }

  static Values estimate(const Values& far, const Values& near, const Values& noise) {
    return far.max(near) * slowness(far, near, noise);
  }

  /// Raises the order where the error comes from while that helps; bisects otherwise.
  void refine(State state) {
    while (true) {
      const std::array<Values, directions> from = directional_differences(state);
      Values together = Values::Zero();
      for (const Values& difference : from) together += difference;
      if (excess(state, together) <= 1.0) return add(state.piece, state.value, together);
      std::array<double, directions> excesses;
      for (std::size_t d = 0; d < directions; ++d) excesses[d] = excess(state, from[d]);
      const double worst = *std::max_element(excesses.begin(), excesses.end());
      Orders<directions> raised = state.orders;
      // The directions left alone keep the error that they have been seen to cause.
      Values kept = Values::Zero();
      Values before = Values::Zero();
      for (std::size_t d = 0; d < directions; ++d) {
        const bool raise = excesses[d] > 0.1 * worst && raised[d] < largest_adaptive_order;
        if (raise) raised[d] = std::min(raised[d] + 4, largest_adaptive_order);
        (raise ? before : kept) += from[d];
      }
      if (raised != state.orders) {
        const Values value = evaluate(state.piece, raised);
        Values difference = (value - state.value).abs();
        evaluator_.clear_exact(state.piece, raised, difference);
        difference = kept + difference * slowness(before, difference, evaluator_.noise(state.piece, value));
        state = {std::move(state.piece), raised, value, difference};
        const double after = excess(state, state.difference);
        if (after <= 1.0) return add(state.piece, state.value, state.difference);
        if (after < 0.03 * worst) continue;
      }
      return bisect(state, excesses);
    }
  }

  /// The estimate of what each direction alone causes: the order lowered by one and two there.
  std::array<Values, directions> directional_differences(const State& state) {
    const Values noise = evaluator_.noise(state.piece, state.value);
    const auto difference = [&](std::size_t direction, int shift) -> Values {
      Orders<directions> lowered = state.orders;
      lowered[direction] = std::max(1, lowered[direction] + shift);
      return (evaluate(state.piece, lowered) - state.value).abs();
    };
    std::array<Values, directions> from;
    for (std::size_t d = 0; d < directions; ++d) {
      from[d] = estimate(difference(d, -2), difference(d, -1), noise);
      evaluator_.clear_exact(state.piece, state.orders, from[d]);
    }
    return from;
  }

  void bisect(const State& state, const std::array<double, directions>& excesses) {
    if (state.piece.depth >= options_.max_depth || --bisections_left_ < 0) {
      ++totals_.unfinished;
      return add(state.piece, state.value, state.difference);
    }
    const auto direction = static_cast<int>(std::max_element(excesses.begin(), excesses.end()) - excesses.begin());
    std::pair<Piece, Piece> halves = evaluator_.split(state.piece, direction);
    if (!halves.second.empty()) work_.push_back(std::move(halves.second));
    if (!halves.first.empty()) work_.push_back(std::move(halves.first));
  }

  const Evaluator& evaluator_;
  const Options& options_;
  std::int64_t bisections_left_;
  std::vector<Piece> work_;
  AdaptiveTotals<Values> totals_;
};

}  // namespace isorim::quadrature
