#pragma once

#include "geometry/topology/orientation.h"

/// Elements that become thin towards the edges of a body.
namespace isorim::solver {

struct EdgeGrading {
  /// Of elements along each edge, 0 to 12; 0: none.
  int layers = 3;
  static constexpr int max_layers = 12;
  /// Each layer ends at this share of the distance of the one before, in (0, 1/2).
  double ratio = 0.25;
};

/// The boundary with knots inserted into its whole and trimmed NURBS patches next to the sides along which the body has
/// a sharp edge: its shape, topology and pcurves stay as they are. Around an edge with the angle w outside the body the
/// potential of an exterior problem varies like the distance to the power pi / w, less than 1; with elements of
/// constant size h the error of its energy falls like h^(2 pi / w) for any degree. Elements whose sizes are a geometric
/// series towards the edge resolve all such powers at once, at an exponential rate in layers and degree (B. Guo & I.
/// Babuska, Comput. Mech. 1 (1986) 21-41).
///
/// Edges are those that two patches share along a knot line (a side of the domain, or a trim of constant parameter) if
/// the body is convex there and the normals differ by 5 degrees or more anywhere. Creases inside a patch, edges that
/// cross the parameters and extracted surfaces are left as they are. Throws InputError for layers or a ratio out of
/// range.
geometry::OrientedBoundary<3> graded_to_edges(const geometry::OrientedBoundary<3>& boundary,
                                              const EdgeGrading& grading);

}  // namespace isorim::solver
