#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "quadrature/adaptive.h"
#include "quadrature/element_piece.h"
#include "quadrature/parallel.h"
#include "quadrature/piece_samples.h"
#include "solver/bem/divided_table.h"
#include "solver/bem/domain_load.h"
#include "solver/bem/peak_targets.h"

namespace isorim::solver {

namespace {

using quadrature::NodeView;
using quadrature::Orders;
using quadrature::Target;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Which integrals: potentials, or these and their derivatives.
enum class Part { potential, jet };

/// All integrals of a target: components of the potential, then of the derivatives.
template <int Dim>
using Values = Eigen::Array<double, Dim*(Dim + 1), 1>;

/// One thread's loads.
template <int Dim>
class LoadSums {
 public:
  LoadSums(const Loads<Dim>& loads, Part part) : part_(part) {
    for (const auto& load : loads) {
      integrands_.push_back(load->integrand());
      components_ = load->components();
    }
  }

  int rows() const { return components_ * (part_ == Part::jet ? Dim + 1 : 1); }

  /// Adds sum_q weight_q f(node q) over the nodes.
  void add(const geometry::Point<Dim>& target, const NodeView<Dim>& nodes, Values<Dim>& sum) {
    const Eigen::Map<const Eigen::VectorXd> weights(nodes.weight.data(), static_cast<Eigen::Index>(nodes.size()));
    for (const auto& integrand : integrands_) {
      values_.resize(components_, weights.size());
      integrand->potential(target, nodes, values_);
      sum.head(components_) += (values_ * weights).array();
      if (part_ == Part::potential) continue;
      values_.resize(Dim * components_, weights.size());
      integrand->gradient(target, nodes, values_);
      sum.segment(components_, Dim * components_) += (values_ * weights).array();
    }
  }

  void add_uniform(const geometry::Point<Dim>& target, const NodeView<Dim>& nodes, Eigen::Ref<Eigen::VectorXd> sum) {
    const Eigen::Map<const Eigen::VectorXd> weights(nodes.weight.data(), static_cast<Eigen::Index>(nodes.size()));
    for (const auto& integrand : integrands_) {
      values_.resize(components_, weights.size());
      integrand->uniform_potential(target, nodes, values_);
      sum += values_ * weights;
    }
  }

  double uniform_stress(const geometry::Point<Dim>& point) {
    double sum = 0.0;
    for (const auto& integrand : integrands_) sum += integrand->uniform_stress(point);
    return sum;
  }

 private:
  Part part_;
  int components_ = 1;
  std::vector<std::unique_ptr<LoadIntegrand<Dim>>> integrands_;
  Eigen::MatrixXd values_;
};

/// The nodes of a rule on a piece, as kernels want them.
template <int Dim>
class PieceNodes {
 public:
  const NodeView<Dim>& sample(const quadrature::ElementPiece<Dim>& piece, const Orders<Dim - 1>& orders) {
    quadrature::sample_piece<Dim>(piece, orders, samples_);
    const std::size_t count = samples_.weights.size();
    for (std::size_t i = 0; i < Dim; ++i) {
      position_[i].resize(count);
      normal_[i].resize(count);
    }
    weight_.resize(count);
    for (std::size_t q = 0; q < count; ++q) {
      const auto column = static_cast<Eigen::Index>(q);
      const double measure = samples_.normals.col(column).norm();
      weight_[q] = samples_.weights[q] * measure;
      for (std::size_t i = 0; i < Dim; ++i) {
        position_[i][q] = samples_.points(static_cast<Eigen::Index>(i), column);
        normal_[i][q] = measure > 0.0 ? samples_.normals(static_cast<Eigen::Index>(i), column) / measure : 0.0;
      }
    }
    for (std::size_t i = 0; i < Dim; ++i) {
      view_.position[i] = position_[i];
      view_.normal[i] = normal_[i];
    }
    view_.weight = weight_;
    return view_;
  }

 private:
  quadrature::PieceSamples<Dim> samples_;
  std::array<std::vector<double>, Dim> position_;
  std::array<std::vector<double>, Dim> normal_;
  std::vector<double> weight_;
  NodeView<Dim> view_;
};

/// The integrals of one target over pieces, for AdaptiveIntegrator.
template <int Dim>
class LoadEvaluator {
 public:
  using Piece = quadrature::ElementPiece<Dim>;
  using Values = solver::Values<Dim>;
  static constexpr int directions = Dim - 1;
  static constexpr int batch_size = 1;

  /// `allowed`: absolute errors of each integral over the whole boundary of so many pieces.
  LoadEvaluator(LoadSums<Dim>& loads, const geometry::Point<Dim>& target, Values allowed, std::size_t pieces)
      : loads_(loads), target_(target), allowed_(std::move(allowed)), share_(1.0 / static_cast<double>(pieces)) {}

