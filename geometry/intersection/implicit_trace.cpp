#include "geometry/intersection/implicit_trace.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/chain_fit.h"

namespace isorim::geometry {
namespace {

/// Stretches of knot lines shorter than this, in the unit square, are rounding.
constexpr double shortest_stretch = 1e-9;

ElementTable<3> elements_of(const NurbsSurface<3>& surface) {
  return bezier_elements(Boundary<3>{{Patch<3>{"surface", surface}}});
}

/// Of F over the element's control points: turns distances into values of F.
double steepest_gradient(const ImplicitSurface& implicit, const Eigen::Ref<const HomogeneousPoints<3>>& net) {
  double steepest = 0.0;
  for (Eigen::Index i = 0; i < net.cols(); ++i)
    steepest = std::max(steepest, gradient(implicit, net.col(i).head<3>() / net(3, i)).norm());
  return steepest;
}

/// The sign of g just inside a side; 0 where f vanishes altogether.
int sign_inside(const ElementFunction& function, const std::optional<SignChart>& chart, double from, double to) {
  return function.vanishes || !chart ? 0 : chart->sign_between(from, to);
}

int index_of_span(const std::vector<double>& breakpoints, double u) {
  const auto above = std::upper_bound(breakpoints.begin() + 1, breakpoints.end() - 1, u);
  return static_cast<int>(above - breakpoints.begin()) - 1;
}

double from_unit(Interval domain, double s) {
  return s == 1.0 ? domain.last : domain.first + s * domain.length();
}

}  // namespace

ImplicitTrace::ImplicitTrace(const NurbsSurface<3>& surface, const ImplicitSurface& implicit,
                             const TraceOptions& options)
    : ImplicitTrace(surface, elements_of(surface), implicit, options) {}

ImplicitTrace::ImplicitTrace(const NurbsSurface<3>& surface, const ElementTable<3>& table,
                             const ImplicitSurface& implicit, const TraceOptions& options)
    : breakpoints_u_(surface.knots_u().breakpoints()), breakpoints_v_(surface.knots_v().breakpoints()) {
  const double size = options.size > 0.0 ? options.size : bounding_box(table).diagonal();
  for (const BezierElement<3>& element : table.elements) {
    const Eigen::Map<const HomogeneousPoints<3>> net = table.net_matrix(element);
    const double coincidence = options.tolerance * size * steepest_gradient(implicit, net);
    functions_.push_back(divide_out_sides(compose(implicit, element, net), coincidence));
  }
  std::vector<SideCharts> charts(functions_.size());
  for (int e = 0; e < static_cast<int>(functions_.size()); ++e) {
    try {
      trace_element(e, charts);
    } catch (GeometryError& error) {
      const Point2 middle = from_unit_square(e, {0.5, 0.5});
      const Point3 place = evaluate(surface, middle);
      error.add_context(fmt::format("the element about (u, v) = ({:.6g}, {:.6g}), that is ({:.6g}, {:.6g}, {:.6g})",
                                    middle.x(), middle.y(), place.x(), place.y(), place.z()));
      throw;
    }
  }
  const int rows = static_cast<int>(breakpoints_v_.size()) - 1;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns(); ++i) {
      const int e = i + j * columns();
      if (i + 1 < columns()) append_knot_line(e, e + 1, Side::right, Side::left, charts);
      if (j + 1 < rows) append_knot_line(e, e + columns(), Side::top, Side::bottom, charts);
    }
}

Interval ImplicitTrace::domain_u(int element) const {
  const auto i = static_cast<std::size_t>(element % columns());
  return {breakpoints_u_[i], breakpoints_u_[i + 1]};
}

Interval ImplicitTrace::domain_v(int element) const {
  const auto j = static_cast<std::size_t>(element / columns());
  return {breakpoints_v_[j], breakpoints_v_[j + 1]};
}

int ImplicitTrace::element_at(const Point2& uv) const {
  return index_of_span(breakpoints_u_, uv.x()) + index_of_span(breakpoints_v_, uv.y()) * columns();
}

Point2 ImplicitTrace::to_unit_square(int element, const Point2& uv) const {
  const Interval u = domain_u(element);
  const Interval v = domain_v(element);
  return {(uv.x() - u.first) / u.length(), (uv.y() - v.first) / v.length()};
}

