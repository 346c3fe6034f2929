#include "solver/bem/smoothness.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include "geometry/bezier/element_jet.h"

namespace isorim::solver {

using geometry::BezierElement;
using geometry::ElementTable;
using geometry::HomogeneousPoints;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point;
using geometry::Point2;
using geometry::Vector;
using geometry::Vector3;

namespace {

/// Points and weights that differ by less, relative to the patch, are equal.
constexpr double coincidence = 1e-12;

/// Along a side of an element. Off its ends, where poles may be.
constexpr std::array<double, 4> samples{0.07, 0.31, 0.69, 0.93};

/// The normal at a place, or just inside of it where it vanishes there.
template <int Dim>
Vector<Dim> limit_normal(const ElementTable<Dim>& table, const BezierElement<Dim>& element,
                         const Point<Dim - 1>& place) {
  constexpr double inside = 1e-5;
  const Point<Dim - 1> middle = Point<Dim - 1>::Constant(0.5);
  const auto at_middle = evaluate_jet<Dim>(table, element, middle);
  const auto jet = evaluate_jet<Dim>(table, element, place);
  if (jet.area_vector.norm() > 1e-8 * at_middle.area_vector.norm()) return jet.normal();
  return evaluate_jet<Dim>(table, element, place + inside * (middle - place)).normal();
}

double extent(const Eigen::Ref<const Eigen::MatrixXd>& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

}  // namespace

template <int Dim>
bool has_crease(const ElementTable<Dim>& table, const BezierElement<Dim>& a, const Point<Dim - 1>& place_a,
                const BezierElement<Dim>& b, const Point<Dim - 1>& place_b) {
  // Said so that a NaN makes a crease.
  return !((limit_normal<Dim>(table, a, place_a) - limit_normal<Dim>(table, b, place_b)).norm() <= crease_angle);
}

template bool has_crease(const ElementTable<2>&, const BezierElement<2>&, const Point<1>&, const BezierElement<2>&,
                         const Point<1>&);
template bool has_crease(const ElementTable<3>&, const BezierElement<3>&, const Point<2>&, const BezierElement<3>&,
                         const Point<2>&);

namespace {

bool crease_between(const ElementTable<2>& table, const BezierElement<2>& before, const BezierElement<2>& after) {
  return has_crease<2>(table, before, Point<1>(1.0), after, Point<1>(0.0));
}

/// Across the line of constant coordinate d between two elements.
bool crease_between(const ElementTable<3>& table, const BezierElement<3>& before, const BezierElement<3>& after,
                    int d) {
  return std::ranges::any_of(samples, [&](double t) {
    Point2 end = Point2::Constant(t);
    Point2 start = end;
    end(d) = 1.0;
    start(d) = 0.0;
    return has_crease<3>(table, before, end, after, start);
  });
}

}  // namespace

PatchSmoothness<2> smoothness(const NurbsCurve<2>& curve) {
  const ElementTable<2> table = bezier_elements(geometry::Boundary<2>{{{"", curve}}});
  const auto& elements = table.elements;
  PatchSmoothness<2> result;
  for (std::size_t e = 1; e < elements.size(); ++e)
    if (crease_between(table, elements[e - 1], elements[e])) result.creases[0].push_back(elements[e].domain[0].first);
  const Point2 first = evaluate(curve, curve.domain().first);
  const Point2 last = evaluate(curve, curve.domain().last);
  result.closed[0] = (first - last).norm() <= coincidence * extent(curve.control_points()) &&
                     !crease_between(table, elements.back(), elements.front());
  return result;
}

namespace {

/// The elements of a surface by their places in the grid.
struct ElementGrid {
  const ElementTable<3>& table;
  std::array<std::size_t, 2> count;

