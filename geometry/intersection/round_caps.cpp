#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/angle_gap.h"
#include "geometry/intersection/chebyshev_fit.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/intersection/tool_caps.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/curves.h"

namespace isorim::geometry {
namespace {

constexpr double pi = std::numbers::pi;
/// To which curves in the parameters are met, relative to the parameters' range: points are known to the rounding of
/// the solid's size, seen from the tool's axis or centre at the distance `radius`.
double fit_accuracy(double size, double radius) {
  return 4e-15 * std::max(1.0, size / radius);
}

/// Parameters this near to a border lie on it.
constexpr double border_tolerance = 1e-9;

/// An orthonormal frame, right-handed.
struct Frame {
  Point3 origin;
  Eigen::Matrix3d axes;

  Vector3 local(const Point3& x) const { return axes.transpose() * (x - origin); }
};

/// A frame whose third axis is given; the first points anywhere across.
Frame frame_along(const Point3& origin, const Vector3& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  Frame frame{origin, {}};
  frame.axes.col(2) = axis;
  frame.axes.col(0) = axis.cross(Vector3::Unit(least)).normalized();
  frame.axes.col(1) = axis.cross(frame.axes.col(0)).normalized();
  return frame;
}

using SpaceCurve = std::function<Point3(double)>;

SpaceCurve space_curve(const CapEdge& edge) {
  return [&edge](double s) { return evaluate(edge.surface, evaluate(edge.curve, s)); };
}

/// Where the function changes its sign on [0, 1], with 0 and 1.
std::vector<double> cuts_at_zeros(const std::vector<std::function<double(double)>>& functions, double noise) {
  std::vector<double> cuts{0.0, 1.0};
  for (const auto& function : functions) {
    const SignChart chart = sign_chart(function, noise);
    cuts.insert(cuts.end(), chart.roots.begin(), chart.roots.end());
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end(), [](double a, double b) { return b - a < 1e-10; }), cuts.end());
  cuts.back() = 1.0;
  return cuts;
}

// --- Closing loops along the border of a patch ----------------------------------------------------------------

/// The closed border of a patch's parameters, counter-clockwise, with a position along it in [0, length).
struct Border {
  double length = 0.0;
  /// Nothing for points inside.
  std::function<std::optional<double>(const Point2&)> position;
  /// From one position to another that is not smaller, possibly beyond the length.
  std::function<std::vector<NurbsCurve<2>>(double, double)> walk;
};

/// Joins the curves' ends on the border by the stretches of it that lie in the region on their left.
std::vector<TrimLoop> close_along(const Border& border, std::vector<NurbsCurve<2>> curves, const Vector2& scale,
                                  double tolerance, double closing) {
  std::vector<double> starts;
  std::vector<double> ends;
  for (const NurbsCurve<2>& curve : curves) {
    if (const auto at = border.position(evaluate(curve, 0.0))) starts.push_back(*at);
    if (const auto at = border.position(evaluate(curve, 1.0))) ends.push_back(*at);
  }
  if (starts.size() != ends.size())
    throw GeometryError(fmt::format("clip: {} curves enter the tool's face and {} leave it; is the solid closed there?",
                                    starts.size(), ends.size()));
  for (const double end : ends) {
    // Curves that end on the border where another starts touch it.
    double stretch = border.length;
    for (const double start : starts) {
      double ahead = start - end;
      if (ahead < -border_tolerance) ahead += border.length;
      stretch = std::min(stretch, ahead);
    }
    if (stretch <= border_tolerance) continue;
    std::vector<NurbsCurve<2>> walked = border.walk(end, end + stretch);
    curves.insert(curves.end(), walked.begin(), walked.end());
  }
  std::vector<TrimLoop> loops = chain_directed_curves(curves, scale, tolerance, closing);
  std::erase_if(loops, [&](const TrimLoop& loop) { return std::abs(doubled_area(loop)) <= 1e-14 * scale.prod(); });
  return loops;
}

/// The outermost of the loops is a hole: the border bounds the region.
bool needs_border(const std::vector<TrimLoop>& loops) {
  double largest = 0.0;
  for (const TrimLoop& loop : loops) {
    const double area = doubled_area(loop);
    if (std::abs(area) > std::abs(largest)) largest = area;
  }
  return largest < 0.0;
}

TrimLoop whole(const Border& border) {
  return {border.walk(0.0, border.length)};
}

Border rectangle_border(const NurbsSurface<3>& surface) {
  const Interval u = surface.knots_u().domain();
  const Interval v = surface.knots_v().domain();
  const std::array<Point2, 5> corners{Point2(u.first, v.first), Point2(u.last, v.first), Point2(u.last, v.last),
                                      Point2(u.first, v.last), Point2(u.first, v.first)};
  const auto at = [corners](double position) {
    const double wrapped = position >= 4.0 ? position - 4.0 : position;
    const auto side = std::min<std::size_t>(3, static_cast<std::size_t>(wrapped));
    const double s = wrapped - static_cast<double>(side);
    return Point2(corners[side] + s * (corners[side + 1] - corners[side]));
  };
  Border border;
  border.length = 4.0;
  border.position = [u, v](const Point2& p) -> std::optional<double> {
    const double s = (p.x() - u.first) / u.length();
    const double t = (p.y() - v.first) / v.length();
    if (s >= 1.0 - border_tolerance) return 1.0 + t;
    if (s <= border_tolerance) return 4.0 - t;
    if (t <= border_tolerance) return s;
    if (t >= 1.0 - border_tolerance) return 3.0 - s;
    return std::nullopt;
  };
  border.walk = [at](double from, double to) {
    std::vector<NurbsCurve<2>> lines;
    double here = from;
    while (here < to) {
      const double next = std::min(to, std::floor(here) + 1.0);
      if (next - here > 1e-14) lines.push_back(line_segment<2>(at(here), at(next)));
      here = next;
    }
    return lines;
  };
  return border;
}

Border circle_border() {
  Border border;
  border.length = 2.0 * pi;
  border.position = [](const Point2& p) -> std::optional<double> {
    if (std::abs(p.norm() - 1.0) > border_tolerance) return std::nullopt;
    const double angle = std::atan2(p.y(), p.x());
    return angle < 0.0 ? angle + 2.0 * pi : angle;
  };
  border.walk = [](double from, double to) {
    return std::vector<NurbsCurve<2>>{reparametrise(unit_arc(from, to), {0.0, 1.0})};
  };
  return border;
}

// --- Spheres --------------------------------------------------------------------------------------------------

/// Half of the unit sphere and a little more, seen from the pole of the other half (stereographic projection): rational
/// of degree 2 in each parameter, without a degenerate point; the equator is the unit circle of the parameters.
NurbsSurface<3> half_sphere(const Frame& frame, double radius) {
  constexpr double reach = 1.25;
  const std::array<double, 5> linear{-reach, -0.5 * reach, 0.0, 0.5 * reach, reach};
  const std::array<double, 5> square{reach * reach, 0.0, 0.0, 0.0, reach * reach};
  HomogeneousPoints<3> net(4, 25);
  for (std::size_t j = 0; j < 5; ++j)
    for (std::size_t i = 0; i < 5; ++i) {
      const double squares = square[i] + square[j];
      const Vector3 local = radius * Vector3(2.0 * linear[i], 2.0 * linear[j], 1.0 - squares);
      const double weight = 1.0 + squares;
      net.col(static_cast<Eigen::Index>(i + 5 * j)) << frame.axes * local + weight * frame.origin, weight;
    }
  const KnotVector knots(2, {-reach, -reach, -reach, 0.0, 0.0, reach, reach, reach});
  return {knots, knots, net};
}

/// A frame whose equator is unlikely to meet the edges in special places, and whose first half holds most of them.
Frame sphere_frame(const SphereTool& tool, const std::vector<CapEdge>& edges) {
  Vector3 mean = Vector3::Zero();
  for (const CapEdge& edge : edges)
    for (const double s : {0.0, 0.5}) mean += (space_curve(edge)(s) - tool.centre) / tool.radius;
  if (!edges.empty()) mean /= static_cast<double>(2 * edges.size());
  const Vector3 odd = Vector3(0.5477, -0.3191, 0.7734);
  const Vector3 axis = mean.norm() > 0.1 ? Vector3(mean.normalized() + 0.03 * odd) : odd;
  return frame_along(tool.centre, axis.normalized());
}

/// The edges on one half, in its parameters.
std::vector<NurbsCurve<2>> curves_on_half(const Frame& frame, double radius, const std::vector<CapEdge>& edges,
                                          double size) {
  std::vector<NurbsCurve<2>> curves;
  for (const CapEdge& edge : edges) {
    const SpaceCurve curve = space_curve(edge);
    const auto height = [&](double s) { return frame.local(curve(s)).z() / radius; };
    const std::vector<double> cuts = cuts_at_zeros({height}, 1e-13);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const Interval part{cuts[i], cuts[i + 1]};
      if (height(part.middle()) < 0.0) continue;
      const auto inverse = [&](double s) {
        const Vector3 p = frame.local(curve(part.first + s * part.length())) / radius;
        return Point2(p.head<2>() / (1.0 + p.z()));
      };
      const std::vector<NurbsCurve<2>> pieces = fit_curve(inverse, fit_accuracy(size, radius));
      curves.insert(curves.end(), pieces.begin(), pieces.end());
    }
  }
  return curves;
}

