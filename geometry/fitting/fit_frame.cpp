#include "geometry/fitting/fit_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/knot_placement.h"

namespace isorim::geometry {

namespace {

template <int Dim>
void require_options(const CurveFitOptions<Dim>& options) {
  const auto refuse = [](const std::string& what) { throw GeometryError("curve fit: " + what); };
  if (options.degree < 1 || options.degree > KnotVector::max_degree)
    refuse(fmt::format("degree {} is out of range; expected 1 to {}", options.degree, KnotVector::max_degree));
  if (options.control_points < 0) refuse(fmt::format("{} control points asked for", options.control_points));
  if (!(options.tolerance >= 0.0)) refuse(fmt::format("tolerance {}; expected 0 or more", options.tolerance));
  if (options.control_points > 0 && options.tolerance > 0.0)
    refuse("a number of control points and a tolerance are given; expected one of them");
  if (options.parameter_corrections < 0)
    refuse(fmt::format("{} parameter corrections asked for", options.parameter_corrections));
  if (options.knot_steps < 0) refuse(fmt::format("{} steps of the knots asked for", options.knot_steps));
  if (options.peak_steps < 0)
    refuse(fmt::format("{} steps against the largest distance asked for", options.peak_steps));
  if (options.fairness && !(*options.fairness >= 0.0 && std::isfinite(*options.fairness)))
    refuse(fmt::format("fairness {}; expected 0 or more", *options.fairness));
  if (!(options.fairness_share >= 0.0 && std::isfinite(options.fairness_share)))
    refuse(fmt::format("fairness share {}; expected 0 or more", options.fairness_share));
  if (options.fairness_derivative != 2 && options.fairness_derivative != 3)
    refuse(fmt::format("fairness of derivative {}; expected 2 or 3", options.fairness_derivative));
  if (!(options.corner_angle >= 0.0 && options.corner_angle < 180.0))
    refuse(fmt::format("corner angle {}; expected 0 (none) to 180", options.corner_angle));
  const bool has_breakpoints = !options.breakpoints.empty();
  if (has_breakpoints != (options.knots == FitKnots::given))
    refuse(has_breakpoints ? "breakpoints are given, but another rule for knots is asked for"
                           : "given knots are asked for, but there are no breakpoints");
}

template <int Dim>
void require_ends(const CurveFitOptions<Dim>& options) {
  const auto check = [&](FitEnd end, const Vector<Dim>& tangent, const char* name) {
    if (end == FitEnd::natural && options.degree < 2)
      throw GeometryError(fmt::format("curve fit: a natural {} of a curve of degree 1; expected 2 or more", name));
    if (end == FitEnd::tangent && !(tangent.norm() > 0.0 && tangent.allFinite()))
      throw GeometryError(fmt::format("curve fit: the tangent at the {} is zero or not finite", name));
  };
  if (options.closed) return;
  check(options.start, options.start_tangent, "start");
  check(options.end, options.end_tangent, "end");
}

/// Control points that an end condition determines beyond the end point itself.
int extra_conditions(FitEnd end) {
  return end == FitEnd::natural || end == FitEnd::tangent ? 1 : 0;
}

}  // namespace

template <int Dim>
FitFrame<Dim>::FitFrame(const Points<Dim>& points, const CurveFitOptions<Dim>& options) : options_(options) {
  require_options(options_);
  require_ends(options_);
  prepared_ = prepare_points(points, options_);
}

template <int Dim>
FitFrame<Dim> FitFrame<Dim>::thinned(int stride) const {
  FitFrame result = *this;
  const PreparedPoints<Dim>& all = prepared_;
  PreparedPoints<Dim>& few = result.prepared_;
  std::vector<Eigen::Index> kept;
  few.corners.clear();
  few.index.clear();
  few.parameters.clear();
  few.data.weights.clear();
  for (int i = 0; i < point_count(); ++i) {
    const bool is_corner = std::binary_search(all.corners.begin(), all.corners.end(), i);
    const bool is_end = !options_.closed && i == point_count() - 1;
    if (i % stride != 0 && !is_corner && !is_end) continue;
    if (is_corner) few.corners.push_back(static_cast<int>(kept.size()));
    kept.push_back(i);
    few.parameters.push_back(all.parameters[static_cast<std::size_t>(i)]);
    few.data.weights.push_back(all.data.weights[static_cast<std::size_t>(i)]);
  }
  few.data.points = all.data.points(Eigen::all, kept);
  return result;
}

template <int Dim>
FitFrame<Dim> FitFrame<Dim>::reweighted(const std::vector<double>& weights) const {
  FitFrame result = *this;
  result.prepared_.data.weights = weights;
  return result;
}

template <int Dim>
std::vector<double> FitFrame<Dim>::corner_parameters() const {
  std::vector<double> corners;
  for (const int corner : prepared_.corners)
    if (corner > 0) corners.push_back(prepared_.parameters[static_cast<std::size_t>(corner)]);
  return corners;
}

template <int Dim>
bool FitFrame<Dim>::is_free_knot(double u) const {
  const std::vector<double> corners = corner_parameters();
  return std::find(corners.begin(), corners.end(), u) == corners.end();
}

template <int Dim>
int FitFrame<Dim>::control_points(const std::vector<double>& breakpoints) const {
  const int spans = static_cast<int>(breakpoints.size()) - 1;
  if (is_periodic()) return spans;
  return spans + degree() - (options_.closed ? 1 : 0);
}

template <int Dim>
int FitFrame<Dim>::free_knots(int control_points) const {
  if (is_periodic()) return control_points - 1;
  const int corners = static_cast<int>(corner_parameters().size());
  return control_points - degree() - (options_.closed ? 0 : 1) - corners * degree();
}

template <int Dim>
int FitFrame<Dim>::fewest_control_points() const {
  int fewest = degree() + 1;
  if (!is_periodic()) {
    const int corners = static_cast<int>(corner_parameters().size());
    fewest = degree() * (corners + 1) + (options_.closed ? 0 : 1);
    // A closed curve of one corner is at least a loop of p + 1 distinct points.
    if (options_.closed) fewest = std::max(fewest, degree() + 1);
  }
  return fewest;
}

template <int Dim>
int FitFrame<Dim>::most_control_points() const {
  return point_count() + (options_.closed ? 0 : extra_conditions(options_.start) + extra_conditions(options_.end));
}

template <int Dim>
void FitFrame<Dim>::require_count(int control_points) const {
  const int fewest = fewest_control_points();
  const int most = most_control_points();
  if (most < fewest)
    throw GeometryError(fmt::format("curve fit: {} distinct points; degree {} with {} corners needs {} or more",
                                    point_count(), degree(), prepared_.corners.size(), fewest));
  if (control_points < fewest || control_points > most)
    throw GeometryError(
        fmt::format("curve fit: {} control points for {} distinct points, degree {} and {} corners; expected {} to {}",
                    control_points, point_count(), degree(), prepared_.corners.size(), fewest, most));
}

namespace {

/// Shares `count` knots among pieces in proportion to their sizes (largest remainders).
std::vector<int> share_out(int count, const std::vector<double>& sizes) {
  const double total = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  std::vector<int> shares(sizes.size());
  std::vector<std::pair<double, std::size_t>> remainders;
  int left = count;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double share = count * sizes[i] / total;
    shares[i] = static_cast<int>(share);
    left -= shares[i];
    remainders.emplace_back(static_cast<double>(shares[i]) - share, i);
  }
  std::sort(remainders.begin(), remainders.end());
  for (std::size_t i = 0; i < static_cast<std::size_t>(left); ++i) ++shares[remainders[i].second];
  return shares;
}

/// Closed parameters moved back by `shift`, into [0, 1).
void shift_parameters(double shift, std::vector<double>& parameters) {
  if (shift == 0.0) return;
  for (double& u : parameters) {
    u -= shift;
    u -= std::floor(u);
    if (u >= 1.0) u = 0.0;
  }
}

}  // namespace

