#include "solver/bem/edge_grading.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/topology/shape_loops.h"

namespace isorim::solver {
namespace {

using geometry::Direction;
using geometry::EdgeUse;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;

/// Normals that differ by less leave the powers close to 1.
const double least_sine = std::sin(5.0 * std::numbers::pi / 180.0);
/// At which edges are looked at, as shares of their length; partners are found among more.
constexpr double looks[] = {0.1, 0.3, 0.5, 0.7, 0.9};
constexpr int partner_samples = 64;
/// Of the domain: by how much a pcurve of constant parameter may waver.
constexpr double straightness = 1e-9;

/// The body next to a point of an edge, on one of the two patches.
struct Wing {
  Point3 position;
  /// Unit, outward.
  Vector3 normal;
  /// Into the patch, across the edge; unit.
  Vector3 inward;
};

class EdgeSide {
 public:
  EdgeSide(const geometry::Boundary<3>& boundary, const std::vector<geometry::ShapeLoops>& loops, const EdgeUse& use)
      : surface_(&loops[static_cast<std::size_t>(use.patch)].surface(use.loop)),
        curve_(&loops[static_cast<std::size_t>(use.patch)].curve(use.loop, use.curve)),
        domain_(use.domain),
        orientation_(boundary.patches[static_cast<std::size_t>(use.patch)].orientation) {}

  /// At a share of the stretch; nothing where the surface has no normal.
  std::optional<Wing> wing(double share) const {
    const auto curve = geometry::evaluate_jet(*curve_, parameter(share));
    const auto jet = geometry::evaluate_jet(*surface_, curve.point);
    const Vector3 along = jet.du * curve.du.x() + jet.dv * curve.du.y();
    const Vector3 normal = orientation_ * jet.du.cross(jet.dv);
    const double size = jet.du.norm() * jet.dv.norm();
    if (!(normal.norm() > straightness * size) || !(along.norm() > 0.0)) return std::nullopt;
    // What is kept lies on the left of the pcurve, seen against the natural normal.
    const Vector3 inward = orientation_ * normal.cross(along);
    return Wing{jet.point, normal.normalized(), inward.normalized()};
  }
  Point3 position(double share) const {
    return geometry::evaluate(*surface_, geometry::evaluate(*curve_, parameter(share)));
  }

  /// The direction in which the side's parameter is constant, and its value; nothing if neither is.
  std::optional<std::pair<Direction, double>> knot_line() const {
    const geometry::Points<2> net = curve_->control_points();
    for (const Direction d : {Direction::u, Direction::v}) {
      const auto row = net.row(static_cast<int>(d));
      const geometry::Interval domain = surface_->knots(d).domain();
      if (row.maxCoeff() - row.minCoeff() <= straightness * (domain.length()))
        return std::pair(d, std::clamp(row.mean(), domain.first, domain.last));
    }
    return std::nullopt;
  }
  /// Which way the parameter changes into the patch.
  bool increases_inwards(Direction d) const {
    const Vector2 along = geometry::evaluate_jet(*curve_, parameter(0.5)).du;
    return d == Direction::u ? along.y() < 0.0 : along.x() > 0.0;
  }

 private:
  double parameter(double share) const { return domain_.first + share * domain_.length(); }