  Orders<directions> start_orders(const Piece& piece) const {
    constexpr int least = 6;
    constexpr int most = 10;
    Orders<directions> orders = quadrature::expected_orders<Dim>(piece, 1e-6);
    for (int& order : orders) order = std::clamp(order, least, most);
    return orders;
  }
  bool same_kind(const Piece&, const Piece&) const { return false; }

  void evaluate(std::span<const Piece* const> pieces, const Orders<directions>& orders,
                std::span<Values> values) const {
    values.front().setZero();
    loads_.add(target_, nodes_.sample(*pieces.front(), orders), values.front());
  }
  std::int64_t points(const Piece& piece, const Orders<directions>& orders) const {
    return quadrature::points_of_rule(piece, orders);
  }
  std::pair<Piece, Piece> split(const Piece& piece, int direction) const {
    return quadrature::bisect(piece, direction);
  }

  Values allowance(const Piece& piece, const Values& value) const {
    return noise(piece, value).max(allowed_ * std::ldexp(share_, -piece.depth));
  }
  /// What the tolerance is relative to is at least a thousand times as large as what is allowed.
  Values noise(const Piece&, const Values& value) const {
    return (4.0 * epsilon * value.abs()).max(1e-5 * share_ * allowed_).max(std::numeric_limits<double>::min());
  }
  Values magnitude(const Piece&, const Values& value) const { return value.abs(); }
  template <class AnyOrders>
  void clear_exact(const Piece&, const AnyOrders&, Values&) const {}

 private:
  LoadSums<Dim>& loads_;
  geometry::Point<Dim> target_;
  Values allowed_;
  double share_;
  mutable PieceNodes<Dim> nodes_;
};

/// All elements as pieces, none much longer than `length`.
template <int Dim>
std::vector<quadrature::ElementPiece<Dim>> pieces_up_to(const geometry::ElementTable<Dim>& table, double length) {
  std::vector<quadrature::ElementPiece<Dim>> work;
  std::vector<quadrature::ElementPiece<Dim>> pieces;
  for (auto element = table.elements.rbegin(); element != table.elements.rend(); ++element)
    work.push_back(quadrature::whole_element(table, *element));
  while (!work.empty()) {
    quadrature::ElementPiece<Dim> piece = std::move(work.back());
    work.pop_back();
    if (piece.empty()) continue;
    const Eigen::Map<const geometry::HomogeneousPoints<Dim>> net(piece.net(), Dim + 1,
                                                                 piece.element->control_point_count());
    int direction = 0;
    while (direction < Dim - 1 && extent<Dim>(net, *piece.element, direction) <= length) ++direction;
    if (direction == Dim - 1) {
      pieces.push_back(std::move(piece));
      continue;
    }
    auto [first, second] = quadrature::bisect(piece, direction);
    work.push_back(std::move(second));
    work.push_back(std::move(first));
  }
  // Depth counts the bisections that the integration itself makes.
  for (auto& piece : pieces) piece.depth = 0;
  return pieces;
}

/// Integrals over the boundary at many targets.
template <int Dim>
class LoadIntegrals {
 public:
  LoadIntegrals(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                const quadrature::TargetRules<Dim>& rules, std::span<const Target<Dim>> targets, Part part,
                const LoadOptions& options, const CoarseTable<Dim>* coarse)
      : loads_(loads),
        table_(table),
        rules_(rules),
        targets_(targets),
        part_(part),
        options_(options),
        coarse_(coarse) {
    const auto threads = static_cast<std::size_t>(quadrature::thread_count(options.threads));
    for (std::size_t i = 0; i < threads; ++i) {
      sums_.push_back(std::make_unique<LoadSums<Dim>>(loads, part));
      buffers_.push_back(std::make_unique<quadrature::NodeBuffer<Dim>>());
    }
  }

  int rows() const { return sums_.front()->rows(); }
  LoadSums<Dim>& sums(int thread) { return *sums_[static_cast<std::size_t>(thread)]; }

  /// rows() x targets.
  Eigen::MatrixXd run() {
    const Choice choice = choose();
    Eigen::MatrixXd result(rows(), static_cast<Eigen::Index>(targets_.size()));
    quadrature::parallel_for(targets_.size(), options_.threads, [&](std::size_t i, int thread) {
      result.col(static_cast<Eigen::Index>(i)) = value(choice, targets_[i], thread).head(rows()).matrix();
    });
    return result;
  }

  /// What a uniform rise by the temperature at each target adds: components x targets.
  void add_uniform(Eigen::Ref<Eigen::MatrixXd> result) {
    quadrature::parallel_for(targets_.size(), options_.threads, [&](std::size_t i, int thread) {
      for (std::size_t e = 0; e < table_.elements.size(); ++e) {
        const NodeView<Dim> nodes = rules_.nodes(static_cast<int>(e), targets_[i], buffer(thread));
        sums(thread).add_uniform(targets_[i].position, nodes, result.col(static_cast<Eigen::Index>(i)));
      }
    });
  }