// --- Cylinders and cones --------------------------------------------------------------------------------------

/// A turn about the third axis of the frame, from the first axis round, between two heights; the radius is linear in
/// the height, which is the second parameter.
struct RoundSide {
  Frame frame;
  /// radius(height) = base + slope height.
  double base = 0.0;
  double slope = 0.0;
  Interval heights;
};

NurbsSurface<3> surface_of(const RoundSide& side) {
  const NurbsCurve<2> circle = circle_curve(1.0);
  const HomogeneousPoints<2>& ring = circle.homogeneous();
  HomogeneousPoints<3> net(4, 2 * ring.cols());
  for (Eigen::Index j = 0; j < 2; ++j) {
    const double height = j == 0 ? side.heights.first : side.heights.last;
    const double radius = side.base + side.slope * height;
    for (Eigen::Index i = 0; i < ring.cols(); ++i) {
      const double weight = ring(2, i);
      const Vector3 local(radius * ring(0, i), radius * ring(1, i), weight * height);
      net.col(i + j * ring.cols()) << side.frame.axes * local + weight * side.frame.origin, weight;
    }
  }
  return {circle.knots(), KnotVector(1, {side.heights.first, side.heights.first, side.heights.last, side.heights.last}),
          net};
}

/// Turns the frame's first axis into the middle of the widest gap between the edges' angles, a little off.
void turn_seam_away(Frame& frame, const std::vector<CapEdge>& edges) {
  std::vector<double> angles;
  for (const CapEdge& edge : edges)
    for (int k = 0; k < 8; ++k) {
      const Vector3 p = frame.local(space_curve(edge)(k / 8.0));
      angles.push_back(std::atan2(p.y(), p.x()));
    }
  if (angles.empty()) return;
  const CosineSine turn = cosine_sine(angle_in_widest_gap(std::move(angles), 2.0 * pi));
  const Vector3 first = turn.cosine * frame.axes.col(0) + turn.sine * frame.axes.col(1);
  frame.axes.col(1) = turn.cosine * frame.axes.col(1) - turn.sine * frame.axes.col(0);
  frame.axes.col(0) = first;
}