template <int Dim>
FitState<Dim> FitFrame<Dim>::start_on_given_knots() const {
  const std::vector<double>& breakpoints = options_.breakpoints;
  if (breakpoints.size() < 2 || breakpoints.front() != 0.0 || breakpoints.back() != 1.0)
    throw GeometryError("curve fit: breakpoints must run from 0 to 1");
  for (const double corner : corner_parameters())
    if (std::count(breakpoints.begin(), breakpoints.end(), corner) != degree())
      throw GeometryError(
          fmt::format("curve fit: knots are given, but the corner at parameter {} is not among them {} times; give "
                      "knots that suit the corners, or look for none",
                      corner, degree()));
  FitState<Dim> state;
  state.breakpoints = breakpoints;
  state.parameters = prepared_.parameters;
  return state;
}

template <int Dim>
FitState<Dim> FitFrame<Dim>::first_fit(int control_points, const Fairness& fairness) const {
  std::vector<FitKnots> rules{options_.knots};
  if (options_.knots == FitKnots::automatic) {
    const bool interpolates = control_points == most_control_points();
    rules = {interpolates ? FitKnots::averaging : FitKnots::uniform, FitKnots::piegl_tiller};
  }
  for (const FitKnots rule : rules) {
    FitState<Dim> state = start(rule, control_points);
    if (solve(state, fairness)) return state;
  }
  throw GeometryError(fmt::format(
      "curve fit: on these knots the points do not determine all {} control points; give fewer control points, other "
      "knots or some fairness",
      control_points));
}

