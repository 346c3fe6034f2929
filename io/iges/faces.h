#pragma once

#include <map>
#include <utility>
#include <vector>

#include "io/cad/cad_model.h"
#include "io/iges/entity_reader.h"
#include "io/iges/face_builder.h"

namespace isorim::io::iges {

/// Faces, shells and solids of one file. All throw InputError that names file and entity.
class FaceReader {
 public:
  explicit FaceReader(EntityReader& reader) : reader_(reader) {}

  /// 144, 143, 510, a bounded 108, or a surface that is a face as a whole; placed by its own transformation.
  CadFace face(const Entity& entity);
  /// A 108 form 1 without the 108s of form -1 that a single parent associativity (402 form 9) gives it as holes.
  CadFace plane_with_holes(const Entity& plane, const std::vector<const Entity*>& holes);
  /// From now on the same edge counts as another one.
  void forget_edges() { edges_.clear(); }
  /// The faces of a 514.
  std::vector<CadFace> shell(const Entity& entity);
  /// The faces of all shells of a 186, placed, with colour, level and name of the solid where they have none.
  std::vector<CadFace> solid(const Entity& entity);

 private:
  CadFace trimmed_surface(const Entity& entity);
  CadFace bounded_surface(const Entity& entity);
  CadFace topological_face(const Entity& entity);
  RawLoop plane_boundary(const Entity& plane);
  CadFace whole_surface(const Entity& entity);
  RawLoop curve_on_surface(const Entity& entity, const Entity& surface);
  RawLoop boundary(const Entity& entity);
  RawLoop loop(const Entity& entity);
  std::vector<geometry::NurbsCurve<2>> pcurves(const Entity& entity);
  std::vector<geometry::NurbsCurve<3>> model_curves(const Entity& entity);
  CadOrigin origin(const Entity& entity, Parameters& parameters);

  struct Edge {
    /// Its curve; 0 if it is not there.
    int curve = 0;
    geometry::Point3 start;
    geometry::Point3 end;
    int number = -1;
  };
  const std::vector<Edge>& edges(const Entity& list);
  const geometry::Points<3>& vertices(const Entity& list);
  geometry::Point3 vertex(const Entity& list, int index, const Entity& user);
  geometry::NurbsCurve<3> edge_curve(const Edge& edge, const Entity& list);

  EntityReader& reader_;
  std::map<int, std::vector<Edge>> edges_;
  std::map<int, geometry::Points<3>> vertices_;
  int edge_count_ = 0;
};

}  // namespace isorim::io::iges
