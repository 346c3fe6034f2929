#include "geometry/fitting/knot_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/fitting/bordered_cholesky.h"
#include "geometry/fitting/derivative_row.h"
#include "geometry/fitting/local_bezier.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

namespace {

constexpr std::size_t capacity = KnotVector::max_degree + 1;

/// The derivative of order r of a Bézier curve over an interval of this length, at s in [0, 1].
template <int Dim>
Vector<Dim> bezier_derivative(const LocalNet<Dim>& points, int p, int r, double length, double s) {
  if (r > p) return Vector<Dim>::Zero();
  LocalNet<Dim> net;
  std::copy_n(points.begin(), p + 1, net.begin());
  for (int k = 0; k < r; ++k)
    for (std::size_t i = 0; i < static_cast<std::size_t>(p - k); ++i) net[i] = (p - k) / length * (net[i + 1] - net[i]);
  for (int count = p - r; count > 0; --count)
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) net[i] += s * (net[i + 1] - net[i]);
  return net[0];
}

/// The derivatives of the curve on span `span` with respect to knots span - p + 1 .. span + p, as Bézier curves.
template <int Dim>
std::vector<LocalNet<Dim>> knot_derivatives(const KnotVector& knots, const Points<Dim>& control, int span) {
  const int p = knots.degree();
  const int total = static_cast<int>(knots.knots().size());
  std::vector<LocalNet<Dim>> result(static_cast<std::size_t>(2 * p));
  for (int k = span - p + 1; k <= span + p; ++k) {
    // In the vector with knot k doubled, knots from k + 1 on are one place further.
    const int shifted = k <= span ? span + 1 : span;
    const auto doubled = [&](int i) { return knots[std::clamp(i <= k ? i : i - 1, 0, total - 1)]; };
    std::array<double, 2 * capacity> around;
    for (int i = 0; i < 2 * p; ++i) around[static_cast<std::size_t>(i)] = doubled(shifted - p + 1 + i);
    LocalNet<Dim> slopes;
    for (int j = 0; j <= p; ++j) {
      const int i = shifted - p + j;
      Vector<Dim>& slope = slopes[static_cast<std::size_t>(j)];
      slope.setZero();
      if (i < k - p || i > k || i < 1 || i >= knots.basis_count()) continue;
      const double width = knots[i + p] - knots[i];
      if (width > 0.0) slope = (control.col(i - 1) - control.col(i)) / width;
    }
    cut_to_bezier<Dim>(around.data(), slopes, p, result[static_cast<std::size_t>(k - (span - p + 1))]);
  }
  return result;
}

/// Two or more Gauss points integrate |C^(r)|^2 exactly, r >= 2, up to degree 5; more are not needed for a direction.
constexpr int most_gauss_points = 4;

struct GaussPoint {
  double node;
  double weight;
};

/// Gauss-Legendre on [0, 1] with 1 to 4 points.
std::vector<GaussPoint> gauss_points(int count) {
  switch (count) {
    case 1:
      return {{0.5, 1.0}};
    case 2:
      return {{0.21132486540518712, 0.5}, {0.78867513459481288, 0.5}};
    case 3:
      return {{0.11270166537925831, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.88729833462074169, 5.0 / 18.0}};
    default:
      return {{0.06943184420297371, 0.17392742256872693},
              {0.33000947820757187, 0.32607257743127307},
              {0.66999052179242813, 0.32607257743127307},
              {0.93056815579702629, 0.17392742256872693}};
  }
}

/// The normal equations of one step. Unknown block i: the change of control point i and of knot i + shift.
template <int Dim>
class StepSystem {
 public:
  StepSystem(const FitFrame<Dim>& frame, const FitState<Dim>& state, const Fairness& fairness)
      : frame_(frame),
        state_(state),
        fairness_(fairness),
        space_(frame.space(state.breakpoints)),
        p_(frame.degree()),
        shift_(p_ / 2 + 1),
        blocks_(frame.is_periodic() ? space_.unknowns() : space_.knots.basis_count()),
        matrix_(size(), (2 * p_ - 1) * (Dim + 1) + Dim, frame.is_periodic() ? (2 * p_ - 1) * (Dim + 1) : 0),
        gradient_(Eigen::VectorXd::Zero(size())) {
    mark_free_knots();
    const std::vector<std::vector<int>> members = data_of_spans();
    for (int span = p_; span < space_.knots.basis_count(); ++span)
      if (space_.knots[span] < space_.knots[span + 1]) add_span(span, members[static_cast<std::size_t>(span - p_)]);
  }

