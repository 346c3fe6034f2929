#include "geometry/trimming/trimmed_surface.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/spline/bspline.h"
#include "geometry/trimming/loop_pieces.h"

namespace isorim::geometry {
namespace {

std::string at(const Point2& uv) {
  return fmt::format("({:.9g}, {:.9g})", uv.x(), uv.y());
}

Point2 start_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().first);
}

Point2 end_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().last);
}

/// The rectangle of the parameters, widened by the tolerance.
struct AllowedParameters {
  Interval u;
  Interval v;
  Vector2 margin;

  explicit AllowedParameters(const NurbsSurface<3>& surface)
      : u(surface.knots_u().domain()),
        v(surface.knots_v().domain()),
        margin(TrimmedSurface::parameter_tolerance * Vector2(u.length(), v.length())) {}

  bool contains(const Point2& uv) const {
    return uv.x() >= u.first - margin.x() && uv.x() <= u.last + margin.x() && uv.y() >= v.first - margin.y() &&
           uv.y() <= v.last + margin.y();
  }
};

/// A point of the piece outside the allowed parameters, if there is one: bisected until the control polygon, which may
/// reach farther out than the curve, is inside.
std::optional<Point2> point_outside(const PlanePiece& piece, const AllowedParameters& allowed, int depth) {
  if (allowed.contains(piece.lower) && allowed.contains(piece.upper)) return std::nullopt;
  for (const Point2& end : {piece.start(), piece.end()})
    if (!allowed.contains(end)) return end;
  constexpr int deepest = 40;
  if (depth == deepest) return std::nullopt;
  const auto [first, second] = bisect(piece);
  if (const std::optional<Point2> outside = point_outside(first, allowed, depth + 1)) return outside;
  return point_outside(second, allowed, depth + 1);
}

void require_inside(const NurbsCurve<2>& curve, const AllowedParameters& allowed, const std::string& which) {
  const Points<2> controls = curve.control_points();
  if (allowed.contains(controls.rowwise().minCoeff()) && allowed.contains(controls.rowwise().maxCoeff())) return;
  for (const BezierSegment& segment : bezier_segments({curve.knots(), curve.homogeneous()})) {
    const std::optional<Point2> outside = point_outside(PlanePiece(segment.coefficients), allowed, 0);
    if (!outside) continue;
    throw GeometryError(
        fmt::format("{} leaves the surface's domain at {}; expected u in [{:.9g}, {:.9g}] and v in [{:.9g}, {:.9g}]",
                    which, at(*outside), allowed.u.first, allowed.u.last, allowed.v.first, allowed.v.last));
  }
}

void require_closed(const TrimLoop& loop, const AllowedParameters& allowed, std::size_t number) {
  for (std::size_t k = 0; k < loop.curves.size(); ++k) {
    const std::size_t next = (k + 1) % loop.curves.size();
    const Point2 end = end_of(loop.curves[k]);
    const Point2 start = start_of(loop.curves[next]);
    if (((end - start).cwiseAbs().array() <= allowed.margin.array()).all()) continue;
    throw GeometryError(
        fmt::format("loop {} is open: curve {} ends at {}, curve {} starts at {} in the surface's "
                    "parameters",
                    number, k + 1, at(end), next + 1, at(start)));
  }
}

void require_area(const std::vector<TrimLoop>& loops, const AllowedParameters& allowed) {
  const std::vector<PlanePiece> pieces = loop_pieces(loops);
  if (pieces.empty()) throw GeometryError("the loops enclose no area of the surface's parameters: all are points");
  const AreaEstimate area = doubled_signed_area(pieces, 1e-15 * allowed.u.length() * allowed.v.length());
  if (area.value > 0.0) return;
  throw GeometryError(
      fmt::format("the loops enclose no area of the surface's parameters: it is {:.3g}; expected outer loops to run "
                  "counter-clockwise and holes clockwise",
                  0.5 * area.value));
}

}  // namespace

TrimmedSurface::TrimmedSurface(NurbsSurface<3> surface, std::vector<TrimLoop> loops)
    : surface_(std::move(surface)), loops_(std::move(loops)) {
  if (loops_.empty()) throw GeometryError("a trimmed surface has no loop; expected one at least");
  const AllowedParameters allowed(surface_);
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (loops_[i].curves.empty()) throw GeometryError(fmt::format("loop {} has no curve", i + 1));
    for (std::size_t k = 0; k < loops_[i].curves.size(); ++k)
      require_inside(loops_[i].curves[k], allowed, fmt::format("curve {} of loop {}", k + 1, i + 1));
    require_closed(loops_[i], allowed, i + 1);
  }
  require_area(loops_, allowed);
}

TrimLoop domain_loop(const NurbsSurface<3>& surface) {
  const Interval u = surface.knots_u().domain();
  const Interval v = surface.knots_v().domain();
  const std::array<Point2, 4> corners{Point2(u.first, v.first), Point2(u.last, v.first), Point2(u.last, v.last),
                                      Point2(u.first, v.last)};
  TrimLoop loop;
  for (std::size_t side = 0; side < 4; ++side) {
    Points<2> ends(2, 2);
    ends << corners[side], corners[(side + 1) % 4];
    loop.curves.push_back(NurbsCurve<2>::from_points(KnotVector::bezier(1), ends));
  }
  return loop;
}

TrimmedSurface transform(const TrimmedSurface& face, const AffineMap<3>& map) {
  return {transform(face.surface(), map), face.loops()};
}

}  // namespace isorim::geometry