/// The edges in the parameters of the side, cut where its spans end.
std::vector<NurbsCurve<2>> curves_on_side(const RoundSide& side, const std::vector<CapEdge>& edges, double size) {
  std::vector<NurbsCurve<2>> curves;
  for (const CapEdge& edge : edges) {
    const SpaceCurve curve = space_curve(edge);
    const auto x = [&](double s) { return side.frame.local(curve(s)).x() / size; };
    const auto y = [&](double s) { return side.frame.local(curve(s)).y() / size; };
    const std::vector<double> cuts = cuts_at_zeros({x, y}, 1e-14);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const Interval part{cuts[i], cuts[i + 1]};
      const double middle = std::atan2(y(part.middle()), x(part.middle()));
      const int quarter = static_cast<int>(std::floor((middle < 0.0 ? middle + 2.0 * pi : middle) / (0.5 * pi))) % 4;
      // The first axis of the quarter; angles from it do not wrap round.
      const CosineSine turn = cosine_sine(0.5 * pi * quarter);
      const double radius = std::hypot(x(part.middle()), y(part.middle())) * size;
      const auto inverse = [&](double s) {
        const Vector3 p = side.frame.local(curve(part.first + s * part.length()));
        const double angle =
            std::atan2(turn.cosine * p.y() - turn.sine * p.x(), turn.cosine * p.x() + turn.sine * p.y());
        return Point2(0.25 * (quarter + part_of_quarter(angle)), p.z() / size);
      };
      for (NurbsCurve<2>& piece : fit_curve(inverse, fit_accuracy(size, radius))) {
        AffineMap<2> stretch;
        stretch.linear(1, 1) = size;
        curves.push_back(transform(piece, stretch));
      }
    }
  }
  return curves;
}