template <int Dim>
FitState<Dim> FitFrame<Dim>::start(FitKnots rule, int control_points) const {
  if (rule == FitKnots::given) return start_on_given_knots();
  FitState<Dim> state;
  state.parameters = prepared_.parameters;
  const std::vector<double>& parameters = prepared_.parameters;
  const int free = free_knots(control_points);
  if (is_periodic()) {
    std::vector<double> breakpoints{0.0};
    if (rule == FitKnots::averaging) {
      breakpoints = closed_averaged_knots(parameters, degree(), control_points);
    } else if (rule == FitKnots::piegl_tiller) {
      breakpoints = closed_piegl_tiller_knots(parameters, control_points);
    } else {
      const std::vector<double> inner = uniform_knots(0.0, 1.0, free);
      breakpoints.insert(breakpoints.end(), inner.begin(), inner.end());
      breakpoints.push_back(1.0);
    }
    const double shift = breakpoints.front();
    for (double& u : breakpoints) u -= shift;
    breakpoints.back() = 1.0;
    shift_parameters(shift, state.parameters);
    state.breakpoints = std::move(breakpoints);
    return state;
  }
  std::vector<double> ends{0.0};
  for (const double corner : corner_parameters()) ends.push_back(corner);
  ends.push_back(1.0);
  std::vector<double> sizes;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const auto first = std::lower_bound(parameters.begin(), parameters.end(), ends[i]);
    const auto last = std::upper_bound(first, parameters.end(), ends[i + 1]);
    sizes.push_back(rule == FitKnots::uniform ? ends[i + 1] - ends[i] : static_cast<double>(last - first));
  }
  const std::vector<int> shares = share_out(free, sizes);
  state.breakpoints = {0.0};
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    std::vector<double> piece(std::lower_bound(parameters.begin(), parameters.end(), ends[i]),
                              std::upper_bound(parameters.begin(), parameters.end(), ends[i + 1]));
    if (piece.back() < ends[i + 1]) piece.push_back(ends[i + 1]);
    std::vector<double> inner;
    if (rule == FitKnots::averaging)
      inner = averaged_knots(piece, degree(), shares[i], i == 0 ? extra_conditions(options_.start) : 0);
    else if (rule == FitKnots::piegl_tiller)
      inner = piegl_tiller_knots(piece, shares[i]);
    else
      inner = uniform_knots(ends[i], ends[i + 1], shares[i]);
    state.breakpoints.insert(state.breakpoints.end(), inner.begin(), inner.end());
    const bool is_end = i + 2 == ends.size();
    state.breakpoints.insert(state.breakpoints.end(), is_end ? 1 : static_cast<std::size_t>(degree()), ends[i + 1]);
  }
  return state;
}

