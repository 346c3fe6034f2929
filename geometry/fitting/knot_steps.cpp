#include "geometry/fitting/knot_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "geometry/fitting/bordered_cholesky.h"
#include "geometry/fitting/derivative_row.h"
#include "geometry/fitting/gauss_points.h"
#include "geometry/fitting/span_jet.h"
#include "geometry/fitting/span_order.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

namespace {

/// Two or more Gauss points integrate |C^(r)|^2 exactly, r >= 2, up to degree 5; more are not needed for a direction.
constexpr int most_gauss_points = 4;

/// A residual of Dim components, and how it changes.
template <int Dim, int Degree>
struct Residual {
  SpanJet<Dim, Degree> jet;
  /// The square root of the weight; value, basis and moves of the jet are to be multiplied by it.
  double factor = 1.0;
  /// Unit tangent and length of the derivative with respect to the parameter; 0 where there is none to eliminate.
  Vector<Dim> tangent = Vector<Dim>::Zero();
  double speed = 0.0;
};

/// The normal equations of one step. Unknown block i: the change of control point i and of knot i + shift, the latter
/// in units of the distance to the nearer neighbour.
template <int Dim, int Degree>
class StepSystem {
 public:
  StepSystem(const FitFrame<Dim>& frame, const FitState<Dim>& state)
      : frame_(frame),
        state_(state),
        fairness_(state.fairness),
        space_(frame.space(state.breakpoints)),
        sorted_(space_.knots, state.parameters),
        p_(Degree > 0 ? Degree : frame.degree()),
        shift_(p_ / 2 + 1),
        blocks_(frame.is_periodic() ? space_.unknowns() : space_.knots.basis_count()),
        columns_((p_ + 1) * Dim + 2 * p_),
        gauss_(gauss_points(std::clamp(p_ - fairness_.derivative + 1, 1, most_gauss_points))) {
    if (!(fairness_.mu > 0.0) || fairness_.derivative > p_) gauss_.clear();
    mark_what_moves();
    data_.resize(state.parameters.size());
    for (int span = p_; span < space_.knots.basis_count(); ++span)
      if (space_.knots[span] < space_.knots[span + 1]) add_span(span);
  }

  /// Moves breakpoints and parameters. Returns by how much the linearised sum falls; 0 if the system is singular.
  double step(double damping, FitState<Dim>& next) const;

 private:
  static constexpr std::size_t most = static_cast<std::size_t>(SpanJet<Dim, Degree>::most);
  using Jet = SpanJet<Dim, Degree>;
  /// Rows of one residual: control points (Dim columns each), then knots.
  static constexpr std::size_t most_columns = (most + 1) * Dim + 2 * most;
  using Row = std::array<double, most_columns>;
  /// Unknowns of the columns of one span; -1 for what does not move.
  using Unknowns = std::array<int, most_columns>;
  /// The normal equations of one span.
  struct Local {
    std::vector<double> products;
    Row slope;
  };

  int size() const { return blocks_ * (Dim + 1); }
  bool is_free(int j) const { return free_[static_cast<std::size_t>(j)] != 0; }
  int unknown_of(int breakpoint) const { return ((breakpoint + p_ - shift_ + blocks_) % blocks_) * (Dim + 1) + Dim; }
  /// The breakpoint that knot k is, or is a periodic image of.
  int breakpoint_of(int k) const {
    const int spans = static_cast<int>(state_.breakpoints.size()) - 1;
    if (frame_.is_periodic()) return ((k - p_) % spans + spans) % spans;
    return std::clamp(k - p_, 0, spans);
  }
  double gap(int j) const {
    const std::vector<double>& b = state_.breakpoints;
    const std::size_t i = static_cast<std::size_t>(j);
    return std::min(b[i + 1] - b[i], b[i] - b[i - 1]);
  }

