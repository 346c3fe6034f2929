#include "io/iges/faces.h"

#include <algorithm>
#include <utility>

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::LoopSides;
using geometry::NurbsCurve;
using geometry::Point3;
using geometry::Points;

namespace {

NurbsCurve<2> flat(const NurbsCurve<3>& curve) {
  geometry::HomogeneousPoints<2> net(3, curve.homogeneous().cols());
  net << curve.homogeneous().topRows<2>(), curve.homogeneous().row(3);
  return {curve.knots(), std::move(net)};
}

/// Which of the two representations of a boundary its author prefers.
enum class Preference { parameter_space, model_space };

/// Pairs the pieces if they are equally many; else takes the preferred ones.
RawLoop paired(std::vector<NurbsCurve<2>> pcurves, std::vector<NurbsCurve<3>> model_curves, Preference preference) {
  RawLoop result;
  const bool both = pcurves.size() == model_curves.size();
  const bool take_pcurves =
      both || model_curves.empty() || (preference == Preference::parameter_space && !pcurves.empty());
  const std::size_t count = take_pcurves ? pcurves.size() : model_curves.size();
  for (std::size_t i = 0; i < count; ++i) {
    RawPiece piece;
    if (take_pcurves) piece.pcurve = std::move(pcurves[i]);
    if (both || !take_pcurves) piece.model_curve = std::move(model_curves[i]);
    result.push_back(std::move(piece));
  }
  return result;
}

}  // namespace

CadOrigin FaceReader::origin(const Entity& entity, Parameters& parameters) {
  CadOrigin result;
  result.entity = entity_text(entity);
  result.name = reader_.name(parameters);
  result.colour = reader_.colour(entity);
  result.level = reader_.level(entity);
  return result;
}

std::vector<NurbsCurve<3>> FaceReader::model_curves(const Entity& entity) {
  std::vector<NurbsCurve<3>> result;
  for (ParametrisedCurve& piece : reader_.curve_pieces(entity)) result.push_back(std::move(piece.curve));
  return result;
}

std::vector<NurbsCurve<2>> FaceReader::pcurves(const Entity& entity) {
  std::vector<NurbsCurve<2>> result;
  for (const ParametrisedCurve& piece : reader_.curve_pieces(entity)) result.push_back(flat(piece.curve));
  return result;
}

CadFace FaceReader::face(const Entity& entity) {
  CadFace result = [&] {
    switch (entity.type) {
      case 143:
        return bounded_surface(entity);
      case 144:
        return trimmed_surface(entity);
      case 510:
        return topological_face(entity);
      default:
        return entity.type == 108 && entity.form != 0 ? plane_with_holes(entity, {}) : whole_surface(entity);
    }
  }();
  // Surfaces have been placed with the rest of their geometry.
  const bool is_trimmed = entity.type == 143 || entity.type == 144 || entity.type == 510;
  if (is_trimmed) result.face = transform(result.face, reader_.placement(entity));
  return result;
}

RawLoop FaceReader::curve_on_surface(const Entity& entity, const Entity& surface) {
  if (entity.type != 142) reader_.refuse(entity, "a curve on a parametric surface (142) is expected here");
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  p.skip();
  const int carrier = p.pointer();
  if (carrier != 0 && carrier != surface.sequence)
    reader_.remark("lies on another surface than the one that it trims; it is taken for a curve on the latter", entity);
  const Entity* in_parameters = reader_.file().find(p.pointer());
  const Entity* in_space = reader_.file().find(p.pointer());
  const Preference preference = p.integer(0) == 2 ? Preference::model_space : Preference::parameter_space;
  if (in_parameters == nullptr && in_space == nullptr) reader_.refuse(entity, "has no curve");
  RawLoop result = paired(in_parameters != nullptr ? pcurves(*in_parameters) : std::vector<NurbsCurve<2>>{},
                          in_space != nullptr ? model_curves(*in_space) : std::vector<NurbsCurve<3>>{}, preference);
  if (result.empty()) reader_.refuse(entity, "its composite curves hold no curves");
  const AffineMap<3> map = reader_.placement(entity);
  for (RawPiece& piece : result)
    if (piece.model_curve && entity.transformation != 0) piece.model_curve = transform(*piece.model_curve, map);
  return result;
}