  /// The step of the breakpoints, in units of the distance to the nearer neighbour; empty if the system is singular.
  Eigen::VectorXd step(double damping) const {
    BorderedCholesky damped = matrix_;
    double largest = 0.0;
    const int count = static_cast<int>(state_.breakpoints.size());
    for (int j = 0; j < count; ++j)
      if (is_free(j)) largest = std::max(largest, matrix_.diagonal(unknown_of(j)));
    double trace = 0.0;
    for (int i = 0; i < size(); ++i) trace = std::max(trace, matrix_.diagonal(i));
    for (int i = 0; i < size(); ++i)
      damped.add(i, i, matrix_.diagonal(i) == 0.0 ? 1.0 : (i % (Dim + 1) == Dim ? damping * largest : 1e-12 * trace));
    if (!damped.factorise()) return {};
    const Eigen::VectorXd solution = damped.solve(-gradient_);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(count);
    for (int j = 0; j < count; ++j)
      if (is_free(j)) result[j] = solution[unknown_of(j)];
    return result;
  }

  double gap(int j) const {
    const std::vector<double>& b = state_.breakpoints;
    const std::size_t i = static_cast<std::size_t>(j);
    return std::min(b[i + 1] - b[i], b[i] - b[i - 1]);
  }

 private:
  int size() const { return blocks_ * (Dim + 1); }
  bool is_free(int j) const { return free_[static_cast<std::size_t>(j)] != 0; }
  int block_of_function(int i) const { return i % blocks_; }
  int unknown_of(int breakpoint) const { return ((breakpoint + p_ - shift_ + blocks_) % blocks_) * (Dim + 1) + Dim; }
  /// The breakpoint that knot k is, or is a periodic image of.
  int breakpoint_of(int k) const {
    const int spans = static_cast<int>(state_.breakpoints.size()) - 1;
    if (frame_.is_periodic()) return ((k - p_) % spans + spans) % spans;
    return std::clamp(k - p_, 0, spans);
  }

  void mark_free_knots() {
    free_.assign(state_.breakpoints.size(), 0);
    for (std::size_t j = 1; j + 1 < free_.size(); ++j) free_[j] = frame_.is_free_knot(state_.breakpoints[j]) ? 1 : 0;
  }

  std::vector<std::vector<int>> data_of_spans() const {
    std::vector<std::vector<int>> members(static_cast<std::size_t>(space_.knots.basis_count() - p_));
    for (std::size_t i = 0; i < state_.parameters.size(); ++i)
      members[static_cast<std::size_t>(space_.knots.find_span(state_.parameters[i]) - p_)].push_back(
          static_cast<int>(i));
    return members;
  }

  void add_span(int span, const std::vector<int>& members);

  const FitFrame<Dim>& frame_;
  const FitState<Dim>& state_;
  const Fairness& fairness_;
  FitSpace space_;
  int p_;
  int shift_;
  int blocks_;
  BorderedCholesky matrix_;
  Eigen::VectorXd gradient_;
  std::vector<char> free_;
};

