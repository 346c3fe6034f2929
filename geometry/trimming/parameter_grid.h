#pragma once

#include <vector>

#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// The lattice of a surface's knot lines, and points on it whose place is a matter of integers.
namespace isorim::geometry {

/// A coordinate and where it stands among the knot lines: station 2 i is on line i, 2 i + 1 between lines i and i + 1.
struct GridCoordinate {
  double value = 0.0;
  int station = 0;

  bool is_on_line() const { return station % 2 == 0; }
};

/// The knot lines of one parameter. Lines that rounding can hardly tell apart (within 8 tolerances) count as one: what
/// lies between them is nothing.
class GridAxis {
 public:
  explicit GridAxis(const KnotVector& knots);

  /// For each non-empty knot span the span between the lines here, or -1 if it is one of those that count as nothing.
  const std::vector<int>& spans() const { return spans_; }
  const std::vector<double>& lines() const { return lines_; }
  int span_count() const { return static_cast<int>(lines_.size()) - 1; }
  double line(int i) const { return lines_[static_cast<std::size_t>(i)]; }
  Interval span(int i) const { return {line(i), line(i + 1)}; }
  double length() const { return lines_.back() - lines_.front(); }
  /// How far coordinates may be off by rounding: 16 units in the last place of the largest.
  double tolerance() const { return tolerance_; }

  /// What lies within the tolerance of a line, or outside the domain, is moved onto the (nearest) line.
  GridCoordinate locate(double value) const;

 private:
  void merge_lines();

  std::vector<double> lines_;
  std::vector<int> spans_;
  double tolerance_;
};

/// A point in the parameters of a surface.
struct GridPoint {
  GridCoordinate u;
  GridCoordinate v;

  Point2 uv() const { return {u.value, v.value}; }
};

/// Both families of knot lines. Cells are counted with u fastest, as elements are.
struct ParameterGrid {
  GridAxis u;
  GridAxis v;

  explicit ParameterGrid(const NurbsSurface<3>& surface) : u(surface.knots_u()), v(surface.knots_v()) {}

  const GridAxis& axis(int direction) const { return direction == 0 ? u : v; }
  GridPoint locate(const Point2& uv) const { return {u.locate(uv.x()), v.locate(uv.y())}; }
};

}  // namespace isorim::geometry