  void mark_what_moves() {
    free_.assign(state_.breakpoints.size(), 0);
    gaps_.assign(static_cast<std::size_t>(blocks_), 0.0);
    for (std::size_t j = 1; j + 1 < free_.size(); ++j) {
      if (!frame_.moves_knots() || !frame_.is_free_knot(state_.breakpoints[j])) continue;
      free_[j] = 1;
      gaps_[static_cast<std::size_t>(unknown_of(static_cast<int>(j)) / (Dim + 1))] = gap(static_cast<int>(j));
    }
    fixed_.assign(static_cast<std::size_t>(space_.knots.basis_count()), 0);
    for (const auto& constraint : frame_.constraints(space_.knots).fixed)
      fixed_[static_cast<std::size_t>(constraint.function)] = 1;
  }
  bool is_fixed(int function) const { return fixed_[static_cast<std::size_t>(function)] != 0; }
  void add_span(int span);
  Residual<Dim, Degree> fairness_residual(int span, const Vector<Dim>* control, const GaussPoint& point) const;
  Unknowns unknowns(int span) const;
  void add_residual(const Residual<Dim, Degree>& residual, double damping, Local& local) const;
  void assemble(double damping, BorderedCholesky& matrix, Eigen::VectorXd& gradient) const;
  double parameter_step(int span, const Residual<Dim, Degree>& residual, double damping,
                        const Eigen::VectorXd& solution, const Unknowns& unknowns) const;