/// Rows of one span: for each datum and each Gauss point of the fairness term the change of its residual with the
/// p + 1 control points and the 2p knots.
template <int Dim>
void StepSystem<Dim>::add_span(int span, const std::vector<int>& members) {
  const KnotVector& knots = space_.knots;
  const double start = knots[span];
  const double length = knots[span + 1] - start;
  const std::vector<LocalNet<Dim>> moves = knot_derivatives<Dim>(knots, state_.control, span);
  const int order = fairness_.derivative;
  const bool is_fair = fairness_.mu > 0.0 && order <= p_;
  const std::vector<GaussPoint> gauss =
      is_fair ? gauss_points(std::min(p_ - order + 1, most_gauss_points)) : std::vector<GaussPoint>{};
  const int columns = (p_ + 1) * Dim + 2 * p_;
  const Eigen::Index rows = static_cast<Eigen::Index>(members.size() + gauss.size()) * Dim;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, columns);
  Eigen::VectorXd residual(rows);
  LocalBasisTable<2> table(p_ + 1, 3);
  Eigen::Index row = 0;
  const auto add_rows = [&](const Eigen::VectorXd& values, double factor, const Vector<Dim>& value) {
    for (int j = 0; j <= p_; ++j)
      for (int d = 0; d < Dim; ++d) jacobian(row + d, j * Dim + d) = factor * values[j];
    residual.segment<Dim>(row) = factor * value;
  };
  const FitData<Dim>& data = frame_.prepared().data;
  for (const int i : members) {
    const double u = state_.parameters[static_cast<std::size_t>(i)];
    const double factor = std::sqrt(data.weights[static_cast<std::size_t>(i)] / static_cast<double>(data.size()));
    fill_basis_table(knots, span, u, table.template leftCols<1>());
    const Point<Dim> point = state_.control.middleCols(span - p_, p_ + 1).lazyProduct(table.col(0));
    add_rows(table.col(0), factor, point - data.points.col(i));
    for (int k = 0; k < 2 * p_; ++k)
      jacobian.col((p_ + 1) * Dim + k).segment<Dim>(row) =
          factor * bezier_derivative<Dim>(moves[static_cast<std::size_t>(k)], p_, 0, length, (u - start) / length);
    row += Dim;
  }
  const double mu =
      fairness_.mu * (fairness_.factors.empty() ? 1.0 : fairness_.factors[static_cast<std::size_t>(span - p_)]);
  for (const GaussPoint& point : gauss) {
    const double factor = std::sqrt(mu * point.weight * length);
    const auto derivative = [&](int d, Eigen::Index column) -> Vector<Dim> {
      if (d > p_) return Vector<Dim>::Zero();
      fill_basis_derivative(knots, span, start + point.node * length, d, table.col(column).data());
      return state_.control.middleCols(span - p_, p_ + 1).lazyProduct(table.col(column));
    };
    const Vector<Dim> value = derivative(order, 1);
    const Vector<Dim> next = derivative(order + 1, 2);
    add_rows(table.col(1), factor, value);
    for (int k = 0; k < 2 * p_; ++k) {
      // Gauss points and lengths move with the ends of the span, knots p - 1 and p of those around it.
      Vector<Dim> change = bezier_derivative<Dim>(moves[static_cast<std::size_t>(k)], p_, order, length, point.node);
      if (k == p_ - 1) change += (1.0 - point.node) * next - 0.5 / length * value;
      if (k == p_) change += point.node * next + 0.5 / length * value;
      jacobian.col((p_ + 1) * Dim + k).segment<Dim>(row) = factor * change;
    }
    row += Dim;
  }

  std::vector<int> unknowns(static_cast<std::size_t>(columns), -1);
  for (int j = 0; j <= p_; ++j)
    for (int d = 0; d < Dim; ++d)
      unknowns[static_cast<std::size_t>(j * Dim + d)] = block_of_function(span - p_ + j) * (Dim + 1) + d;
  for (int k = 0; k < 2 * p_; ++k) {
    const int j = breakpoint_of(span - p_ + 1 + k);
    if (!is_free(j)) continue;
    const int column = (p_ + 1) * Dim + k;
    unknowns[static_cast<std::size_t>(column)] = unknown_of(j);
    jacobian.col(column) *= gap(j);
  }
  const Eigen::MatrixXd local = jacobian.transpose() * jacobian;
  const Eigen::VectorXd slope = jacobian.transpose() * residual;
  for (int i = 0; i < columns; ++i) {
    const int a = unknowns[static_cast<std::size_t>(i)];
    if (a < 0) continue;
    gradient_[a] += slope[i];
    for (int j = 0; j <= i; ++j) {
      const int b = unknowns[static_cast<std::size_t>(j)];
      if (b < 0) continue;
      // Two images of one knot in a window of few spans meet on the diagonal.
      matrix_.add(a, b, a == b && i != j ? 2.0 * local(i, j) : local(i, j));
    }
  }
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
double fit_objective(const FitFrame<Dim>& frame, const Fairness& fairness, const FitState<Dim>& state) {
  const SegmentedCurve<Dim> curve = frame.curve(state);
  const FitData<Dim>& data = frame.prepared().data;
  double sum = 0.0;
  for (std::size_t i = 0; i < data.size(); ++i)
    sum += data.weights[i] *
           (curve.jet(state.parameters[i]).point - data.points.col(static_cast<Eigen::Index>(i))).squaredNorm();
  return sum / static_cast<double>(data.size()) + fairness.mu * roughness(frame, fairness, state);
}

template <int Dim>
bool move_knots(const FitFrame<Dim>& frame, const Fairness& fairness, FitState<Dim>& state, double& damping) {
  constexpr int most_trials = 6;
  constexpr double longest = 0.4;
  const StepSystem<Dim> system(frame, state, fairness);
  const double before = fit_objective(frame, fairness, state);
  for (int trial = 0; trial < most_trials; ++trial) {
    const Eigen::VectorXd step = system.step(damping);
    FitState<Dim> next = state;
    for (Eigen::Index j = 0; j < step.size(); ++j)
      if (step[j] != 0.0)
        next.breakpoints[static_cast<std::size_t>(j)] +=
            std::clamp(step[j], -longest, longest) * system.gap(static_cast<int>(j));
    if (step.size() > 0 && frame.solve(next, fairness) && fit_objective(frame, fairness, next) < before) {
      state = std::move(next);
      damping *= 0.3;
      return true;
    }
    state.iterations = next.iterations;
    damping *= 4.0;
  }
  return false;
}

template bool move_knots(const FitFrame<2>&, const Fairness&, FitState<2>&, double&);
template bool move_knots(const FitFrame<3>&, const Fairness&, FitState<3>&, double&);
template double fit_objective(const FitFrame<2>&, const Fairness&, const FitState<2>&);
template double fit_objective(const FitFrame<3>&, const Fairness&, const FitState<3>&);
template double roughness(const FitFrame<2>&, const Fairness&, const FitState<2>&);
template double roughness(const FitFrame<3>&, const Fairness&, const FitState<3>&);

}  // namespace isorim::geometry