  const NurbsSurface<3>* surface_;
  const geometry::NurbsCurve<2>* curve_;
  geometry::Interval domain_;
  int orientation_;
};

double nearest_share(const EdgeSide& side, const Point3& point) {
  double nearest = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= partner_samples; ++i) {
    const double share = static_cast<double>(i) / partner_samples;
    const double distance = (side.position(share) - point).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = share;
  }
  return nearest;
}

/// Seen from the first side the second one bends down, by an angle that counts.
bool is_convex_edge(const EdgeSide& first, const EdgeSide& second) {
  return std::ranges::any_of(looks, [&](double share) {
    const std::optional<Wing> here = first.wing(share);
    if (!here) return false;
    const std::optional<Wing> there = second.wing(nearest_share(second, here->position));
    if (!there) return false;
    return there->inward.dot(here->normal) < 0.0 &&
           (here->normal.cross(there->normal).norm() > least_sine || here->normal.dot(there->normal) < 0.0);
  });
}

/// Towards `value` from the next knot on the patch's side of it.
std::vector<double> knots_towards(const NurbsSurface<3>& surface, Direction d, double value, bool increases,
                                  const EdgeGrading& grading) {
  const std::vector<double> breakpoints = surface.knots(d).breakpoints();
  const double tiny = straightness * (breakpoints.back() - breakpoints.front());
  const auto above = std::ranges::find_if(breakpoints, [&](double b) { return b > value + tiny; });
  const auto below = std::find_if(breakpoints.rbegin(), breakpoints.rend(), [&](double b) { return b < value - tiny; });
  if (increases ? above == breakpoints.end() : below == breakpoints.rend()) return {};
  double width = (increases ? *above : *below) - value;
  std::vector<double> knots;
  for (int layer = 0; layer < grading.layers; ++layer) {
    width *= grading.ratio;
    knots.push_back(value + width);
  }
  return knots;
}

/// Of one patch: new knots in each direction.
struct NewKnots {
  std::set<double> u;
  std::set<double> v;
};

void add_side(const geometry::Patch<3>& patch, const EdgeSide& side, const EdgeGrading& grading, NewKnots& knots) {
  if (std::holds_alternative<geometry::ExtractedSurface>(patch.shape)) return;
  const auto line = side.knot_line();
  if (!line) return;
  const Direction d = line->first;
  const std::vector<double> more =
      knots_towards(surface_of(patch.shape), d, line->second, side.increases_inwards(d), grading);
  (d == Direction::u ? knots.u : knots.v).insert(more.begin(), more.end());
}

NurbsSurface<3> with_knots(const NurbsSurface<3>& surface, const NewKnots& knots) {
  const std::vector<double> u(knots.u.begin(), knots.u.end());
  const std::vector<double> v(knots.v.begin(), knots.v.end());
  return geometry::refine_knots(geometry::refine_knots(surface, Direction::u, u), Direction::v, v);
}

}  // namespace

geometry::OrientedBoundary<3> graded_to_edges(const geometry::OrientedBoundary<3>& boundary,
                                              const EdgeGrading& grading) {
  if (grading.layers < 0 || grading.layers > EdgeGrading::max_layers)
    throw InputError(
        fmt::format("found {} layers at edges; expected 0 to {}", grading.layers, EdgeGrading::max_layers));
  if (!(grading.ratio > 0.0 && grading.ratio < 0.5))
    throw InputError(
        fmt::format("found the ratio {} of layers at edges; expected one between 0 and 1/2", grading.ratio));
  const std::vector<geometry::ShapeLoops> loops = geometry::shape_loops(boundary.boundary);
  std::vector<NewKnots> knots(boundary.boundary.patches.size());
  for (const geometry::BoundaryEdge& edge : boundary.topology.edges) {
    const EdgeSide first(boundary.boundary, loops, edge.first);
    const EdgeSide second(boundary.boundary, loops, edge.second);
    if (!is_convex_edge(first, second)) continue;
    for (const auto& [side, use] : {std::pair(&first, &edge.first), std::pair(&second, &edge.second)}) {
      const auto patch = static_cast<std::size_t>(use->patch);
      add_side(boundary.boundary.patches[patch], *side, grading, knots[patch]);
    }
  }
  geometry::OrientedBoundary<3> graded = boundary;
  for (std::size_t p = 0; p < knots.size(); ++p) {
    if (knots[p].u.empty() && knots[p].v.empty()) continue;
    geometry::SurfaceShape& shape = graded.boundary.patches[p].shape;
    const NurbsSurface<3> surface = with_knots(surface_of(shape), knots[p]);
    if (const auto* trimmed = std::get_if<geometry::TrimmedSurface>(&shape))
      shape = geometry::TrimmedSurface(surface, trimmed->loops());
    else
      shape = surface;
  }
  return graded;
}

}  // namespace isorim::solver
