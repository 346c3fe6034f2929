#include "geometry/tessellation/tessellation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/tessellation/edge_division.h"
#include "geometry/tessellation/face_filling.h"
#include "geometry/topology/shape_loops.h"

namespace isorim::geometry {
namespace {

/// A surface and the loops of it that bound one face: of an extracted surface every element is a face.
struct Face {
  int patch = 0;
  std::vector<int> loops;
};

std::vector<Face> faces_of(const Boundary<3>& boundary, const std::vector<ShapeLoops>& loops) {
  std::vector<Face> faces;
  for (std::size_t k = 0; k < boundary.patches.size(); ++k) {
    const bool is_extracted = std::holds_alternative<ExtractedSurface>(boundary.patches[k].shape);
    if (!is_extracted) faces.push_back({static_cast<int>(k), {}});
    for (std::size_t i = 0; i < loops[k].size(); ++i) {
      if (is_extracted) faces.push_back({static_cast<int>(k), {}});
      faces.back().loops.push_back(static_cast<int>(i));
    }
  }
  return faces;
}

/// Degenerate curves have the vertex that the curves before and after them meet in.
void fill_in_poles(LoopPolygon& polygon) {
  const auto known = std::ranges::find_if(polygon, [](const LoopPoint& point) { return point.vertex >= 0; });
  if (known == polygon.end()) {
    polygon.clear();
    return;
  }
  std::rotate(polygon.begin(), known, polygon.end());
  for (std::size_t i = 1; i < polygon.size(); ++i)
    if (polygon[i].vertex < 0) polygon[i].vertex = polygon[i - 1].vertex;
}

LoopPolygon polygon_of(int patch, int loop, const ShapeLoops& loops, const DividedEdges& edges) {
  LoopPolygon polygon;
  const auto count = static_cast<int>(loops.loop(loop).curves.size());
  for (int curve = 0; curve < count; ++curve) {
    const NurbsCurve<2>& pcurve = loops.curve(loop, curve);
    const auto uses = edges.uses.find({patch, loop, curve});
    if (uses == edges.uses.end()) {
      polygon.push_back({evaluate(pcurve, pcurve.domain().first), -1});
      polygon.push_back({evaluate(pcurve, pcurve.domain().last), -1});
      continue;
    }
    for (const DividedUse& use : uses->second)
      for (std::size_t i = 0; i < use.vertices.size(); ++i)
        polygon.push_back({evaluate(pcurve, use.parameters[i]), use.vertices[i]});
  }
  fill_in_poles(polygon);
  return polygon;
}

/// Tells an edge of triangles by its vertices.
using EdgeKey = std::pair<int, int>;

class Tessellator {
 public:
  Tessellator(const OrientedBoundary<3>& oriented, double tolerance)
      : oriented_(oriented),
        loops_(shape_loops(oriented.boundary)),
        faces_(faces_of(oriented.boundary, loops_)),
        tolerance_(tolerance),
        refinement_(oriented.boundary.patches.size(), 1.0) {}

  TriangleMesh run() {
    fill_faces();
    for (FilledFace& face : filled_) face.refine(tolerance_);
    constexpr int most_rounds = 8;
    TriangleMesh mesh = assemble();
    for (int round = 0; round < most_rounds && part_faces(mesh); ++round) mesh = assemble();
    require_watertight(mesh);
    return mesh;
  }

 private:
  const std::string& name_of(int patch) const {
    return oriented_.boundary.patches[static_cast<std::size_t>(patch)].name;
  }

  /// All of them, with edges as finely divided as it takes.
  void fill_faces() {
    constexpr int most_rounds = 8;
    for (int round = 0;; ++round) {
      edges_ = divide_edges(oriented_, loops_, tolerance_, refinement_);
      filled_.clear();
      int failed = -1;
      for (const Face& face : faces_) {
        std::optional<FilledFace> filled = fill(face);
        if (filled) {
          filled_.push_back(std::move(*filled));
          continue;
        }
        failed = face.patch;
        refinement_[static_cast<std::size_t>(face.patch)] *= 4.0;
      }
      if (failed < 0) return;
      if (round == most_rounds)
        throw NumericalError(fmt::format("tessellation: the chords of the edges of \"{}\" cross however short they are",
                                         name_of(failed)));
    }
  }

