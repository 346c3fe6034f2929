#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/nurbs/surface.h"
#include "geometry/tessellation/constrained_delaunay.h"
#include "geometry/vocabulary.h"

/// One face as triangles between given points of its edges; for tessellate().
namespace isorim::geometry {

/// A point of a loop: in the parameters, and the number of the vertex that it is in the mesh.
struct LoopPoint {
  Point2 uv;
  int vertex = -1;
};
using LoopPolygon = std::vector<LoopPoint>;

/// The triangulation of a face, which grows; made by fill().
class FilledFace {
 public:
  /// Nothing if the chords of the loops cross or run into one another. `points`: those of the mesh's vertices. The
  /// surface has to outlive it.
  static std::optional<FilledFace> fill(const NurbsSurface<3>& surface, const std::vector<LoopPolygon>& loops,
                                        const std::vector<Point3>& points);

  /// Puts points in until middles of edges and triangles are within the tolerance of the surface (any triangles are, in
  /// a plane), and triangles look where it looks.
  void refine(double tolerance);

  /// Puts the middle of the inner edges between two vertices of the mesh in; whether there were any.
  bool split_between(int a, int b);

  /// Vertices: those of the mesh from 0, points of the face itself -1, -2, ..: own_points()[-1 - vertex].
  std::vector<std::array<int, 3>> triangles() const;
  const std::vector<Point3>& own_points() const { return own_points_; }

 private:
  struct Vertex {
    Point2 uv;
    Point3 point;
    int number = 0;
  };

  FilledFace(const NurbsSurface<3>& surface, ConstrainedDelaunay mesh);
  bool add_loops(const std::vector<LoopPolygon>& loops, const std::vector<Point3>& points);
  void add_seeds();
  bool insert(const Point2& uv);
  const Vertex& vertex(int local) const { return vertices_[static_cast<std::size_t>(local)]; }
  bool is_kept(int triangle) const { return mesh_.triangles()[static_cast<std::size_t>(triangle)].winding == 1; }
  std::optional<Point2> where_to_divide(int triangle, double tolerance) const;
  bool looks_away(const ConstrainedDelaunay::Triangle& triangle, const Point2& middle) const;

  const NurbsSurface<3>* surface_;
  /// The surface lies in a plane, to rounding.
  bool is_flat_;
  ConstrainedDelaunay mesh_;
  /// Of each vertex of mesh_.
  std::vector<Vertex> vertices_;
  std::vector<Point3> own_points_;
};

}  // namespace isorim::geometry