  const FitFrame<Dim>& frame_;
  const FitState<Dim>& state_;
  const Fairness& fairness_;
  FitSpace space_;
  SpanOrder sorted_;
  int p_;
  int shift_;
  int blocks_;
  int columns_;
  std::vector<GaussPoint> gauss_;
  /// By breakpoint: whether it moves.
  std::vector<char> free_;
  /// By control point: whether it is held.
  std::vector<char> fixed_;
  /// By block: the distance of its knot to the nearer neighbour.
  std::vector<double> gaps_;
  /// By datum; and by non-empty span and Gauss point.
  std::vector<Residual<Dim, Degree>> data_;
  std::vector<Residual<Dim, Degree>> fair_;
};

template <int Dim, int Degree>
void StepSystem<Dim, Degree>::add_span(int span) {
  std::array<Vector<Dim>, most + 1> control;
  for (int j = 0; j <= p_; ++j) control[static_cast<std::size_t>(j)] = state_.control.col(span - p_ + j);
  const double* around = &space_.knots.knots()[static_cast<std::size_t>(span - p_ + 1)];
  const FitData<Dim>& data = frame_.prepared().data;
  for (const int member : sorted_.of(span - p_)) {
    const std::size_t i = static_cast<std::size_t>(member);
    Residual<Dim, Degree>& residual = data_[i];
    fill_span_jet(p_, 0, control.data(), around, state_.parameters[i], residual.jet);
    residual.jet.value -= data.points.col(member);
    residual.factor = std::sqrt(data.weights[i] / static_cast<double>(data.size()));
    residual.speed = residual.jet.du.norm();
    if (residual.speed > 0.0) residual.tangent = residual.jet.du / residual.speed;
  }
  for (const GaussPoint& point : gauss_) fair_.push_back(fairness_residual(span, control.data(), point));
}

/// Gauss points and lengths move with the ends of the span, knots p - 1 and p of those around it.
template <int Dim, int Degree>
Residual<Dim, Degree> StepSystem<Dim, Degree>::fairness_residual(int span, const Vector<Dim>* control,
                                                                 const GaussPoint& point) const {
  const KnotVector& knots = space_.knots;
  const double start = knots[span];
  const double length = knots[span + 1] - start;
  const double* around = &knots.knots()[static_cast<std::size_t>(span - p_ + 1)];
  Residual<Dim, Degree> residual;
  fill_span_jet(p_, fairness_.derivative, control, around, start + point.node * length, residual.jet);
  const double mu =
      fairness_.mu * (fairness_.factors.empty() ? 1.0 : fairness_.factors[static_cast<std::size_t>(span - p_)]);
  residual.factor = std::sqrt(mu * point.weight * length);
  const Vector<Dim> stretch = 0.5 / length * residual.jet.value;
  residual.jet.moves[static_cast<std::size_t>(p_ - 1)] += (1.0 - point.node) * residual.jet.du - stretch;
  residual.jet.moves[static_cast<std::size_t>(p_)] += point.node * residual.jet.du + stretch;
  return residual;
}

template <int Dim, int Degree>
typename StepSystem<Dim, Degree>::Unknowns StepSystem<Dim, Degree>::unknowns(int span) const {
  Unknowns result;
  result.fill(-1);
  for (int j = 0; j <= p_; ++j) {
    const int function = span - p_ + j;
    if (is_fixed(function)) continue;
    for (int d = 0; d < Dim; ++d) result[static_cast<std::size_t>(j * Dim + d)] = (function % blocks_) * (Dim + 1) + d;
  }
  for (int k = 0; k < 2 * p_; ++k) {
    const int j = breakpoint_of(span - p_ + 1 + k);
    if (is_free(j)) result[static_cast<std::size_t>((p_ + 1) * Dim + k)] = unknown_of(j);
  }
  return result;
}

/// Adds the products of the residual's row, its part along the curve taken out: with r the residual and T the unit
/// tangent, W = I - T T' / (1 + damping) is what eliminating the parameter leaves, and M'M = W.
template <int Dim, int Degree>
void StepSystem<Dim, Degree>::add_residual(const Residual<Dim, Degree>& residual, double damping, Local& local) const {
  std::array<Row, Dim> rows;
  const double along = 1.0 - std::sqrt(damping / (1.0 + damping));
  const Jet& jet = residual.jet;
  const Vector<Dim> tangent = residual.speed > 0.0 ? residual.tangent : Vector<Dim>::Zero();
  const auto across = [&](const Vector<Dim>& v) -> Vector<Dim> {
    return residual.factor * (v - along * tangent.dot(v) * tangent);
  };
  const Vector<Dim> value = across(jet.value);
  for (std::size_t d = 0; d < Dim; ++d) {
    const Vector<Dim> image = across(Vector<Dim>::Unit(static_cast<Eigen::Index>(d)));
    for (std::size_t j = 0; j <= static_cast<std::size_t>(p_); ++j)
      for (std::size_t e = 0; e < Dim; ++e) rows[e][j * Dim + d] = jet.basis[j] * image[static_cast<Eigen::Index>(e)];
  }
  const std::size_t knots = static_cast<std::size_t>(p_ + 1) * Dim;
  for (std::size_t k = 0; k < 2 * static_cast<std::size_t>(p_); ++k) {
    const Vector<Dim> move = across(jet.moves[k]);
    for (std::size_t e = 0; e < Dim; ++e) rows[e][knots + k] = move[static_cast<Eigen::Index>(e)];
  }
  const std::size_t columns = Degree > 0 ? most_columns : static_cast<std::size_t>(columns_);
  for (std::size_t e = 0; e < Dim; ++e) {
    const double* row = rows[e].data();
    for (std::size_t i = 0; i < columns; ++i) {
      const double factor = row[i];
      double* products = local.products.data() + i * columns;
      for (std::size_t j = 0; j <= i; ++j) products[j] += factor * row[j];
      local.slope[i] += factor * value[static_cast<Eigen::Index>(e)];
    }
  }
}

template <int Dim, int Degree>
void StepSystem<Dim, Degree>::assemble(double damping, BorderedCholesky& matrix, Eigen::VectorXd& gradient) const {
  const std::size_t columns = static_cast<std::size_t>(columns_);
  const std::size_t knots = static_cast<std::size_t>(p_ + 1) * Dim;
  Local local{std::vector<double>(columns * columns), {}};
  auto fair = fair_.begin();
  for (int span = p_; span < space_.knots.basis_count(); ++span) {
    if (!(space_.knots[span] < space_.knots[span + 1])) continue;
    std::fill(local.products.begin(), local.products.end(), 0.0);
    local.slope.fill(0.0);
    for (const int i : sorted_.of(span - p_)) add_residual(data_[static_cast<std::size_t>(i)], damping, local);
    for (std::size_t g = 0; g < gauss_.size(); ++g) add_residual(*fair++, damping, local);
    const Unknowns unknowns = this->unknowns(span);
    Row scale;
    scale.fill(1.0);
    for (std::size_t k = knots; k < columns; ++k)
      if (unknowns[k] >= 0) scale[k] = gaps_[static_cast<std::size_t>(unknowns[k] / (Dim + 1))];
    for (std::size_t i = 0; i < columns; ++i) {
      const int a = unknowns[i];
      if (a < 0) continue;
      gradient[a] += scale[i] * local.slope[i];
      for (std::size_t j = 0; j <= i; ++j) {
        const int b = unknowns[j];
        if (b < 0) continue;
        // Two images of one knot in a window of few spans meet on the diagonal.
        const double images = a == b && i != j ? 2.0 : 1.0;
        matrix.add(a, b, images * scale[i] * scale[j] * local.products[i * columns + j]);
      }
    }
  }
}

/// What the elimination of a parameter left out: it follows the rest along the curve.
template <int Dim, int Degree>
double StepSystem<Dim, Degree>::parameter_step(int span, const Residual<Dim, Degree>& residual, double damping,
                                               const Eigen::VectorXd& solution, const Unknowns& unknowns) const {
  if (!(residual.speed > 0.0)) return 0.0;
  Vector<Dim> change = residual.jet.value;
  for (std::size_t j = 0; j <= static_cast<std::size_t>(p_); ++j)
    if (unknowns[j * Dim] >= 0) change += residual.jet.basis[j] * solution.segment<Dim>(unknowns[j * Dim]);
  for (std::size_t k = 0; k < 2 * static_cast<std::size_t>(p_); ++k) {
    const int unknown = unknowns[static_cast<std::size_t>(p_ + 1) * Dim + k];
    if (unknown >= 0)
      change += gaps_[static_cast<std::size_t>(unknown / (Dim + 1))] * solution[unknown] * residual.jet.moves[k];
  }
  const double longest = 0.5 * (space_.knots[span + 1] - space_.knots[span]);
  const double step = -residual.tangent.dot(change) / (residual.speed * (1.0 + damping));
  return std::clamp(step, -longest, longest);
}

template <int Dim, int Degree>
double StepSystem<Dim, Degree>::step(double damping, FitState<Dim>& next) const {
  constexpr double longest = 0.4;
  const int half_width = (2 * p_ - 1) * (Dim + 1) + Dim;
  BorderedCholesky matrix(size(), half_width, frame_.is_periodic() ? (2 * p_ - 1) * (Dim + 1) : 0);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size());
  assemble(damping, matrix, gradient);
  double largest = 0.0;
  double largest_knot = 0.0;
  for (int i = 0; i < size(); ++i) {
    largest = std::max(largest, matrix.diagonal(i));
    if (i % (Dim + 1) == Dim) largest_knot = std::max(largest_knot, matrix.diagonal(i));
  }
  for (int i = 0; i < size(); ++i) {
    const bool is_knot = i % (Dim + 1) == Dim;
    matrix.add(i, i, matrix.diagonal(i) == 0.0 ? 1.0 : is_knot ? damping * largest_knot : 1e-12 * largest);
  }
  if (!matrix.factorise()) return 0.0;
  const Eigen::VectorXd solution = matrix.solve(-gradient);
  double decrease = -gradient.dot(solution);
  for (int i = Dim; i < size(); i += Dim + 1) decrease += damping * largest_knot * solution[i] * solution[i];
  for (int j = 0; j < static_cast<int>(state_.breakpoints.size()); ++j)
    if (is_free(j))
      next.breakpoints[static_cast<std::size_t>(j)] += std::clamp(solution[unknown_of(j)], -longest, longest) * gap(j);
  for (int span = p_; span < space_.knots.basis_count(); ++span) {
    const std::span<const int> members = sorted_.of(span - p_);
    if (members.empty()) continue;
    const Unknowns unknowns = this->unknowns(span);
    for (const int member : members) {
      const std::size_t i = static_cast<std::size_t>(member);
      next.parameters[i] =
          frame_.into_domain(state_.parameters[i] + parameter_step(span, data_[i], damping, solution, unknowns));
    }
  }
  return decrease;
}

