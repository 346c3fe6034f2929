#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A triangulation of a rectangle in which given segments are edges, and into which points can be put at any time.
///
/// Points are rounded to a grid of 2^-40 of the rectangle's sides, on which all questions of position are answered
/// exactly, so no arrangement of points can break it. Triangles are Delaunay's, but for the segments, in a metric that
/// stretches the two directions (Lawson 1977; segments by flips, Sloan 1993).
class ConstrainedDelaunay {
 public:
  struct Triangle {
    /// Counter-clockwise; neighbour i and constraint i belong to the edge opposite to vertex i.
    std::array<int, 3> vertices{};
    std::array<int, 3> neighbours{-1, -1, -1};
    /// How often the segments run round the triangle, counter-clockwise; see find_windings().
    int winding = 0;
    /// How often segments run along the edge with the triangle on their left, less those with it on their right, and
    /// whether there are any.
    std::array<int, 3> sides{};
    std::array<bool, 3> is_segment{};
  };

  /// An empty rectangle, all points inside or on its border; `stretch`: lengths of its sides in the metric.
  ConstrainedDelaunay(const Point2& lower, const Point2& upper, const Vector2& stretch);

  /// The number of the vertex at the point, a new one or one that is there. Nothing if the point lies on a segment,
  /// which is not divided, or outside the rectangle.
  std::optional<int> insert(const Point2& point);

  /// Makes the straight segment between two vertices an edge, directed, the inside on its left. false if another
  /// segment crosses it or a vertex lies on it.
  bool add_segment(int from, int to);

  /// Fills in the windings from outside; from then on new triangles have them of those that they came from.
  void find_windings();

  /// Triangles that were made or changed since the last call; may hold some twice.
  std::vector<int> take_changed();

  /// The triangle that holds the point; -1 outside. On an edge one of its two.
  int triangle_at(const Point2& point) const;

  const std::vector<Triangle>& triangles() const { return triangles_; }
  Point2 point(int vertex) const;
  int vertex_count() const { return static_cast<int>(places_.size()); }

 private:
  struct Place {
    std::int64_t x = 0;
    std::int64_t y = 0;
  };
  /// A triangle and where in it: -1 inside, else 0..2 the edge opposite to a vertex on which the place lies.
  struct Location {
    int triangle = -1;
    int edge = -1;
    int vertex = -1;
  };

  /// What lies across an edge of a triangle.
  struct Side {
    int neighbour = -1;
    int side = 0;
    bool is_segment = false;
  };
  using EdgeVertices = std::array<int, 2>;

  std::optional<Place> place_of(const Point2& point) const;
  int orientation(int a, int b, const Place& c) const;
  int orientation(int a, int b, int c) const { return orientation(a, b, places_[static_cast<std::size_t>(c)]); }
  Triangle& at(int triangle) { return triangles_[static_cast<std::size_t>(triangle)]; }
  const Triangle& at(int triangle) const { return triangles_[static_cast<std::size_t>(triangle)]; }
  Side side(int triangle, int edge) const;
  int new_triangle(int winding);
  void set(int triangle, const std::array<int, 3>& vertices, const std::array<Side, 3>& sides);

  Location locate(const Place& place) const;
  void split_triangle(int triangle, int vertex);
  void split_edge(int triangle, int edge, int vertex);
  bool is_convex(int triangle, int edge) const;
  bool wants_flip(int triangle, int edge) const;
  void flip(int triangle, int edge);
  void legalise_round(int vertex, std::vector<int> triangles);
  void legalise(std::vector<EdgeVertices> edges);

  /// The triangle on the left of an edge and the edge's number there.
  std::optional<Location> find_edge(const EdgeVertices& edge) const;
  std::vector<int> triangles_round(int vertex) const;
  bool cross(const EdgeVertices& a, const EdgeVertices& b) const;
  std::optional<std::vector<EdgeVertices>> edges_across(int from, int to) const;
  std::optional<Location> first_across(int from, int to) const;
  std::optional<std::vector<EdgeVertices>> flip_away(std::vector<EdgeVertices> crossing, const EdgeVertices& segment);

  Point2 lower_;
  Vector2 cell_;
  Vector2 metric_;
  std::vector<Place> places_;
  std::vector<Triangle> triangles_;
  /// One triangle of each vertex.
  std::vector<int> of_vertex_;
  std::vector<int> changed_;
  mutable int last_ = 0;
};

}  // namespace isorim::geometry