  std::optional<FilledFace> fill(const Face& face) const {
    const ShapeLoops& loops = loops_[static_cast<std::size_t>(face.patch)];
    std::vector<LoopPolygon> polygons;
    for (const int loop : face.loops) {
      LoopPolygon polygon = polygon_of(face.patch, loop, loops, edges_);
      if (!polygon.empty()) polygons.push_back(std::move(polygon));
    }
    if (polygons.empty()) return std::nullopt;
    return FilledFace::fill(loops.surface(face.loops.front()), polygons, edges_.vertices);
  }

  TriangleMesh assemble() const {
    std::size_t count = edges_.vertices.size();
    for (const FilledFace& face : filled_) count += face.own_points().size();
    TriangleMesh mesh;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(count));
    Eigen::Index next = 0;
    for (const Point3& point : edges_.vertices) mesh.vertices.col(next++) = point;
    for (std::size_t k = 0; k < filled_.size(); ++k) {
      const auto first = static_cast<int>(next);
      for (const Point3& point : filled_[k].own_points()) mesh.vertices.col(next++) = point;
      const int patch = faces_[k].patch;
      const bool is_turned = oriented_.boundary.patches[static_cast<std::size_t>(patch)].orientation < 0;
      for (std::array<int, 3> triangle : filled_[k].triangles()) {
        for (int& vertex : triangle)
          if (vertex < 0) vertex = first - 1 - vertex;
        if (is_turned) std::swap(triangle[1], triangle[2]);
        mesh.triangles.push_back(triangle);
        mesh.patches.push_back(patch);
      }
    }
    return mesh;
  }

  /// How often each edge is run through, less how often the other way; and how often at all.
  struct Traffic {
    int balance = 0;
    int count = 0;
    int patch = 0;
  };
  static std::map<EdgeKey, Traffic> traffic(const TriangleMesh& mesh) {
    std::map<EdgeKey, Traffic> all;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int a = mesh.triangles[k][i];
        const int b = mesh.triangles[k][(i + 1) % 3];
        Traffic& edge = all[std::minmax(a, b)];
        edge.balance += a < b ? 1 : -1;
        ++edge.count;
        edge.patch = mesh.patches[k];
      }
    }
    return all;
  }

  /// Faces that share two vertices may both have an edge between them, which then joins four triangles.
  bool part_faces(const TriangleMesh& mesh) {
    bool found = false;
    for (const auto& [edge, use] : traffic(mesh)) {
      if (use.count <= 2) continue;
      for (FilledFace& face : filled_) {
        if (face.split_between(edge.first, edge.second) || face.split_between(edge.second, edge.first)) found = true;
      }
    }
    return found;
  }

  void require_watertight(const TriangleMesh& mesh) const {
    for (const auto& [edge, use] : traffic(mesh)) {
      if (use.count == 2 && use.balance == 0) continue;
      const Point3 place = mesh.vertices.col(edge.first);
      throw NumericalError(
          fmt::format("tessellation: {} triangles share an edge of \"{}\" at ({:.6g}, {:.6g}, {:.6g}); expected 2",
                      use.count, name_of(use.patch), place.x(), place.y(), place.z()));
    }
  }

  const OrientedBoundary<3>& oriented_;
  std::vector<ShapeLoops> loops_;
  std::vector<Face> faces_;
  double tolerance_;
  /// By which the edges of each patch are divided more finely.
  std::vector<double> refinement_;
  DividedEdges edges_;
  /// In the order of faces_.
  std::vector<FilledFace> filled_;
};

}  // namespace

TriangleMesh tessellate(const OrientedBoundary<3>& oriented, const TessellationOptions& options) {
  require_closed(oriented);
  if (!(options.chord_tolerance >= 0.0) || !std::isfinite(options.chord_tolerance))
    throw GeometryError(fmt::format("tessellation: tolerance is {}, it must be positive", options.chord_tolerance));
  const double tolerance =
      options.chord_tolerance > 0.0
          ? options.chord_tolerance
          : TessellationOptions::default_chord * bounding_box(bezier_elements(oriented.boundary)).diagonal();
  return Tessellator(oriented, tolerance).run();
}

}  // namespace isorim::geometry