template <int Dim>
FitSpace FitFrame<Dim>::space(const std::vector<double>& breakpoints) const {
  if (is_periodic()) return {KnotVector::periodic(degree(), breakpoints), degree()};
  return {KnotVector::clamped(degree(), breakpoints), options_.closed ? 1 : 0};
}

template <int Dim>
double FitFrame<Dim>::into_domain(double u) const {
  if (options_.closed) u -= std::floor(u);
  return std::clamp(u, 0.0, 1.0);
}

template <int Dim>
FitConstraints<Dim> FitFrame<Dim>::constraints(const KnotVector& knots) const {
  FitConstraints<Dim> result;
  if (is_periodic()) return result;
  const Points<Dim>& points = prepared_.data.points;
  const int last = knots.basis_count() - 1;
  for (const int corner : prepared_.corners) {
    if (corner == 0) continue;
    const double u = prepared_.parameters[static_cast<std::size_t>(corner)];
    const auto all = knots.knots();
    const int first = static_cast<int>(std::lower_bound(all.begin(), all.end(), u) - all.begin());
    result.fixed.push_back({first - 1, points.col(corner)});
  }
  if (options_.closed) {
    result.fixed.push_back({0, points.col(0)});
    result.fixed.push_back({last, points.col(0)});
    return result;
  }
  if (options_.start != FitEnd::free) result.fixed.push_back({0, points.col(0)});
  if (options_.end != FitEnd::free) result.fixed.push_back({last, points.col(points.cols() - 1)});
  const auto tangent_point = [&](FitEnd end, int function, double span, const Vector<Dim>& tangent,
                                 const Point<Dim>& from) {
    if (end != FitEnd::tangent) return;
    result.fixed.push_back({function, from + span * prepared_.length / degree() * tangent.normalized()});
  };
  tangent_point(options_.start, 1, knots[degree() + 1] - knots[1], options_.start_tangent, points.col(0));
  tangent_point(options_.end, last - 1, -(knots[last + degree()] - knots[last]), options_.end_tangent,
                points.col(points.cols() - 1));
  result.natural_start = options_.start == FitEnd::natural;
  result.natural_end = options_.end == FitEnd::natural;
  return result;
}

template <int Dim>
bool FitFrame<Dim>::solve(FitState<Dim>& state, const Fairness& fairness) const {
  const FitSpace space = this->space(state.breakpoints);
  Points<Dim> control = solve_fit(space, prepared_.data, state.parameters, fairness, constraints(space.knots));
  ++state.iterations;
  if (control.cols() == 0) return false;
  state.control = std::move(control);
  return true;
}

template <int Dim>
SegmentedCurve<Dim> FitFrame<Dim>::curve(const FitState<Dim>& state) const {
  return {space(state.breakpoints).knots, state.control, options_.closed};
}

template <int Dim>
void FitFrame<Dim>::measure(FitState<Dim>& state) const {
  const SegmentedCurve<Dim> curve = this->curve(state);
  const FitData<Dim>& data = prepared_.data;
  double sum = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double squared =
        (curve.jet(state.parameters[i]).point - data.points.col(static_cast<Eigen::Index>(i))).squaredNorm();
    sum += data.weights[i] * squared;
    largest = std::max(largest, squared);
  }
  state.max_distance = std::sqrt(largest);
  state.mean_squared = sum / static_cast<double>(data.size());
}

template <int Dim>
void FitFrame<Dim>::correct_parameters(FitState<Dim>& state, int steps) const {
  const SegmentedCurve<Dim> curve = this->curve(state);
  const FitData<Dim>& data = prepared_.data;
  double sum = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto [u, squared] = curve.follow(data.points.col(static_cast<Eigen::Index>(i)), state.parameters[i], steps);
    state.parameters[i] = u;
    sum += data.weights[i] * squared;
    largest = std::max(largest, squared);
  }
  state.max_distance = std::sqrt(largest);
  state.mean_squared = sum / static_cast<double>(data.size());
}

template class FitFrame<2>;
template class FitFrame<3>;

}  // namespace isorim::geometry
