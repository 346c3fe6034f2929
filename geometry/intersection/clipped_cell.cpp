#include "geometry/intersection/clipped_cell.h"

#include <array>
#include <cstddef>
#include <utility>

#include "geometry/intersection/chain_fit.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/intersection/element_zero_set.h"
#include "geometry/nurbs/surface.h"

namespace isorim::geometry {
namespace {

/// A place on a side of the unit cell; s grows with u or v.
Point2 on_side(Side side, double s) {
  switch (side) {
    case Side::bottom:
      return {s, 0.0};
    case Side::right:
      return {1.0, s};
    case Side::top:
      return {s, 1.0};
    default:
      return {0.0, s};
  }
}

/// The part of a side, counter-clockwise round the cell.
HomogeneousPoints<2> side_part(Side side, double from, double to) {
  if (side == Side::top || side == Side::left) std::swap(from, to);
  HomogeneousPoints<2> net(3, 2);
  net.col(0) << on_side(side, from), 1.0;
  net.col(1) << on_side(side, to), 1.0;
  return net;
}

void append_sides(const ElementFunction& function, const SideCharts& charts, ClippedCell& result) {
  for (const Side side : {Side::bottom, Side::right, Side::top, Side::left}) {
    const auto& chart = charts[static_cast<std::size_t>(side)];
    if (!chart) continue;
    for (std::size_t i = 0; i < chart->signs.size(); ++i) {
      if (chart->signs[i] >= 0) continue;
      const double from = i == 0 ? 0.0 : chart->roots[i - 1];
      const double to = i == chart->roots.size() ? 1.0 : chart->roots[i];
      const HomogeneousPoints<2> part = side_part(side, from, to);
      result.region.curves.push_back(part);
      if (function.vanishes_on(side)) result.cuts.push_back(part);
    }
  }
}

/// All of a cell, with the sides on which F vanishes.
ClippedCell whole_cell(const ElementFunction& function) {
  ClippedCell result;
  result.extent = ClippedCell::Extent::everything;
  for (const Side side : {Side::bottom, Side::right, Side::top, Side::left})
    if (function.vanishes_on(side)) result.cuts.push_back(side_part(side, 0.0, 1.0));
  return result;
}

}  // namespace

ClippedCell clip_cell(const ElementTable<3>& table, const BezierElement<3>& element, const ImplicitSurface& implicit,
                      const TraceOptions& options) {
  const auto net = table.net_matrix(element);
  double steepest = 0.0;
  for (Eigen::Index i = 0; i < net.cols(); ++i)
    steepest = std::max(steepest, gradient(implicit, net.col(i).head<3>() / net(3, i)).norm());
  const ElementFunction function =
      divide_out_sides(compose(implicit, element, net), options.tolerance * options.size * steepest);
  ClippedCell result;
  if (function.vanishes || function.grid.minCoeff() >= -function.coincidence) return result;
  if (function.grid.maxCoeff() <= 0.0) return whole_cell(function);
  SideCharts charts;
  for (const ZeroChain& chain : zero_chains(function, charts)) {
    for (const Points<2>& points : fit_chain(function, chain)) {
      HomogeneousPoints<2> curve(3, points.cols());
      curve << points, Eigen::RowVectorXd::Ones(points.cols());
      result.cuts.push_back(curve);
      result.region.curves.push_back(std::move(curve));
    }
  }
  append_sides(function, charts, result);
  if (!result.region.curves.empty()) result.extent = ClippedCell::Extent::part;
  return result;
}

CuttableFace cuttable_cell(const ElementTable<3>& table, const BezierElement<3>& element) {
  const NurbsSurface<3> surface(KnotVector::bezier(element.degree[0]), KnotVector::bezier(element.degree[1]),
                                table.net_matrix(element));
  if (!element.is_cut()) return CuttableFace(surface);
  std::vector<NurbsCurve<2>> curves;
  for (const HomogeneousPoints<2>& net : table.regions[static_cast<std::size_t>(element.region)].curves)
    curves.emplace_back(KnotVector::bezier(static_cast<int>(net.cols()) - 1), net);
  return CuttableFace(TrimmedSurface(surface, chain_directed_curves(curves, Vector2::Ones(), 1e-9, 1e-11)));
}

ClippedCell clip_cell(const CuttableFace& cell, const ImplicitSurface& implicit, const TraceOptions& options) {
  const KeptPart kept = kept_part(cell, implicit, options);
  ClippedCell result;
  for (const NurbsCurve<2>& cut : kept.cuts) result.cuts.push_back(cut.homogeneous());
  for (const NurbsCurve<2>& curve : kept.curves) result.region.curves.push_back(curve.homogeneous());
  if (kept.is_whole) {
    result.extent = ClippedCell::Extent::everything;
  } else if (!kept.curves.empty()) {
    result.extent = ClippedCell::Extent::part;
  }
  return result;
}

}  // namespace isorim::geometry