CadFace FaceReader::trimmed_surface(const Entity& entity) {
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  const Entity& surface = p.target();
  const bool has_outer = p.integer(1) != 0;
  const int holes = p.count();
  const int outer = p.pointer(0);
  RawFace face{.surface = reader_.surface(surface),
               .loops = {},
               .directions = PieceDirections::from_ends,
               .sides = LoopSides::outer_first,
               .natural_outer_boundary = !has_outer || outer == 0};
  if (has_outer && outer == 0)
    reader_.remark("has no outer boundary though it says so (N1 = 1); the surface's own is taken", entity);
  if (!has_outer && outer != 0)
    reader_.remark("names an outer boundary though it says that there is none (N1 = 0); the surface's own is taken",
                   entity);
  if (!face.natural_outer_boundary) face.loops.push_back(curve_on_surface(*reader_.file().find(outer), surface));
  for (int i = 0; i < holes; ++i) face.loops.push_back(curve_on_surface(p.target(), surface));
  CadFace result{.face = build_face(std::move(face), entity, reader_), .origin = origin(entity, p)};
  if (!result.origin.colour) result.origin.colour = reader_.colour(surface);
  return result;
}

RawLoop FaceReader::boundary(const Entity& entity) {
  if (entity.type != 141) reader_.refuse(entity, "a boundary (141) is expected here");
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  p.skip();
  const Preference preference = p.integer(0) == 1 ? Preference::model_space : Preference::parameter_space;
  p.pointer();
  const int count = p.count(3);
  RawLoop result;
  for (int i = 0; i < count; ++i) {
    const Entity& curve = p.target();
    const bool backwards = p.integer(1) == 2;
    std::vector<NurbsCurve<2>> in_parameters;
    for (const int pointer : p.pointers(p.count())) {
      const Entity* pcurve = reader_.file().find(pointer);
      if (pcurve == nullptr) continue;
      for (NurbsCurve<2>& piece : pcurves(*pcurve)) in_parameters.push_back(std::move(piece));
    }
    std::vector<NurbsCurve<3>> in_space = model_curves(curve);
    if (backwards) {
      std::ranges::reverse(in_space);
      for (NurbsCurve<3>& piece : in_space) piece = reverse(piece);
    }
    for (RawPiece& piece : paired(std::move(in_parameters), std::move(in_space), preference))
      result.push_back(std::move(piece));
  }
  if (result.empty()) reader_.refuse(entity, "has no curves");
  return result;
}

CadFace FaceReader::bounded_surface(const Entity& entity) {
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  p.skip();
  const Entity& surface = p.target();
  RawFace face{.surface = reader_.surface(surface),
               .loops = {},
               .directions = PieceDirections::given,
               .sides = LoopSides::left,
               .natural_outer_boundary = false};
  const int count = p.count();
  for (int i = 0; i < count; ++i) face.loops.push_back(boundary(p.target()));
  CadFace result{.face = build_face(std::move(face), entity, reader_), .origin = origin(entity, p)};
  if (!result.origin.colour) result.origin.colour = reader_.colour(surface);
  return result;
}

RawLoop FaceReader::plane_boundary(const Entity& plane) {
  Parameters p(reader_.file(), plane);
  p.skip(4);
  const AffineMap<3> map = reader_.placement(plane);
  RawLoop loop;
  for (const NurbsCurve<3>& piece : model_curves(p.target()))
    loop.push_back({.pcurve = std::nullopt, .model_curve = transform(piece, map)});
  return loop;
}

CadFace FaceReader::plane_with_holes(const Entity& plane, const std::vector<const Entity*>& holes) {
  RawFace face{.surface = reader_.surface(plane),
               .loops = {plane_boundary(plane)},
               .directions = PieceDirections::from_ends,
               .sides = LoopSides::outer_first,
               .natural_outer_boundary = false};
  for (const Entity* hole : holes) face.loops.push_back(plane_boundary(*hole));
  Parameters p(reader_.file(), plane);
  p.skip(std::min(9, p.remaining()));
  return {.face = build_face(std::move(face), plane, reader_), .origin = origin(plane, p)};
}

CadFace FaceReader::whole_surface(const Entity& entity) {
  RawFace face{.surface = reader_.surface(entity), .loops = {}};
  CadFace result{.face = build_face(std::move(face), entity, reader_), .origin = {}};
  result.origin.entity = entity_text(entity);
  result.origin.name = reader_.spline_name(entity);
  result.origin.colour = reader_.colour(entity);
  result.origin.level = reader_.level(entity);
  return result;
}

}  // namespace isorim::io::iges
