#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/spline/knot_vector.h"
#include "geometry/tspline/index_mesh.h"

namespace isorim::geometry {

/// A T-mesh with its knots, and the functions that it carries; valid from construction on.
///
/// One patch: a rectangle in the parameters (u, v), divided into rectangular faces. Seams of closed surfaces are sides
/// of the rectangle, as for NURBS. An edge's knot interval is the difference of the knots of its ends, so opposite
/// sides of a face have equal sums of intervals; intervals of zero are edges between lines of equal knots.
class TMesh {
 public:
  /// The T-mesh on these knots, one line a knot. Throws GeometryError unless there are as many lines as knots and the
  /// degrees agree, and for two T-junctions on opposite sides of a face and the same line, which must be joined
  /// (Sederberg, Zheng, Bakenov & Nasri, ACM TOG 22, 2003, rule 2).
  TMesh(KnotVector knots_u, KnotVector knots_v, IndexMesh mesh);
  /// The mesh of a tensor product: all lines run through.
  TMesh(const KnotVector& knots_u, const KnotVector& knots_v);

  const KnotVector& knots(Direction d) const { return knots_[index(d)]; }
  int degree(Direction d) const { return knots_[index(d)].degree(); }
  const IndexMesh& index_mesh() const { return mesh_; }
  std::array<Interval, 2> domain() const { return {knots_[0].domain(), knots_[1].domain()}; }
  /// The face's rectangle in the parameters; may have no width.
  std::array<Interval, 2> face_domain(int face) const;

  int function_count() const { return static_cast<int>(anchors_.size()); }
  const std::vector<IndexBox>& anchors() const { return anchors_; }
  /// The lines from which function k takes its knots in direction d: p + 2, increasing.
  std::span<const int> local_lines(int k, Direction d) const;
  /// The local knot vector of function k in direction d: p + 2 knots.
  std::span<const double> local_knots(int k, Direction d) const;

  /// The functions whose supports share area with each face, increasing; none for faces without area.
  const std::vector<std::vector<int>>& functions_on_faces() const { return functions_on_faces_; }

  friend bool operator==(const TMesh& a, const TMesh& b) { return a.knots_ == b.knots_ && a.mesh_ == b.mesh_; }

 private:
  void require_joined() const;
  void gather_local_knots();
  void gather_supports();

  std::array<KnotVector, 2> knots_;
  IndexMesh mesh_;
  std::vector<IndexBox> anchors_;
  /// (p + 2) x function_count().
  std::array<Eigen::MatrixXi, 2> local_lines_;
  std::array<Eigen::MatrixXd, 2> local_knots_;
  std::vector<std::vector<int>> functions_on_faces_;
};

/// Where a T-mesh is not analysis-suitable: the extensions of these two meet.
struct ExtensionConflict {
  /// Ends a line that runs in u.
  TJunction in_u;
  /// Ends a line that runs in v.
  TJunction in_v;
};

/// All pairs of T-junctions whose extensions, ends included, share a point of index space. A T-mesh is
/// analysis-suitable exactly when there is none: then its functions are linearly independent whatever the knots, and
/// sum to one (Li, Zheng, Sederberg, Hughes & Scott, CAGD 29, 2012; for all degrees Beirão da Veiga, Buffa, Sangalli &
/// Vázquez, M3AS 23, 2013, definition 2.6 and theorem 4.1).
std::vector<ExtensionConflict> extension_conflicts(const IndexMesh& mesh);
inline bool is_analysis_suitable(const TMesh& mesh) {
  return extension_conflicts(mesh.index_mesh()).empty();
}

}  // namespace isorim::geometry
