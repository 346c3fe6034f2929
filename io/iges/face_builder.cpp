#include "io/iges/face_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "io/iges/pcurves.h"

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Interval;
using geometry::LooseFace;
using geometry::LooseLoop;
using geometry::LoosePiece;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Range {
  double first = infinity;
  double last = -infinity;

  void add(double t) {
    first = std::min(first, t);
    last = std::max(last, t);
  }
  bool empty() const { return !(first <= last); }
  double middle() const { return 0.5 * (first + last); }
};

struct Box {
  Range u;
  Range v;
};

Box pcurve_box(const std::vector<RawLoop>& loops) {
  Box box;
  for (const RawLoop& loop : loops)
    for (const RawPiece& piece : loop) {
      if (!piece.pcurve) continue;
      const Points<2> points = piece.pcurve->control_points();
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        box.u.add(points(0, i));
        box.v.add(points(1, i));
      }
    }
  return box;
}

double size_of(const RawFace& face, const NurbsSurface<3>& surface) {
  double size = 0.0;
  for (const RawLoop& loop : face.loops)
    for (const RawPiece& piece : loop)
      if (piece.model_curve) size = std::max(size, extent(piece.model_curve->control_points()));
  return size > 0.0 ? size : extent(surface.control_points());
}

template <int Dim>
geometry::Point<Dim> at_fraction(const NurbsCurve<Dim>& curve, double part) {
  const Interval domain = curve.domain();
  if (part == 0.0) return evaluate(curve, domain.first);
  if (part == 1.0) return evaluate(curve, domain.last);
  return evaluate(curve, domain.first + part * domain.length());
}

// --- surfaces without ends ---

bool is_straight(const NurbsCurve<3>& curve) {
  return curve.degree() == 1;
}

/// Turns the axes of a plane whose parameters nobody uses, so that its first straight edge runs along x.
void align_plane(AnalyticSurface& plane, const std::vector<RawLoop>& loops) {
  for (const RawLoop& loop : loops)
    for (const RawPiece& piece : loop) {
      if (!piece.model_curve || !is_straight(*piece.model_curve)) continue;
      const Points<3> points = piece.model_curve->control_points();
      const Vector3 along = points.col(1) - points.col(0);
      const Vector3 normal = plane.frame.x.cross(plane.frame.y);
      const Vector3 across = along - along.dot(normal) * normal;
      if (!(across.norm() > 0.5 * along.norm()) || along.isZero(0.0)) continue;
      plane.frame.x = across.normalized();
      plane.frame.y = normal.cross(plane.frame.x);
      return;
    }
}

/// The direction in which most of the curves lie as seen from the axis, as an angle in degrees; where the seam should
/// not be.
std::optional<double> middle_angle(const AnalyticSurface& surface, const std::vector<RawLoop>& loops, int coordinate) {
  geometry::Vector2 sum = geometry::Vector2::Zero();
  int count = 0;
  for (const RawLoop& loop : loops)
    for (const RawPiece& piece : loop) {
      if (!piece.model_curve) continue;
      for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const double angle =
            parameters_of(surface, at_fraction(*piece.model_curve, part))(coordinate) * std::numbers::pi / 180.0;
        sum += geometry::Vector2(std::cos(angle), std::sin(angle));
        ++count;
      }
    }
  if (count == 0 || sum.norm() < 0.3 * count) return std::nullopt;
  return std::atan2(sum.y(), sum.x()) * 180.0 / std::numbers::pi;
}

/// Whether all curves in space are straight lines and polygons.
bool all_straight(const std::vector<RawLoop>& loops) {
  for (const RawLoop& loop : loops)
    for (const RawPiece& piece : loop)
      if (piece.model_curve && !is_straight(*piece.model_curve)) return false;
  return true;
}

