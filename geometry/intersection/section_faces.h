#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/intersection/clipped_face.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/intersection/section_edges.h"

/// For plane_section.cpp: the faces of a boundary, ready to be cut by planes, and what a plane finds on each.
namespace isorim::geometry {

/// One surface: a patch, or an element of an extracted one.
struct SectionFace {
  int patch = 0;
  int element = -1;
  int orientation = 1;
  /// For messages.
  std::string name;
  CuttableFace face;
  /// The corners of the box of the control points.
  Point3 lower;
  Point3 upper;
  /// The elements of a face of several, each a face of its own in the parameters of the whole.
  std::vector<SectionFace> parts() const;
};

std::vector<SectionFace> section_faces(const Boundary<3>& boundary);

/// What a plane has in common with all faces, face by face.
struct FacesOnPlane {
  std::vector<SectionEdge> edges;
  /// Edges of what lies above the plane, in the plane, in the direction of `edges`.
  std::vector<SectionEdge> edges_above;
  std::vector<SectionPiece> touching;
  std::vector<SectionPoint> points;
  std::vector<SectionPoint> saddles;
  std::vector<CoplanarFace> coplanar;
  /// The loops of coplanar faces, with the face on their left as seen against the normal: those of coplanar[i] carry
  /// the index i.
  std::vector<std::vector<SectionPiece>> coplanar_edges;
};

/// `implicit` is the plane, `size` that of the boundary. Throws GeometryError with the face's name.
FacesOnPlane cut_faces(const std::vector<SectionFace>& faces, const ImplicitSurface& implicit, const Vector3& normal,
                       double size, double tolerance);

}  // namespace isorim::geometry
