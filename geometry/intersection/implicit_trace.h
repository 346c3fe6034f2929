#pragma once

#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/intersection/element_zero_set.h"
#include "geometry/intersection/implicit_surface.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// Where a plane or quadric F = 0 cuts a NURBS surface S: curves in the parameters of S, F(S(u, v)) = 0.
namespace isorim::geometry {

struct TraceOptions {
  /// Of a value of F that counts as zero, relative to `size`: a hundred times the rounding of coordinates.
  double tolerance = 1e-13;
  /// The length that the tolerance refers to, in the units of the shape; 0: the diagonal of the control points' box.
  double size = 0.0;
};

/// A piece of the curve of intersection, in one Bézier element: F(S) is negative on its left.
struct TracedCurve {
  /// A polynomial Bézier curve over [0, 1] in the surface's parameters.
  NurbsCurve<2> curve;
  int element = 0;
};

/// The signs of F on a surface, element by element, and the curves on which they change.
///
/// Over each element w^degree F(S) is a polynomial in Bernstein form; zero_chains() finds the topology of its zero set
/// for certain and fit_chain() the curves, whose distance from the zero set is a few units of rounding. They end where
/// elements end and at double points. Where F vanishes along a knot line the curve is that line, if the sign changes
/// across it; along the boundary of the domain no curves are given. Points and lines where the surfaces touch without a
/// change of sign leave no trace among the curves (find_contacts() knows them).
class ImplicitTrace {
 public:
  /// Throws GeometryError, with the parameters and the point in space, where the surfaces meet in a singular point that
  /// is not an ordinary double point.
  ImplicitTrace(const NurbsSurface<3>& surface, const ImplicitSurface& implicit, const TraceOptions& options = {});
  /// The same where the elements of the surface are at hand: those of a boundary of this one whole patch.
  ImplicitTrace(const NurbsSurface<3>& surface, const ElementTable<3>& elements, const ImplicitSurface& implicit,
                const TraceOptions& options = {});

  const std::vector<TracedCurve>& curves() const { return curves_; }

  /// Stretches of knot lines inside the domain along which F vanishes without a change of sign (and not on all of both
  /// elements): lines in the direction of the growing parameter.
  const std::vector<NurbsCurve<2>>& touching_knot_lines() const { return touching_; }
  int element_count() const { return static_cast<int>(functions_.size()); }

  /// What the Bernstein coefficients say of the whole surface: -1 if F is negative everywhere, +1 if it is nowhere
  /// negative (beyond the tolerance), 0 otherwise.
  int sign_everywhere() const;

  const std::vector<double>& breakpoints_u() const { return breakpoints_u_; }
  const std::vector<double>& breakpoints_v() const { return breakpoints_v_; }
  /// The element that holds the parameters (on a knot line: the one after it). Elements are numbered with u fastest.
  int element_at(const Point2& uv) const;
  const ElementFunction& function(int element) const { return functions_[static_cast<std::size_t>(element)]; }
  /// From the surface's parameters to the unit square of the element, which it may leave.
  Point2 to_unit_square(int element, const Point2& uv) const;
  Point2 from_unit_square(int element, const Point2& point) const;

 private:
  Interval domain_u(int element) const;
  Interval domain_v(int element) const;
  int columns() const { return static_cast<int>(breakpoints_u_.size()) - 1; }

  void trace_element(int element, std::vector<SideCharts>& charts);
  void append_knot_line(int before, int after, Side side_before, Side side_after,
                        const std::vector<SideCharts>& charts);

  std::vector<double> breakpoints_u_;
  std::vector<double> breakpoints_v_;
  std::vector<ElementFunction> functions_;
  std::vector<TracedCurve> curves_;
  std::vector<NurbsCurve<2>> touching_;
};

}  // namespace isorim::geometry