/// What the loops need of a surface without ends.
ParameterBox needed_box(const AnalyticSurface& surface, const std::vector<RawLoop>& loops) {
  Box box = pcurve_box(loops);
  const bool lengths_u = surface.kind == AnalyticKind::plane;
  const bool lengths_v = surface.kind == AnalyticKind::plane || surface.kind == AnalyticKind::cylinder ||
                         surface.kind == AnalyticKind::cone;
  // Curves lie in the hull of their control points, and so do their distances along straight axes.
  for (const RawLoop& loop : loops)
    for (const RawPiece& piece : loop) {
      if (piece.pcurve || !piece.model_curve) continue;
      const Points<3> points = piece.model_curve->control_points();
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Point2 uv = parameters_of(surface, points.col(i));
        if (lengths_u) box.u.add(uv.x());
        if (lengths_v) box.v.add(uv.y());
      }
    }
  const auto angle_range = [&](const Range& range, int coordinate) -> Interval {
    if (!range.empty()) return {range.first, range.last};
    const std::optional<double> middle = middle_angle(surface, loops, coordinate);
    if (!middle) return {0.0, 360.0};
    return {*middle - 180.0, *middle + 180.0};
  };
  ParameterBox needed;
  needed.u = lengths_u ? Interval{box.u.first, box.u.last} : angle_range(box.u, 0);
  needed.v = lengths_v ? Interval{box.v.first, box.v.last}
                       : (surface.kind == AnalyticKind::torus ? angle_range(box.v, 1) : Interval{-90.0, 90.0});
  if (surface.kind == AnalyticKind::plane && !all_straight(loops)) {
    // Round edges should not touch the sides of the rectangle.
    const double margin = 0.03125 * std::max(needed.u.length(), needed.v.length());
    needed.u = {needed.u.first - margin, needed.u.last + margin};
    needed.v = {needed.v.first - margin, needed.v.last + margin};
  }
  return needed;
}

ParametrisedSurface with_ends(RawFace& face) {
  if (const ParametrisedSurface* surface = std::get_if<ParametrisedSurface>(&face.surface)) return *surface;
  AnalyticSurface surface = std::get<AnalyticSurface>(face.surface);
  bool has_pcurves = false;
  for (RawLoop& loop : face.loops)
    for (RawPiece& piece : loop) {
      if (!surface.parametrised) {
        if (piece.pcurve && !piece.model_curve)
          throw GeometryError("a curve is given in the parameters of a surface for which the file defines none");
        piece.pcurve.reset();
      }
      has_pcurves = has_pcurves || piece.pcurve.has_value();
    }
  if (surface.kind == AnalyticKind::plane && !has_pcurves) align_plane(surface, face.loops);
  return finite_part(surface, needed_box(surface, face.loops));
}

// --- which parameters are meant ---

/// The parameters with their angles on the turn where the curves are.
SurfaceParameters on_turn(SurfaceParameters parameters, const Box& box) {
  const auto shifted = [](const ParameterMap& map, const std::optional<double>& turn, const Range& range) {
    if (!turn || range.empty() || map.is_identity()) return map;
    const Interval domain = map.domain();
    const double rounding = 1e-6 * *turn;
    if (range.first >= domain.first - rounding && range.last <= domain.last + rounding) return map;
    const double turns = std::round((domain.middle() - range.middle()) / *turn);
    return turns == 0.0 ? map : map.shifted(turns * *turn);
  };
  parameters.u = shifted(parameters.u, parameters.turn_u, box.u);
  parameters.v = shifted(parameters.v, parameters.turn_v, box.v);
  return parameters;
}

Point3 image(const NurbsSurface<3>& surface, const SurfaceParameters& parameters, const Point2& uv) {
  return evaluate(surface, {parameters.u(uv.x()), parameters.v(uv.y())});
}

/// How badly curves in parameter space and in space fit each other; less than 0 if there are no pairs.
double mismatch(const NurbsSurface<3>& surface, const SurfaceParameters& parameters,
                const std::vector<RawLoop>& loops) {
  double sum = 0.0;
  int pairs = 0;
  for (const RawLoop& loop : loops)
    for (const RawPiece& piece : loop) {
      if (!piece.pcurve || !piece.model_curve) continue;
      const Point3 first = image(surface, parameters, at_fraction(*piece.pcurve, 0.0));
      const Point3 last = image(surface, parameters, at_fraction(*piece.pcurve, 1.0));
      const Point3 start = at_fraction(*piece.model_curve, 0.0);
      const Point3 end = at_fraction(*piece.model_curve, 1.0);
      sum += std::min((first - start).norm() + (last - end).norm(), (first - end).norm() + (last - start).norm());
      ++pairs;
    }
  return pairs == 0 ? -1.0 : sum / pairs;
}