Point2 ImplicitTrace::from_unit_square(int element, const Point2& point) const {
  return {from_unit(domain_u(element), point.x()), from_unit(domain_v(element), point.y())};
}

int ImplicitTrace::sign_everywhere() const {
  const auto is_negative = [](const ElementFunction& f) { return f.whole.maxCoeff() < -f.coincidence; };
  const auto is_not_negative = [](const ElementFunction& f) { return f.whole.minCoeff() >= -f.coincidence; };
  if (std::all_of(functions_.begin(), functions_.end(), is_negative)) return -1;
  return std::all_of(functions_.begin(), functions_.end(), is_not_negative) ? 1 : 0;
}

void ImplicitTrace::trace_element(int element, std::vector<SideCharts>& charts) {
  const ElementFunction& own = function(element);
  SideCharts& sides = charts[static_cast<std::size_t>(element)];
  // A side that f does not vanish on has the signs that the neighbour found.
  const auto take = [&](int neighbour, Side theirs, Side ours) {
    const ElementFunction& other = function(neighbour);
    if (own.vanishes_on(ours) || other.vanishes_on(theirs) || other.vanishes) return;
    sides[static_cast<std::size_t>(ours)] =
        charts[static_cast<std::size_t>(neighbour)][static_cast<std::size_t>(theirs)];
  };
  if (element % columns() > 0) take(element - 1, Side::right, Side::left);
  if (element >= columns()) take(element - columns(), Side::top, Side::bottom);
  for (const ZeroChain& chain : zero_chains(own, sides)) {
    for (const Points<2>& local : fit_chain(own, chain)) {
      Points<2> points(2, local.cols());
      for (Eigen::Index i = 0; i < local.cols(); ++i) points.col(i) = from_unit_square(element, local.col(i));
      const KnotVector knots = KnotVector::bezier(static_cast<int>(local.cols()) - 1);
      curves_.push_back({NurbsCurve<2>::from_points(knots, points), element});
    }
  }
}

void ImplicitTrace::append_knot_line(int before, int after, Side side_before, Side side_after,
                                     const std::vector<SideCharts>& charts) {
  const ElementFunction& first = function(before);
  const ElementFunction& second = function(after);
  const bool vanishes =
      (first.vanishes || first.vanishes_on(side_before)) && (second.vanishes || second.vanishes_on(side_after));
  if (!vanishes) return;
  const auto& chart_first = charts[static_cast<std::size_t>(before)][static_cast<std::size_t>(side_before)];
  const auto& chart_second = charts[static_cast<std::size_t>(after)][static_cast<std::size_t>(side_after)];
  std::vector<double> cuts{0.0, 1.0};
  if (chart_first) cuts.insert(cuts.end(), chart_first->roots.begin(), chart_first->roots.end());
  if (chart_second) cuts.insert(cuts.end(), chart_second->roots.begin(), chart_second->roots.end());
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] - cuts[i] < shortest_stretch) continue;
    const bool keeps_first = sign_inside(first, chart_first, cuts[i], cuts[i + 1]) < 0;
    const bool keeps_second = sign_inside(second, chart_second, cuts[i], cuts[i + 1]) < 0;
    const bool is_flat = first.vanishes || second.vanishes;
    if (keeps_first == keeps_second && is_flat) continue;
    const bool is_vertical = side_before == Side::right;
    Points<2> ends(2, 2);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double s = cuts[i + static_cast<std::size_t>(k)];
      ends.col(k) = from_unit_square(before, is_vertical ? Point2(1.0, s) : Point2(s, 1.0));
    }
    if (keeps_first == keeps_second) {
      touching_.push_back(NurbsCurve<2>::from_points(KnotVector::bezier(1), ends));
      continue;
    }
    // Upwards the left one of two elements is on the left, to the right the upper one.
    const bool runs_forward = is_vertical ? keeps_first : keeps_second;
    const Points<2> points = runs_forward ? ends : Points<2>(ends.rowwise().reverse());
    curves_.push_back({NurbsCurve<2>::from_points(KnotVector::bezier(1), points), keeps_first ? before : after});
  }
}

}  // namespace isorim::geometry
