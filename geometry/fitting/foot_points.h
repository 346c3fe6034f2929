#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/nurbs/curve.h"
#include "geometry/spline/knot_vector.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A point of a curve near another point.
struct FootPoint {
  double u = 0.0;
  double squared_distance = 0.0;
};

/// A polynomial B-spline curve cut into its Bézier segments once, for many points: values, derivatives and nearest
/// points (foot points) at a cost that grows with the logarithm of the number of segments.
template <int Dim>
class SegmentedCurve {
 public:
  /// points: Dim x knots.basis_count(). A closed curve is followed across its ends.
  SegmentedCurve(const KnotVector& knots, const Points<Dim>& points, bool is_closed);

  int segment_count() const { return static_cast<int>(starts_.size()) - 1; }
  Interval domain() const { return {starts_.front(), starts_.back()}; }
  Interval segment_domain(int segment) const {
    return {starts_[static_cast<std::size_t>(segment)], starts_[static_cast<std::size_t>(segment) + 1]};
  }
  /// Dim x (p + 1) Bézier points.
  Eigen::Map<const Points<Dim>> segment_points(int segment) const {
    return {points_.data() + static_cast<std::ptrdiff_t>(segment) * Dim * (degree_ + 1), Dim, degree_ + 1};
  }
  int find_segment(double u) const;
  /// Derivatives are with respect to u.
  CurveJet<Dim> jet(double u) const { return jet_on(find_segment(u), u); }
  /// The same of a segment, continued beyond it.
  CurveJet<Dim> jet_on(int segment, double u) const;

  /// The point after `steps` damped Newton steps for the distance from the target, starting at u: the nearest point in
  /// the neighbourhood, on a closed curve across the ends if need be.
  FootPoint follow(const Point<Dim>& target, double u, int steps) const;

  /// The globally nearest point; `guess` is any parameter in the domain, the better the faster. Segments whose box of
  /// control points lies farther away than the best point so far are left out; on the others the zeros of the
  /// derivative of the squared distance are isolated by the signs of its Bernstein coefficients. The distance is met to
  /// rounding.
  ClosestCurvePoint<Dim> nearest(const Point<Dim>& target, double guess) const;

 private:
  struct Search;

  bool is_stationary(const Point<Dim>& target, double u) const;
  void build_boxes();
  void search(Search& search, int node) const;
  void search_segment(Search& search, int segment) const;

  int degree_;
  bool is_closed_;
  /// Ends of the segments, one more than there are segments.
  std::vector<double> starts_;
  std::vector<double> points_;
  /// A complete binary tree of boxes: node 1 is the root, node i has the children 2i and 2i + 1, and the leaves, from
  /// leaf_count_ on, are the segments. Columns: lower and upper corner.
  std::vector<Eigen::Matrix<double, Dim, 2>> boxes_;
  int leaf_count_ = 1;
};

}  // namespace isorim::geometry