/// How far the curves in parameter space leave the domain, relative to its lengths.
double overshoot(const NurbsSurface<3>& surface, const SurfaceParameters& parameters, const Box& box) {
  const auto along = [](const ParameterMap& map, const Interval& domain, const Range& range) {
    if (range.empty()) return 0.0;
    const double below = domain.first - map(range.first);
    const double above = map(range.last) - domain.last;
    return std::max({0.0, below, above}) / domain.length();
  };
  return along(parameters.u, surface.knots_u().domain(), box.u) +
         along(parameters.v, surface.knots_v().domain(), box.v);
}

SurfaceParameters meant_parameters(const ParametrisedSurface& surface, const RawFace& face, const Entity& entity,
                                   EntityReader& reader) {
  const Box box = pcurve_box(face.loops);
  SurfaceParameters best = on_turn(surface.parameters, box);
  if (surface.alternatives.empty() || box.u.empty()) return best;
  const auto misfit = [&](const SurfaceParameters& parameters) {
    const double distance = mismatch(surface.surface, parameters, face.loops);
    if (distance >= 0.0) return distance / size_of(face, surface.surface);
    return overshoot(surface.surface, parameters, box);
  };
  double least = misfit(best);
  if (least <= 1e-4) return best;
  for (const SurfaceParameters& alternative : surface.alternatives) {
    const SurfaceParameters candidate = on_turn(alternative, box);
    const double value = misfit(candidate);
    if (!(value < 0.1 * least)) continue;
    least = value;
    best = candidate;
    reader.remark(
        "its curves in parameter space follow another convention than the standard's for this surface; they "
        "are understood as they fit",
        entity);
  }
  return best;
}

// --- pieces ---

bool has_no_length(const RawPiece& piece) {
  const auto all_same = [](const auto& points) { return ((points.colwise() - points.col(0)).array() == 0.0).all(); };
  if (piece.pcurve) return all_same(piece.pcurve->control_points());
  return !piece.model_curve || all_same(piece.model_curve->control_points());
}

/// Turns the curve in space to run as its partner does, or drops it if it lies elsewhere.
void pair_up(RawPiece& piece, const NurbsSurface<3>& surface, const SurfaceParameters& parameters, double size,
             bool& dropped) {
  if (!piece.pcurve || !piece.model_curve) return;
  const auto distance = [&](bool turned) {
    double sum = 0.0;
    for (const double part : {0.0, 0.25, 0.75, 1.0})
      sum += (image(surface, parameters, at_fraction(*piece.pcurve, part)) -
              at_fraction(*piece.model_curve, turned ? 1.0 - part : part))
                 .norm();
    return sum;
  };
  if (distance(true) < 0.5 * distance(false)) piece.model_curve = reverse(*piece.model_curve);
  const double ends =
      (image(surface, parameters, at_fraction(*piece.pcurve, 0.0)) - at_fraction(*piece.model_curve, 0.0)).norm() +
      (image(surface, parameters, at_fraction(*piece.pcurve, 1.0)) - at_fraction(*piece.model_curve, 1.0)).norm();
  if (ends > 0.1 * size) {
    piece.model_curve.reset();
    dropped = true;
  }
}

struct Ends {
  Point3 first;
  Point3 last;
};

Ends ends_of(const RawPiece& piece, const NurbsSurface<3>& surface, const SurfaceParameters& parameters) {
  if (piece.pcurve)
    return {image(surface, parameters, at_fraction(*piece.pcurve, 0.0)),
            image(surface, parameters, at_fraction(*piece.pcurve, 1.0))};
  return {at_fraction(*piece.model_curve, 0.0), at_fraction(*piece.model_curve, 1.0)};
}

RawPiece turned(const RawPiece& piece) {
  RawPiece result = piece;
  if (piece.pcurve) result.pcurve = reverse(*piece.pcurve);
  if (piece.model_curve) result.model_curve = reverse(*piece.model_curve);
  return result;
}

