#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/boundary.h"
#include "geometry/spline/bspline.h"
#include "geometry/trimming/trimmed_surface.h"
#include "tests/geometry/measures.h"

/// Areas of trimmed faces, and the volumes that they enclose, by brute force: Green's theorem in the parameter plane,
/// the inner integral by Gauss rules span by span, the outer one by bisection. Nothing is shared with the product's
/// cutting of elements.
namespace isorim::geometry::testing {

/// What is integrated over a face.
enum class FaceQuantity {
  area,
  /// A third of x . n: the content of the cone from the origin, the normal being the natural one.
  volume,
};

class FaceMeasure {
 public:
  explicit FaceMeasure(const NurbsSurface<3>& surface, FaceQuantity quantity = FaceQuantity::area)
      : surface_(surface), breaks_(surface.knots_u().breakpoints()), quantity_(quantity) {}

  /// The quantity of the part on the left of a closed chain of curves, ends joined by straight lines.
  double on_left_of(const TrimLoop& loop) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < loop.curves.size(); ++k) {
      for (const BezierSegment& segment : bezier_segments({loop.curves[k].knots(), loop.curves[k].homogeneous()}))
        sum += integral(loop.curves[k], segment.domain, 0);
      const NurbsCurve<2>& next = loop.curves[(k + 1) % loop.curves.size()];
      Points<2> ends(2, 2);
      ends << evaluate(loop.curves[k], loop.curves[k].domain().last), evaluate(next, next.domain().first);
      if ((ends.col(0) - ends.col(1)).norm() > 0.0)
        sum += integral(NurbsCurve<2>::from_points(KnotVector::bezier(1), ends), {0.0, 1.0}, 0);
    }
    return sum;
  }

 private:
  double density(const SurfaceJet<3>& jet) const {
    const Vector3 normal = jet.du.cross(jet.dv);
    return quantity_ == FaceQuantity::area ? normal.norm() : jet.point.dot(normal) / 3.0;
  }

  /// The integral of the density over u from the start of the domain.
  double inner(const Point2& uv) const {
    static const GaussRule rule = gauss_rule(16);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
      const bool is_last = i + 2 == breaks_.size();
      if (uv.x() <= breaks_[i] && i > 0) break;
      const double end = is_last ? uv.x() : std::min(uv.x(), breaks_[i + 1]);
      const double length = end - breaks_[i];
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const SurfaceJet<3> jet = evaluate_jet(surface_, Point2(breaks_[i] + length * rule.nodes[k], uv.y()));
        sum += length * rule.weights[k] * density(jet);
      }
    }
    return sum;
  }

  double rule_over(const NurbsCurve<2>& curve, Interval piece) const {
    static const GaussRule rule = gauss_rule(12);
    double sum = 0.0;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const CurveJet<2> jet = evaluate_jet(curve, piece.first + piece.length() * rule.nodes[k]);
      if (jet.du.y() != 0.0) sum += piece.length() * rule.weights[k] * inner(jet.point) * jet.du.y();
    }
    return sum;
  }

  double integral(const NurbsCurve<2>& curve, Interval piece, int depth) const {
    const double whole = rule_over(curve, piece);
    if (whole == 0.0) return 0.0;
    const Interval left{piece.first, piece.middle()};
    const Interval right{piece.middle(), piece.last};
    const double halves = rule_over(curve, left) + rule_over(curve, right);
    if (depth > 20 || std::abs(halves - whole) <= 1e-13 * (1.0 + std::abs(halves))) return halves;
    return integral(curve, left, depth + 1) + integral(curve, right, depth + 1);
  }

  const NurbsSurface<3>& surface_;
  std::vector<double> breaks_;
  FaceQuantity quantity_;
};

inline double face_integral(const SurfaceShape& shape, FaceQuantity quantity) {
  const FaceMeasure measure(surface_of(shape), quantity);
  double sum = 0.0;
  for (const TrimLoop& loop : trim_loops(shape)) sum += measure.on_left_of(loop);
  return sum;
}

inline double face_area(const SurfaceShape& shape) {
  return face_integral(shape, FaceQuantity::area);
}

/// The area of a boundary and the volume that it encloses.
inline Measures face_measures(const Boundary<3>& boundary) {
  Measures sum;
  for (const Patch<3>& patch : boundary.patches) {
    sum.boundary += face_area(patch.shape);
    sum.content += patch.orientation * face_integral(patch.shape, FaceQuantity::volume);
  }
  return sum;
}

}  // namespace isorim::geometry::testing
