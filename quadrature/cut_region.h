#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "quadrature/element_sums.h"
#include "quadrature/region_moments.h"

namespace isorim::quadrature {

/// The kept part of a cut element, or of a rectangle within it that bisections have made, in the coordinates of that
/// rectangle's unit cell.
///
/// Bisecting needs no topology: what Green's theorem asks of the boundary on the far side of x = 1 is only which span
/// of y it covers there, and nothing of what lies elsewhere outside. So the region of a part is the curves inside it
/// and those spans, and an error in where a curve is split costs no more than itself.
class CutRegion {
 public:
  /// The kept part is a union of closed chains of curves (see geometry::TrimmedRegion).
  explicit CutRegion(const geometry::TrimmedRegion& region);

  enum class Extent { nothing, part, everything };
  /// `part` may also be said of a region that just touches the cell's edges.
  Extent extent() const { return extent_; }

  /// The moments with at least these counts, right to a few roundings: each curve is integrated with as many
  /// Gauss-Legendre points as a rigorous bound of the error asks for, or as are exact. Kept until more are asked for;
  /// a region serves one thread.
  const RegionMoments& moments(const Orders<2>& counts) const;

  /// Points inside, a few on each of `rows` lines across the cell (those of a Gauss-Legendre rule; with an even number
  /// none is likely to run through corners of the region, whose curves meet to rounding only).
  std::vector<geometry::Point2> inner_points(int rows) const;

  /// The regions of the two halves of the cell in a direction, each in the coordinates of its own unit cell.
  std::pair<CutRegion, CutRegion> halves(int direction) const;

 private:
  /// 3 x (degree + 1) homogeneous points in nets_.
  struct Curve {
    std::size_t offset;
    int degree;
    /// All weights are 1.
    bool polynomial;
    /// y is constant.
    bool level;
  };
  /// A part of the boundary on or beyond x = 1: what of [0, 1] its y covers, and in which direction.
  struct Strip {
    double first;
    double last;
  };

  /// Where the boundary crosses a line across the cell: upwards (+1: what is kept ends there) or downwards (-1).
  struct Crossing {
    double x;
    int direction;
  };

  CutRegion() = default;
  std::span<const double> net(const Curve& curve) const {
    return {nets_.data() + curve.offset, 3 * (static_cast<std::size_t>(curve.degree) + 1)};
  }
  /// Takes a curve that lies on one side of each edge of the cell.
  void add(std::span<const double> net, bool polynomial);
  static Strip strip_of(std::span<const double> net);
  void add_strip(Strip strip);
  void set_extent();
  std::vector<Crossing> crossings(double y) const;

  std::vector<double> nets_;
  std::vector<Curve> curves_;
  std::vector<Strip> strips_;
  Extent extent_ = Extent::part;
  mutable RegionMoments moments_;
};

}  // namespace isorim::quadrature