/// Turns pieces that were written backwards, so that each starts where the one before ends.
int chain(RawLoop& loop, const NurbsSurface<3>& surface, const SurfaceParameters& parameters, double size) {
  int count = 0;
  const double same = 1e-6 * size;
  const auto ends = [&](std::size_t i) { return ends_of(loop[i], surface, parameters); };
  const auto turn = [&](std::size_t i) {
    loop[i] = turned(loop[i]);
    ++count;
  };
  if (loop.size() > 1) {
    const Ends a = ends(0);
    const Ends b = ends(1);
    const double as_is = std::min((a.last - b.first).norm(), (a.last - b.last).norm());
    const double other = std::min((a.first - b.first).norm(), (a.first - b.last).norm());
    if (as_is > same && other < 0.5 * as_is && loop.size() > 2) turn(0);
  }
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const Point3 before = ends(i - 1).last;
    const Ends here = ends(i);
    const double gap = (here.first - before).norm();
    if (gap > same && (here.last - before).norm() < 0.5 * gap) turn(i);
  }
  return count;
}

LooseLoop mapped_loop(const RawLoop& loop, const NurbsSurface<3>& surface, const SurfaceParameters& parameters,
                      double& deviation, int& fitted) {
  LooseLoop result;
  for (const RawPiece& piece : loop) {
    LoosePiece mapped{.pcurve = std::nullopt, .model_curve = piece.model_curve, .edge = piece.edge};
    if (piece.pcurve) {
      MappedPcurve curve =
          map_pcurve(*piece.pcurve, parameters.u, parameters.v, surface.knots_u().domain(), surface.knots_v().domain());
      if (curve.deviation > 0.0) ++fitted;
      deviation = std::max(deviation, curve.deviation);
      mapped.pcurve = std::move(curve.curve);
    }
    result.pieces.push_back(std::move(mapped));
  }
  return result;
}

LooseFace build(RawFace& face, const Entity& entity, EntityReader& reader) {
  const ParametrisedSurface surface = with_ends(face);
  const SurfaceParameters parameters = meant_parameters(surface, face, entity, reader);
  const double size = size_of(face, surface.surface);
  LooseFace result{.surface = surface.surface,
                   .loops = {},
                   .sides = face.sides,
                   .natural_outer_boundary = face.natural_outer_boundary};
  double deviation = 0.0;
  int fitted = 0;
  for (RawLoop& loop : face.loops) {
    const bool had_pieces = !loop.empty();
    std::erase_if(loop, has_no_length);
    if (loop.empty()) {
      if (had_pieces) reader.remark("one of its loops has no length and is left out", entity);
      continue;
    }
    bool dropped = false;
    for (RawPiece& piece : loop) pair_up(piece, surface.surface, parameters, size, dropped);
    if (dropped)
      reader.remark("curves in space lie elsewhere than their partners in parameter space; the latter are taken",
                    entity);
    if (face.directions == PieceDirections::from_ends && chain(loop, surface.surface, parameters, size) > 0)
      reader.remark("pieces of its loops were written backwards and are turned", entity);
    result.loops.push_back(mapped_loop(loop, surface.surface, parameters, deviation, fitted));
  }
  const double lengths = extent(surface.surface.control_points());
  if (fitted > 0) reader.fitted_pcurves(entity, fitted, pcurve_tolerance * lengths, deviation * lengths);
  return result;
}

}  // namespace

LooseFace build_face(RawFace face, const Entity& entity, EntityReader& reader) {
  return reader.named(entity, [&] { return build(face, entity, reader); });
}

LooseFace transform(const LooseFace& face, const AffineMap<3>& map) {
  if (map.linear.isIdentity(0.0) && map.translation.isZero(0.0)) return face;
  LooseFace result = face;
  result.surface = transform(face.surface, map);
  for (LooseLoop& loop : result.loops)
    for (LoosePiece& piece : loop.pieces)
      if (piece.model_curve) piece.model_curve = transform(*piece.model_curve, map);
  return result;
}

}  // namespace isorim::io::iges