template <int Dim, int Degree>
bool move_knots_of_degree(const FitFrame<Dim>& frame, FitState<Dim>& state, double& damping) {
  constexpr int most_trials = 6;
  const StepSystem<Dim, Degree> system(frame, state);
  const double before = fit_objective(frame, state);
  double growth = 2.0;
  for (int trial = 0; trial < most_trials; ++trial) {
    FitState<Dim> next = state;
    const double expected = system.step(damping, next);
    const double decrease =
        expected > 0.0 && frame.solve(next, next.fairness) ? before - fit_objective(frame, next) : 0.0;
    if (decrease > 0.0) {
      state = std::move(next);
      const double surplus = 2.0 * decrease / expected - 1.0;
      damping *= std::max(1.0 / 3.0, 1.0 - surplus * surplus * surplus);
      return true;
    }
    state.iterations = next.iterations;
    damping *= growth;
    growth *= 2.0;
  }
  return false;
}

}  // namespace

template <int Dim>
double roughness(const FitFrame<Dim>& frame, const Fairness& fairness, const FitState<Dim>& state) {
  const int p = frame.degree();
  if (fairness.derivative > p) return 0.0;
  const KnotVector knots = frame.space(state.breakpoints).knots;
  const std::vector<GaussPoint> gauss = gauss_points(std::min(p - fairness.derivative + 1, most_gauss_points));
  LocalBasisTable<0> table(p + 1, 1);
  double sum = 0.0;
  for (int span = p; span < knots.basis_count(); ++span) {
    const double length = knots[span + 1] - knots[span];
    if (!(length > 0.0)) continue;
    const double factor = fairness.factors.empty() ? 1.0 : fairness.factors[static_cast<std::size_t>(span - p)];
    for (const GaussPoint& point : gauss) {
      fill_basis_derivative(knots, span, knots[span] + point.node * length, fairness.derivative, table.data());
      const Vector<Dim> value = state.control.middleCols(span - p, p + 1).lazyProduct(table);
      sum += factor * point.weight * length * value.squaredNorm();
    }
  }
  return sum;
}

template <int Dim>
double fit_objective(const FitFrame<Dim>& frame, FitState<Dim>& state) {
  frame.measure(state);
  return state.mean_squared +
         (state.fairness.mu > 0.0 ? state.fairness.mu * roughness(frame, state.fairness, state) : 0.0);
}

template <int Dim>
bool move_knots(const FitFrame<Dim>& frame, FitState<Dim>& state, double& damping) {
  return frame.degree() == 3 ? move_knots_of_degree<Dim, 3>(frame, state, damping)
                             : move_knots_of_degree<Dim, 0>(frame, state, damping);
}

template bool move_knots(const FitFrame<2>&, FitState<2>&, double&);
template bool move_knots(const FitFrame<3>&, FitState<3>&, double&);
template double fit_objective(const FitFrame<2>&, FitState<2>&);
template double fit_objective(const FitFrame<3>&, FitState<3>&);
template double roughness(const FitFrame<2>&, const Fairness&, const FitState<2>&);
template double roughness(const FitFrame<3>&, const Fairness&, const FitState<3>&);

}  // namespace isorim::geometry
