#include "geometry/intersection/section_faces.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/trimming/lifted_curve.h"

namespace isorim::geometry {
namespace {

SectionFace make_face(const Patch<3>& patch, int index, int element, const SurfaceShape& shape) {
  SectionFace result{index, element, patch.orientation, patch.name, CuttableFace(shape), {}, {}};
  if (element >= 0) result.name += fmt::format("[{}]", element);
  const Points<3> points = result.face.surface().control_points();
  result.lower = points.rowwise().minCoeff();
  result.upper = points.rowwise().maxCoeff();
  return result;
}

/// The plane and its tolerances, for one face after the other.
class Cutting {
 public:
  Cutting(const ImplicitSurface& implicit, const Vector3& normal, double size, double tolerance)
      : implicit_(implicit), normal_(normal), size_(size), options_{.tolerance = tolerance, .size = size} {}

  void add(const SectionFace& face) {
    if (!may_meet(face)) return;
    const FaceCuts cuts = cut_face(face.face, implicit_, options_);
    const int elements = static_cast<int>(face.face.elements().elements.size());
    if (cuts.flat_elements > 0 && cuts.flat_elements < elements) {
      for (const SectionFace& part : face.parts()) add(part);
      return;
    }
    if (cuts.flat_elements > 0) return add_coplanar(face);
    append(face, cuts.cuts, false, result_.edges);
    if (cuts.has_loop_on_tool) {
      const FaceCuts above = cut_face(face.face, complement(implicit_), options_);
      append(face, above.cuts, true, result_.edges_above);
    }
    for (const NurbsCurve<2>& curve : cuts.touching) {
      const SectionPiece piece = piece_of(face, curve);
      if (!is_point_in_space(piece)) result_.touching.push_back(piece);
    }
    for (const ElementContacts::Contact& contact : cuts.contacts) {
      const SectionPoint point{evaluate(face.face.surface(), contact.place), face.patch, face.element, contact.place};
      (contact.kind == CriticalKind::saddle ? result_.saddles : result_.points).push_back(point);
    }
  }

  FacesOnPlane result() { return std::move(result_); }

 private:
  bool may_meet(const SectionFace& face) const {
    const Point3 middle = 0.5 * (face.lower + face.upper);
    const double reach = 0.5 * (face.upper - face.lower).cwiseAbs().dot(normal_.cwiseAbs());
    return std::abs(evaluate(implicit_, middle)) <= reach + 2.0 * options_.tolerance * size_;
  }

  static SectionPiece piece_of(const SectionFace& face, const NurbsCurve<2>& curve) {
    return {face.patch, face.element, face.face.shared_surface(), curve};
  }

  /// A curve in the parameters is a point in space (along a pole).
  bool is_point_in_space(const SectionPiece& piece) const {
    const Point3 start = point_on(piece, 0.0);
    for (const double t : {0.25, 0.5, 0.75, 1.0})
      if ((point_on(piece, t) - start).norm() > 1e-12 * size_) return false;
    return true;
  }

  /// Seen against the outward normal a face lies on the left of its edge, so the section on that of the reverse; seen
  /// from the other side of the plane it is the other way round.
  void append(const SectionFace& face, const std::vector<FaceCuts::Cut>& cuts, bool is_above,
              std::vector<SectionEdge>& edges) const {
    for (const FaceCuts::Cut& cut : cuts) {
      const bool turn = (face.orientation > 0) != is_above;
      SectionEdge edge{piece_of(face, turn ? reverse(cut.curve) : cut.curve), cut.is_on_loop, false};
      if (!is_point_in_space(edge.piece)) edges.push_back(std::move(edge));
    }
  }