Interval heights_of(const std::vector<NurbsCurve<2>>& curves) {
  Interval range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const NurbsCurve<2>& curve : curves) {
    const Points<2> points = curve.control_points();
    range.first = std::min(range.first, points.row(1).minCoeff());
    range.last = std::max(range.last, points.row(1).maxCoeff());
  }
  return range;
}

/// Of a tool that keeps what is outside, the natural normals point away from what is kept.
std::vector<CapEdge> edges_seen_from_outside(std::vector<CapEdge> edges, KeptSide keep) {
  if (keep == KeptSide::outside)
    for (CapEdge& edge : edges) edge.curve = reverse(edge.curve);
  return edges;
}

int cap_orientation(KeptSide keep) {
  return keep == KeptSide::inside ? 1 : -1;
}

std::vector<Patch<3>> side_caps(const RoundSide& side, const std::vector<NurbsCurve<2>>& curves, KeptSide keep,
                                double largest_radius, double size, const ClipOptions& options) {
  NurbsSurface<3> surface = surface_of(side);
  const Border border = rectangle_border(surface);
  // Parameters as lengths.
  const Vector2 scale(1.0 / (2.0 * pi * largest_radius), 1.0);
  std::vector<TrimLoop> loops = close_along(border, curves, scale, options.gap_tolerance * size, 1e-12 * size);
  if (loops.empty()) return {};
  if (needs_border(loops)) loops.push_back(whole(border));
  return {{"cap", TrimmedSurface(std::move(surface), std::move(loops)), cap_orientation(keep)}};
}

}  // namespace

// The inverse of the rational quadratic with weights 1, cos(pi / 4), 1.
double part_of_quarter(double angle) {
  const double part = 0.5 + 0.5 * std::tan(0.5 * angle - 0.125 * pi) / std::tan(0.125 * pi);
  if (part < 1e-14) return 0.0;
  return part > 1.0 - 1e-14 ? 1.0 : part;
}

std::vector<TrimLoop> loops_on_side(const NurbsSurface<3>& side, const std::vector<NurbsCurve<2>>& curves,
                                    const Vector2& scale, double size) {
  const Border border = rectangle_border(side);
  std::vector<TrimLoop> loops = close_along(border, curves, scale, ClipOptions{}.gap_tolerance * size, 1e-12 * size);
  if (needs_border(loops)) loops.push_back(whole(border));
  return loops;
}

