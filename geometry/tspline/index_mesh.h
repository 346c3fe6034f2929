#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/nurbs/surface.h"

/// T-meshes in index space: what there is to know of a T-mesh before its knots have values. A line u = i, "line i of
/// direction u", belongs to the i-th knot of the first direction, whatever its value: equal knots have lines of their
/// own, with cells of no width between them.
namespace isorim::geometry {

/// The rectangle between the lines first[d] and last[d] of both directions d; a segment or a vertex where they are
/// equal. [0] is u, [1] is v.
struct IndexBox {
  std::array<int, 2> first{};
  std::array<int, 2> last{};

  friend bool operator==(const IndexBox&, const IndexBox&) = default;
};

inline std::size_t index(Direction d) {
  return static_cast<std::size_t>(d);
}
inline Direction other(Direction d) {
  return d == Direction::u ? Direction::v : Direction::u;
}

/// A vertex of the T-mesh that one of its four edges is missing from.
struct TJunction {
  /// Its lines in u and v.
  std::array<int, 2> at{};
  /// The direction of the missing edge: a line that runs in this direction ends here.
  Direction along = Direction::u;
  /// +1 if the missing edge would lead to larger indices, -1 to smaller ones.
  int sense = 1;

  friend bool operator==(const TJunction&, const TJunction&) = default;
};

/// The extension of a T-junction: the segment from `first` to `last` of the line through it, degree bays long. The face
/// extension, ahead, is its part between the junction and `ahead`; the edge extension, backwards, the other one.
struct Extension {
  TJunction junction;
  int first = 0;
  int last = 0;
  int ahead = 0;
};

/// A rectangle of cells, some of them merged into rectangular faces, with a frame of lines around it.
///
/// For p + 1 knots at both ends of direction u, lines 0 .. p and count - 1 - p .. count - 1 are complete, and the
/// same in v; the rectangle between lines p and count - 1 - p is the *domain*, where faces are. Lines that reach its
/// border run on through the frame. So T-junctions lie inside the domain, and the frame holds just what local knot
/// vectors need beyond the border, clamped or not (Beirão da Veiga, Buffa, Sangalli & Vázquez, M3AS 23, 2013, the
/// "frame region" of an admissible T-mesh).
///
/// A mesh that divides a rectangle into rectangles needs no half-edges: the number of the face of each cell tells
/// everything, and all questions are comparisons of integers.
class IndexMesh {
 public:
  /// degrees and numbers of lines in u and v. Each box of `merged` becomes one face; all other cells of the domain are
  /// faces by themselves. Throws GeometryError if a box is empty, leaves the domain or overlaps another one.
  IndexMesh(std::array<int, 2> degrees, std::array<int, 2> line_counts, std::span<const IndexBox> merged = {});

  int degree(Direction d) const { return degrees_[index(d)]; }
  int line_count(Direction d) const { return line_counts_[index(d)]; }
  IndexBox domain() const;
  /// In the order of their making; lines are those of the whole mesh.
  const std::vector<IndexBox>& faces() const { return faces_; }
  /// Index of the face that holds cell (i, j), which lies between lines i and i + 1 of u and j and j + 1 of v; inside
  /// the domain.
  int face_at(int i, int j) const;
  /// The face of any cell, the frame's cells included: these are one cell wide towards the border.
  IndexBox box_at(int i, int j) const;

  /// Whether the T-mesh has the part of line `line` of direction d between the lines cell and cell + 1 of the other
  /// direction.
  bool has_edge(Direction d, int line, int cell) const;
  /// Whether an edge on line `line` of direction d starts, ends or passes at line `at` of the other direction.
  bool touches(Direction d, int line, int at) const;
  /// Whether all of line `line` of direction d between the lines first and last of the other direction is there; if
  /// these are equal, whether it touches them.
  bool covers(Direction d, int line, int first, int last) const;
  bool is_vertex(int i, int j) const { return touches(Direction::u, i, j) && touches(Direction::v, j, i); }

  /// Where the functions sit, sorted by line in v, then in u: for an odd degree on the lines of a direction, for an
  /// even one between them. So odd degrees have vertices, even ones faces, mixed ones edges. Anchors lie in the
  /// "active region", which for p + 1 equal end knots is the domain and frame cells of no width: a mesh without
  /// T-junctions has the functions of a tensor product in their order.
  std::vector<IndexBox> anchors() const;
  /// The p + 2 lines of direction d that the function of an anchor takes its knots from: a beam from the anchor, as
  /// wide as the anchor, meets them on its way to both sides. A line counts if it crosses or touches the whole beam.
  std::vector<int> local_lines(const IndexBox& anchor, Direction d) const;

  /// In the order of their lines in v, then u.
  std::vector<TJunction> t_junctions() const;
  /// The face extension reaches over floor((p + 1) / 2) bays ahead, the edge extension over floor(p / 2) backwards,
  /// p the degree of the direction that the missing edge runs in.
  Extension extension(const TJunction& junction) const;

  /// Divides a face by a line of direction d strictly inside it; the second part becomes the last face.
  void split(int face, Direction d, int line);
  /// Inserts a line in the middle of each of these cells of direction d (increasing; twice for two lines), inside the
  /// domain. No face is divided by it.
  void insert_lines(Direction d, std::span<const int> cells);

  friend bool operator==(const IndexMesh&, const IndexMesh&) = default;

 private:
  int cells(Direction d) const { return line_counts_[index(d)] - 1 - 2 * degrees_[index(d)]; }
  std::int32_t& face_of(int i, int j);
  /// Gives the cells of the k-th box its number; throws if another one has them.
  void claim_cells(std::span<const IndexBox> merged, std::size_t k);
  /// The boxes and single cells, from their lower corners.
  void gather_faces(std::span<const IndexBox> merged);
  void number_cells();

  std::array<int, 2> degrees_;
  std::array<int, 2> line_counts_;
  std::vector<IndexBox> faces_;
  /// Of the domain's cells, u fastest.
  std::vector<std::int32_t> face_of_cell_;
};

}  // namespace isorim::geometry