 private:
  static constexpr std::size_t most_samples = 6;

  /// How the integrals are taken: by rules on a table, or, without rules, adaptively on pieces.
  struct Choice {
    const quadrature::TargetRules<Dim>* rules = nullptr;
    std::size_t elements = 0;
    std::shared_ptr<const DividedTable<Dim>> divided;
    /// Null if there are none.
    std::shared_ptr<const PeakTargets<Dim>> peaks;
    std::shared_ptr<const quadrature::TargetRules<Dim>> own_rules;
    std::vector<quadrature::ElementPiece<Dim>> pieces;
    Values<Dim> allowed = Values<Dim>::Zero();
  };

  quadrature::NodeBuffer<Dim>& buffer(int thread) { return *buffers_[static_cast<std::size_t>(thread)]; }

  Values<Dim> value(const Choice& choice, const Target<Dim>& target, int thread) {
    if (!choice.rules) return adaptive(choice, target, thread);
    const Target<Dim> on_whole = coarse_ ? coarse_->target(target) : target;
    const Target<Dim> own_target = choice.divided ? choice.divided->target(on_whole) : on_whole;
    Values<Dim> sum = Values<Dim>::Zero();
    for (std::size_t e = 0; e < choice.elements; ++e) {
      const auto element = static_cast<int>(e);
      const Target<Dim> hardest = choice.peaks ? choice.peaks->on(element, own_target) : own_target;
      NodeView<Dim> nodes = choice.rules->nodes(element, hardest, buffer(thread));
      // Offsets are those from the target that the rule is made for.
      if (hardest.position != target.position) nodes.offset = {};
      sums(thread).add(target.position, nodes, sum);
    }
    return sum;
  }

  Values<Dim> adaptive(const Choice& choice, const Target<Dim>& target, int thread) {
    constexpr std::int64_t bisections = 20000;
    const LoadEvaluator<Dim> evaluator(sums(thread), target.position, choice.allowed, choice.pieces.size());
    const quadrature::Options options;
    quadrature::AdaptiveIntegrator<LoadEvaluator<Dim>> integrator(evaluator, options, bisections);
    return integrator.integrate(choice.pieces).sum;
  }

  std::vector<Values<Dim>> at_samples(const Choice& choice) {
    const std::size_t count = std::min(most_samples, targets_.size());
    std::vector<Values<Dim>> values(count);
    quadrature::parallel_for(count, options_.threads, [&](std::size_t i, int thread) {
      values[i] = value(choice, targets_[i * targets_.size() / count], thread);
    });
    return values;
  }

  /// The allowed errors: the tolerance times the largest potential, and likewise for all derivatives together.
  Values<Dim> allowance(const std::vector<Values<Dim>>& values) const {
    const int components = rows() / (part_ == Part::jet ? Dim + 1 : 1);
    double largest_potential = 0.0;
    double largest_derivative = 0.0;
    for (const Values<Dim>& value : values) {
      largest_potential = std::max(largest_potential, value.head(components).abs().maxCoeff());
      largest_derivative = std::max(largest_derivative, value.tail(value.size() - components).abs().maxCoeff());
    }
    Values<Dim> allowed = Values<Dim>::Constant(largest_derivative);
    allowed.head(components).setConstant(largest_potential);
    return (options_.tolerance * allowed).max(std::numeric_limits<double>::min());
  }

  Choice rules_of_degree(int degree, const std::shared_ptr<const DividedTable<Dim>>& divided,
                         const std::shared_ptr<const PeakTargets<Dim>>& peaks) const {
    const geometry::ElementTable<Dim>& table = divided ? divided->table() : whole_table();
    const typename quadrature::TargetRules<Dim>::Options options{0.1 * options_.tolerance, degree};
    auto rules = std::make_shared<const quadrature::TargetRules<Dim>>(table, options);
    return {rules.get(), table.elements.size(), divided, peaks, rules, {}, Values<Dim>::Zero()};
  }

  const geometry::ElementTable<Dim>& whole_table() const { return coarse_ ? coarse_->table() : table_; }

  /// A part of the domain's size that elements do not exceed if there are peaks: most have one hard place at the most.
  static constexpr double part_with_peaks = 1.0 / 6.0;

