#pragma once

#include <map>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "io/iges/entity_list.h"
#include "io/iges/writer.h"

namespace isorim::io::iges {

/// Loops of one face: one that runs round it, and its holes. Indices into trim_loops().
struct FaceLoops {
  int outer = 0;
  std::vector<int> holes;
};

/// The connected pieces of what the loops keep: each counter-clockwise loop with the clockwise ones directly in it.
/// Throws GeometryError for a clockwise one that lies in none.
std::vector<FaceLoops> connected_faces(const std::vector<geometry::TrimLoop>& loops);

/// The entities that faces, loose or in solids, are made of.
class ModelWriter {
 public:
  /// `tolerance` in the units of the shape.
  ModelWriter(const geometry::Boundary<3>& boundary, const WriterOptions& options, double tolerance);

  const geometry::Patch<3>& patch(int index) const { return boundary_.patches[static_cast<std::size_t>(index)]; }
  const std::vector<geometry::TrimLoop>& loops(int patch) const { return loops_[static_cast<std::size_t>(patch)]; }
  EntityList& entities() { return entities_; }

  /// 128; not independent if others point to it.
  int add_surface(int patch, bool is_independent);
  /// 126 in the surface's parameters.
  int add_pcurve(const geometry::NurbsCurve<2>& pcurve);
  /// 126 in space.
  int add_curve(const geometry::NurbsCurve<3>& curve);
  /// The parameter curve on the patch's surface, in space, exact or to the tolerance.
  geometry::NurbsCurve<3> lifted(int patch, const geometry::NurbsCurve<2>& pcurve) const;

  /// A patch as loose faces: 128, 144 over it, or a group of 128s (t_splines.h). Returns their number.
  int add_loose_faces(int patch);

  /// Ends the parameters of an entity that stands for the patch, with its name, and adds it.
  int add_named(int type, Record record, const DirectoryFields& fields, int patch);

 private:
  bool is_point(const geometry::NurbsCurve<3>& curve) const;
  int add_t_spline(int patch, const geometry::ExtractedSurface& surface);
  int add_boundary(int patch, int surface, const geometry::TrimLoop& loop);
  int add_composite(const std::vector<int>& curves, int use);
  int add_name(const std::string& name);
  DirectoryFields look_of(int patch);

  const geometry::Boundary<3>& boundary_;
  const WriterOptions& options_;
  double tolerance_;
  /// trim_loops() of each patch; none of T-splines.
  std::vector<std::vector<geometry::TrimLoop>> loops_;
  EntityList entities_;
  std::map<Colour, int> colours_;
};

/// Adds a manifold solid: an outer shell and its voids, all closed. Returns the number of its faces.
int add_solid(ModelWriter& writer, const geometry::Topology<3>& topology, int outer, const std::vector<int>& voids);

}  // namespace isorim::io::iges