  void add_coplanar(const SectionFace& face) {
    const NurbsSurface<3>& surface = face.face.surface();
    const Point2 inside = face.face.locator()
                              ? face.face.locator()->interior_point()
                              : Point2(surface.knots_u().domain().middle(), surface.knots_v().domain().middle());
    const SurfaceJet<3> jet = evaluate_jet(surface, inside);
    const bool natural_along = jet.du.cross(jet.dv).dot(normal_) > 0.0;
    std::vector<SectionPiece> pieces;
    for (const CuttableFace::LoopPart& part : face.face.loop_parts()) {
      const NurbsCurve<2> curve(KnotVector::bezier(static_cast<int>(part.net.cols()) - 1), part.net);
      SectionPiece piece = piece_of(face, natural_along ? curve : reverse(curve));
      if (!is_point_in_space(piece)) pieces.push_back(std::move(piece));
    }
    const bool looks_along = natural_along == (face.orientation > 0);
    if (!looks_along)
      for (const SectionPiece& piece : pieces) result_.edges.push_back({piece, true, true});
    result_.coplanar.push_back({face.patch, face.element, looks_along, {}});
    result_.coplanar_edges.push_back(std::move(pieces));
  }

  const ImplicitSurface& implicit_;
  Vector3 normal_;
  double size_;
  TraceOptions options_;
  FacesOnPlane result_;
};

}  // namespace

std::vector<SectionFace> SectionFace::parts() const {
  const NurbsSurface<3>& whole = face.surface();
  const bool is_trimmed = face.locator() != nullptr;
  const SurfaceShape shape = is_trimmed ? SurfaceShape(TrimmedSurface(whole, face.loops())) : SurfaceShape(whole);
  const ElementTable<3> table = bezier_elements(Boundary<3>{{Patch<3>{name, shape, orientation}}});
  std::vector<SectionFace> result;
  for (const BezierElement<3>& own : table.elements) {
    const auto knots = [&](std::size_t d) {
      const int degree = own.degree[d];
      std::vector<double> values(static_cast<std::size_t>(degree + 1), own.domain[d].first);
      values.insert(values.end(), static_cast<std::size_t>(degree + 1), own.domain[d].last);
      return KnotVector(degree, std::move(values));
    };
    const NurbsSurface<3> surface(knots(0), knots(1), table.net_matrix(own));
    SurfaceShape part = surface;
    if (own.is_cut()) {
      std::vector<NurbsCurve<2>> curves;
      for (HomogeneousPoints<2> net : table.regions[static_cast<std::size_t>(own.region)].curves) {
        for (Eigen::Index d = 0; d < 2; ++d) {
          const Interval domain = own.domain[static_cast<std::size_t>(d)];
          net.row(d) = domain.first * net.row(2) + domain.length() * net.row(d);
        }
        curves.emplace_back(KnotVector::bezier(static_cast<int>(net.cols()) - 1), net);
      }
      const Vector2 extent(own.domain[0].length(), own.domain[1].length());
      part = TrimmedSurface(surface, chain_directed_curves(curves, extent, 1e-9, 1e-11));
    }
    const Patch<3> patch_of_part{name, part, orientation};
    SectionFace made = make_face(patch_of_part, patch, -1, part);
    made.element = element;
    result.push_back(std::move(made));
  }
  return result;
}

std::vector<SectionFace> section_faces(const Boundary<3>& boundary) {
  std::vector<SectionFace> result;
  for (int i = 0; i < static_cast<int>(boundary.patches.size()); ++i) {
    const Patch<3>& patch = boundary.patches[static_cast<std::size_t>(i)];
    const auto* extracted = std::get_if<ExtractedSurface>(&patch.shape);
    if (!extracted) {
      result.push_back(make_face(patch, i, -1, patch.shape));
      continue;
    }
    for (int e = 0; e < static_cast<int>(extracted->elements().size()); ++e)
      result.push_back(make_face(patch, i, e, bezier_surface(*extracted, e)));
  }
  return result;
}

FacesOnPlane cut_faces(const std::vector<SectionFace>& faces, const ImplicitSurface& implicit, const Vector3& normal,
                       double size, double tolerance) {
  Cutting cutting(implicit, normal, size, tolerance);
  for (const SectionFace& face : faces) {
    try {
      cutting.add(face);
    } catch (GeometryError& error) {
      error.add_context(fmt::format("cutting patch \"{}\"", face.name));
      throw;
    }
  }
  return cutting.result();
}

}  // namespace isorim::geometry
