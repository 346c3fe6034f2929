#include <algorithm>
#include <utility>

#include "io/iges/faces.h"

/// Solids with topology: 186, 514, 510, 508, 504, 502.
namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::LoopSides;
using geometry::NurbsCurve;
using geometry::Point3;
using geometry::Points;

const Points<3>& FaceReader::vertices(const Entity& list) {
  const auto known = vertices_.find(list.sequence);
  if (known != vertices_.end()) return known->second;
  if (list.type != 502) reader_.refuse(list, "a list of vertices (502) is expected here");
  Parameters p(reader_.file(), list);
  Points<3> points(3, p.count(3));
  p.reals(std::span<double>(points.data(), static_cast<std::size_t>(points.size())));
  return vertices_.emplace(list.sequence, std::move(points)).first->second;
}

Point3 FaceReader::vertex(const Entity& list, int index, const Entity& user) {
  const Points<3>& points = vertices(list);
  if (index < 1 || index > points.cols())
    reader_.refuse(user,
                   fmt::format("asks for vertex {} of {}, which has {}", index, entity_text(list), points.cols()));
  return points.col(index - 1);
}

const std::vector<FaceReader::Edge>& FaceReader::edges(const Entity& list) {
  const auto known = edges_.find(list.sequence);
  if (known != edges_.end()) return known->second;
  if (list.type != 504) reader_.refuse(list, "a list of edges (504) is expected here");
  Parameters p(reader_.file(), list);
  std::vector<Edge> result(static_cast<std::size_t>(p.count(5)));
  for (Edge& edge : result) {
    edge.curve = p.pointer();
    const Entity& first = p.target();
    edge.start = vertex(first, p.integer(), list);
    const Entity& last = p.target();
    edge.end = vertex(last, p.integer(), list);
    edge.number = edge_count_++;
  }
  return edges_.emplace(list.sequence, std::move(result)).first->second;
}

NurbsCurve<3> FaceReader::edge_curve(const Edge& edge, const Entity& list) {
  const Entity* curve = reader_.file().find(edge.curve);
  if (curve == nullptr) reader_.refuse(list, "one of its edges has no curve");
  // A line without ends gets those of its vertices.
  if (curve->type == 110 && curve->form != 0) return line(edge.start, edge.end).curve;
  return reader_.curve(*curve).curve;
}

RawLoop FaceReader::loop(const Entity& entity) {
  if (entity.type != 508) reader_.refuse(entity, "a loop (508) is expected here");
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  const int count = p.count(5);
  RawLoop result;
  for (int i = 0; i < count; ++i) {
    const bool is_vertex = p.integer() == 1;
    const Entity& list = p.target();
    const int index = p.integer();
    const bool agrees = p.integer(1) != 0;
    const int pcurve_count = p.count(2);
    std::vector<NurbsCurve<2>> in_parameters;
    for (int k = 0; k < pcurve_count; ++k) {
      p.skip();
      for (NurbsCurve<2>& piece : pcurves(p.target())) in_parameters.push_back(std::move(piece));
    }
    RawPiece piece;
    if (!is_vertex) {
      const std::vector<Edge>& all = edges(list);
      if (index < 1 || index > static_cast<int>(all.size()))
        reader_.refuse(entity,
                       fmt::format("asks for edge {} of {}, which has {}", index, entity_text(list), all.size()));
      const Edge& edge = all[static_cast<std::size_t>(index) - 1];
      piece.edge = edge.number;
      // Several curves in parameter space share the edge: its curve in space belongs to none of them.
      if (in_parameters.size() <= 1) {
        piece.model_curve = edge_curve(edge, list);
        if (!agrees) piece.model_curve = reverse(*piece.model_curve);
      }
    }
    if (in_parameters.empty()) {
      if (piece.model_curve) result.push_back(std::move(piece));
      continue;
    }
    for (NurbsCurve<2>& pcurve : in_parameters) {
      piece.pcurve = std::move(pcurve);
      result.push_back(piece);
    }
  }
  return result;
}

CadFace FaceReader::topological_face(const Entity& entity) {
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  const Entity& surface = p.target();
  RawFace face{.surface = reader_.surface(surface),
               .loops = {},
               .directions = PieceDirections::given,
               .sides = LoopSides::left,
               .natural_outer_boundary = false};
  const int count = p.count();
  p.skip();
  for (int i = 0; i < count; ++i) face.loops.push_back(loop(p.target()));
  CadFace result{.face = build_face(std::move(face), entity, reader_), .origin = origin(entity, p)};
  if (!result.origin.colour) result.origin.colour = reader_.colour(surface);
  return result;
}

std::vector<CadFace> FaceReader::shell(const Entity& entity) {
  if (entity.type != 514) reader_.refuse(entity, "a shell (514) is expected here");
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  const int count = p.count(2);
  std::vector<CadFace> result;
  for (int i = 0; i < count; ++i) {
    const Entity& child = p.target();
    // Whether the face's normal or its opposite points outwards; found from the closed shell.
    p.skip();
    if (child.type != 510) reader_.refuse(child, "a face (510) is expected here");
    result.push_back(face(child));
  }
  const CadOrigin own = origin(entity, p);
  for (CadFace& child : result) {
    if (!child.origin.colour) child.origin.colour = own.colour;
    if (child.origin.level == 0) child.origin.level = own.level;
    child.face = transform(child.face, reader_.placement(entity));
  }
  return result;
}

std::vector<CadFace> FaceReader::solid(const Entity& entity) {
  const EntityReader::Visit visit(reader_, entity);
  Parameters p(reader_.file(), entity);
  std::vector<const Entity*> shells{&p.target()};
  p.skip();
  const int voids = p.count(2);
  for (int i = 0; i < voids; ++i) {
    shells.push_back(&p.target());
    p.skip();
  }
  const CadOrigin own = origin(entity, p);
  const AffineMap<3> map = reader_.placement(entity);
  std::vector<CadFace> result;
  for (const Entity* part : shells)
    for (CadFace& child : shell(*part)) {
      child.face = transform(child.face, map);
      if (!child.origin.colour) child.origin.colour = own.colour;
      if (child.origin.level == 0) child.origin.level = own.level;
      if (child.origin.name.empty()) child.origin.name = own.name;
      result.push_back(std::move(child));
    }
  return result;
}

}  // namespace isorim::io::iges