std::vector<Patch<3>> sphere_caps(const SphereTool& tool, const std::vector<CapEdge>& edges, double size,
                                  const ClipOptions& options, const PointTest& is_inside) {
  const std::vector<CapEdge> seen = edges_seen_from_outside(edges, tool.keep);
  const Frame upper = sphere_frame(tool, seen);
  Frame lower = upper;
  lower.axes.rightCols<2>() *= -1.0;
  const Border border = circle_border();
  const Vector2 scale = Vector2::Constant(0.5 / tool.radius);
  std::array<std::vector<TrimLoop>, 2> loops;
  std::array<Frame, 2> frames{upper, lower};
  bool meets_border = false;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<NurbsCurve<2>> curves = curves_on_half(frames[half], tool.radius, seen, size);
    meets_border = meets_border || std::any_of(curves.begin(), curves.end(), [&](const NurbsCurve<2>& curve) {
                     return border.position(evaluate(curve, 0.0)).has_value();
                   });
    loops[half] = close_along(border, std::move(curves), scale, options.gap_tolerance * size, 1e-12 * size);
  }
  if (!meets_border) {
    // The equator is inside as a whole or outside as a whole.
    const bool inside = loops[0].empty() && loops[1].empty() ? is_inside(upper.origin + tool.radius * upper.axes.col(0))
                                                             : needs_border(loops[0]) || needs_border(loops[1]);
    if (inside)
      for (std::vector<TrimLoop>& half : loops) half.push_back(whole(border));
  }
  std::vector<Patch<3>> caps;
  for (std::size_t half = 0; half < 2; ++half) {
    if (loops[half].empty()) continue;
    caps.push_back({"cap", TrimmedSurface(half_sphere(frames[half], tool.radius), std::move(loops[half])),
                    cap_orientation(tool.keep)});
  }
  return caps;
}

std::vector<Patch<3>> cylinder_caps(const CylinderTool& tool, const std::vector<CapEdge>& edges, double size,
                                    const ClipOptions& options) {
  if (edges.empty()) return {};
  const std::vector<CapEdge> seen = edges_seen_from_outside(edges, tool.keep);
  RoundSide side{frame_along(tool.point, checks::unit<3>("cylinder", "axis", tool.axis)), tool.radius, 0.0, {}};
  turn_seam_away(side.frame, seen);
  const std::vector<NurbsCurve<2>> curves = curves_on_side(side, seen, size);
  side.heights = heights_of(curves);
  const double margin = 0.02 * side.heights.length() + 1e-3 * tool.radius;
  side.heights = {side.heights.first - margin, side.heights.last + margin};
  return side_caps(side, curves, tool.keep, tool.radius, size, options);
}

std::vector<TrimLoop> loops_beside(const TrimmedSurface& cap, const NurbsSurface<3>& side, double size) {
  const Interval turn = side.knots_u().domain();
  const auto lies_on_seam = [&](const NurbsCurve<2>& curve) {
    const Eigen::ArrayXd u = curve.control_points().row(0).transpose().array();
    return (u - turn.first).abs().maxCoeff() <= border_tolerance ||
           (u - turn.last).abs().maxCoeff() <= border_tolerance;
  };
  std::vector<NurbsCurve<2>> curves;
  for (const TrimLoop& loop : cap.loops()) {
    for (const NurbsCurve<2>& curve : loop.curves)
      if (!lies_on_seam(curve)) curves.push_back(reverse(curve));
  }
  const Point3 first = evaluate(side, Point2(turn.first, side.knots_v().domain().first));
  const Point3 opposite = evaluate(side, Point2(turn.middle(), side.knots_v().domain().first));
  return loops_on_side(side, curves, Vector2(1.0 / (pi * (opposite - first).norm()), 1.0), size);
}

std::vector<Patch<3>> cone_caps(const ConeTool& tool, const std::vector<CapEdge>& edges, double size,
                                const ClipOptions& options) {
  if (edges.empty()) return {};
  const std::vector<CapEdge> seen = edges_seen_from_outside(edges, tool.keep);
  RoundSide side{
      frame_along(tool.apex, checks::unit<3>("cone", "axis", tool.axis)), 0.0, std::tan(tool.half_angle), {}};
  turn_seam_away(side.frame, seen);
  const std::vector<NurbsCurve<2>> curves = curves_on_side(side, seen, size);
  const Interval range = heights_of(curves);
  if (range.first < -options.gap_tolerance * size)
    throw GeometryError(
        fmt::format("clip: the cone's other nappe meets the solid, {:.3g} behind the apex; cut the solid "
                    "by a plane through the apex first",
                    -range.first));
  side.heights = {0.0, 1.02 * range.last};
  return side_caps(side, curves, tool.keep, side.slope * side.heights.last, size, options);
}

}  // namespace isorim::geometry