  const BezierElement<3>& at(int d, std::size_t across, std::size_t along) const {
    return table.elements[d == 0 ? across + count[0] * along : along + count[0] * across];
  }
  /// Whether the normal jumps anywhere between two strips of elements.
  bool has_crease_between(int d, std::size_t before, std::size_t after) const {
    for (std::size_t along = 0; along < count[static_cast<std::size_t>(1 - d)]; ++along)
      if (crease_between(table, at(d, before, along), at(d, after, along), d)) return true;
    return false;
  }
};

/// The homogeneous control points of a side of a clamped surface.
HomogeneousPoints<3> side_points(const NurbsSurface<3>& surface, int d, bool last) {
  const Eigen::Index nu = surface.count_u();
  const Eigen::Index nv = surface.count_v();
  if (d == 1) return surface.homogeneous().middleCols(last ? (nv - 1) * nu : 0, nu);
  HomogeneousPoints<3> points(4, nv);
  for (Eigen::Index j = 0; j < nv; ++j) points.col(j) = surface.homogeneous().col(j * nu + (last ? nu - 1 : 0));
  return points;
}

/// Opposite sides with the same points, and weights that differ by a factor alone.
bool sides_coincide(const NurbsSurface<3>& surface, int d) {
  const HomogeneousPoints<3> first = side_points(surface, d, false);
  const HomogeneousPoints<3> last = side_points(surface, d, true);
  const double factor = first(3, 0) / last(3, 0);
  const double size = extent(surface.control_points());
  for (Eigen::Index i = 0; i < first.cols(); ++i) {
    const double distance = (first.col(i).head<3>() / first(3, i) - last.col(i).head<3>() / last(3, i)).norm();
    if (distance > coincidence * size) return false;
    if (std::abs(last(3, i) * factor - first(3, i)) > coincidence * first(3, i)) return false;
  }
  return true;
}

bool is_point(const NurbsSurface<3>& surface, int d, bool last) {
  const HomogeneousPoints<3> side = side_points(surface, d, last);
  const Eigen::Matrix3Xd points = side.topRows<3>().array().rowwise() / side.row(3).array();
  return extent(points) <= coincidence * extent(surface.control_points());
}

/// Whether the tangents that leave a pole span a plane.
bool has_tangent_plane(const ElementGrid& grid, int d, bool last) {
  const std::size_t strip = last ? grid.count[static_cast<std::size_t>(d)] - 1 : 0;
  std::vector<Vector3> tangents;
  for (std::size_t along = 0; along < grid.count[static_cast<std::size_t>(1 - d)]; ++along)
    for (const double t : samples) {
      Point2 place = Point2::Constant(t);
      place(d) = last ? 1.0 : 0.0;
      const Vector3 tangent = evaluate_jet<3>(grid.table, grid.at(d, strip, along), place).tangents.col(d);
      if (!(tangent.norm() > 0.0)) return false;
      tangents.push_back(tangent.normalized());
    }
  Vector3 normal = Vector3::Zero();
  for (const Vector3& tangent : tangents) {
    const Vector3 candidate = tangents.front().cross(tangent);
    if (candidate.norm() > normal.norm()) normal = candidate;
  }
  if (normal.norm() < 1e-3) return false;
  normal.normalize();
  return std::ranges::all_of(tangents, [&](const Vector3& t) { return std::abs(t.dot(normal)) <= crease_angle; });
}

}  // namespace

PatchSmoothness<3> smoothness(const NurbsSurface<3>& surface) {
  const ElementTable<3> table = bezier_elements(geometry::Boundary<3>{{{"", surface}}});
  const ElementGrid grid{table,
                         {surface.knots_u().breakpoints().size() - 1, surface.knots_v().breakpoints().size() - 1}};
  const NurbsSurface<3> clamped = clamp(surface);
  PatchSmoothness<3> result;
  for (int d = 0; d < 2; ++d) {
    const std::size_t strips = grid.count[static_cast<std::size_t>(d)];
    for (std::size_t i = 1; i < strips; ++i)
      if (grid.has_crease_between(d, i - 1, i))
        result.creases[static_cast<std::size_t>(d)].push_back(
            grid.at(d, i, 0).domain[static_cast<std::size_t>(d)].first);
    result.closed[static_cast<std::size_t>(d)] =
        sides_coincide(clamped, d) && !grid.has_crease_between(d, strips - 1, 0);
    for (const bool last : {false, true})
      result.pole[static_cast<std::size_t>(2 * d + (last ? 1 : 0))] =
          is_point(clamped, d, last) && has_tangent_plane(grid, d, last);
  }
  return result;
}

}  // namespace isorim::solver