  /// Rules of rising order until two agree at the samples; the lesser is chosen. No rules, if none do.
  Choice choose() {
    double length = std::numeric_limits<double>::infinity();
    std::vector<RayPeak<Dim>> places;
    for (const auto& load : loads_) {
      length = std::min(length, load->resolution_length());
      for (const RayPeak<Dim>& peak : load->peaks()) places.push_back(peak);
    }
    if (!places.empty()) length = std::min(length, part_with_peaks * geometry::bounding_box(table_).diagonal());
    std::shared_ptr<const DividedTable<Dim>> divided;
    std::shared_ptr<const PeakTargets<Dim>> peaks;
    Choice choice{&rules_, table_.elements.size(), nullptr, nullptr, nullptr, {}, Values<Dim>::Zero()};
    std::vector<int> degrees{8, 14, 20};
    if (std::isfinite(length)) {
      divided = std::make_shared<const DividedTable<Dim>>(whole_table(), length);
      if (!places.empty()) peaks = std::make_shared<const PeakTargets<Dim>>(divided->table(), std::move(places));
    }
    if (coarse_ || divided) {
      choice = rules_of_degree(8, divided, peaks);
      degrees = {14, 20, 26};
    }
    std::vector<Values<Dim>> found = at_samples(choice);
    for (const int degree : degrees) {
      Choice next = rules_of_degree(degree, divided, peaks);
      const std::vector<Values<Dim>> better = at_samples(next);
      const Values<Dim> allowed = allowance(better);
      bool agree = true;
      for (std::size_t i = 0; i < found.size(); ++i) agree = agree && ((found[i] - better[i]).abs() <= allowed).all();
      if (agree) return choice;
      choice = std::move(next);
      found = better;
    }
    choice = {};
    choice.pieces = pieces_up_to(table_, length);
    choice.allowed = allowance(found);
    return choice;
  }

  const Loads<Dim>& loads_;
  const geometry::ElementTable<Dim>& table_;
  const quadrature::TargetRules<Dim>& rules_;
  std::span<const Target<Dim>> targets_;
  Part part_;
  LoadOptions options_;
  /// Null if there is none.
  const CoarseTable<Dim>* coarse_;
  std::vector<std::unique_ptr<LoadSums<Dim>>> sums_;
  std::vector<std::unique_ptr<quadrature::NodeBuffer<Dim>>> buffers_;
};

}  // namespace

template <int Dim>
Eigen::MatrixXd domain_potentials(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                                  const quadrature::TargetRules<Dim>& rules, std::span<const Target<Dim>> targets,
                                  const LoadOptions& options, const CoarseTable<Dim>* coarse) {
  if (loads.empty() || targets.empty())
    return Eigen::MatrixXd::Zero(loads.empty() ? 0 : loads.front()->components(), Eigen::Index(targets.size()));
  LoadIntegrals<Dim> integrals(loads, table, rules, targets, Part::potential, options, coarse);
  Eigen::MatrixXd result = integrals.run();
  const bool thermal = std::any_of(loads.begin(), loads.end(), [](const auto& load) { return load->is_thermal(); });
  if (thermal) integrals.add_uniform(result);
  return result;
}

template <int Dim>
DomainJets domain_jets(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                       const quadrature::TargetRules<Dim>& rules, std::span<const Target<Dim>> targets,
                       const LoadOptions& options, const CoarseTable<Dim>* coarse) {
  const auto count = static_cast<Eigen::Index>(targets.size());
  if (loads.empty() || targets.empty())
    return {Eigen::MatrixXd(0, count), Eigen::MatrixXd(0, count), Eigen::VectorXd::Zero(count)};
  LoadIntegrals<Dim> integrals(loads, table, rules, targets, Part::jet, options, coarse);
  const Eigen::MatrixXd both = integrals.run();
  const Eigen::Index components = loads.front()->components();
  DomainJets jets{both.topRows(components), both.bottomRows(Dim * components), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i)
    jets.uniform_stress[i] = integrals.sums(0).uniform_stress(targets[static_cast<std::size_t>(i)].position);
  return jets;
}

template Eigen::MatrixXd domain_potentials(const Loads<2>&, const geometry::ElementTable<2>&,
                                           const quadrature::TargetRules<2>&, std::span<const Target<2>>,
                                           const LoadOptions&, const CoarseTable<2>*);
template Eigen::MatrixXd domain_potentials(const Loads<3>&, const geometry::ElementTable<3>&,
                                           const quadrature::TargetRules<3>&, std::span<const Target<3>>,
                                           const LoadOptions&, const CoarseTable<3>*);
template DomainJets domain_jets(const Loads<2>&, const geometry::ElementTable<2>&, const quadrature::TargetRules<2>&,
                                std::span<const Target<2>>, const LoadOptions&, const CoarseTable<2>*);
template DomainJets domain_jets(const Loads<3>&, const geometry::ElementTable<3>&, const quadrature::TargetRules<3>&,
                                std::span<const Target<3>>, const LoadOptions&, const CoarseTable<3>*);

}  // namespace isorim::solver
