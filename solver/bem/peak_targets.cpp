#include "solver/bem/peak_targets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace isorim::solver {

namespace {

using quadrature::ElementJet;
using quadrature::NearestPlace;
using quadrature::Target;

/// The normal, of any length.
template <int Dim>
geometry::Vector<Dim> normal_of(const ElementJet<Dim>& jet) {
  if constexpr (Dim == 2) {
    return {jet.first[0][1], -jet.first[0][0]};
  } else {
    const geometry::Vector3& u = jet.first[0];
    const geometry::Vector3& v = jet.first[1];
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  }
}

}  // namespace

template <int Dim>
PeakTargets<Dim>::PeakTargets(const geometry::ElementTable<Dim>& table, std::vector<RayPeak<Dim>> peaks)
    : peaks_(std::move(peaks)) {
  for (const geometry::BezierElement<Dim>& element : table.elements)
    shapes_.push_back(quadrature::plain_shape(quadrature::element_net(table, element)));
}

template <int Dim>
double PeakTargets<Dim>::Line::nearest(const geometry::Point<Dim>& point) const {
  return std::max(direction.dot(point - from), at);
}

/// Where the line meets the tangent plane of the nearest place, again and again; on an element that it misses, the
/// points of both that are nearest to each other.
template <int Dim>
Target<Dim> PeakTargets<Dim>::on_line(int element, const Line& line) const {
  constexpr int most_steps = 30;
  constexpr double own_distance = 1e-7;
  const quadrature::ElementShape<Dim>& shape = shapes_[static_cast<std::size_t>(element)];
  double t = line.nearest(shape.centre);
  NearestPlace<Dim> nearest = quadrature::nearest_place(shape, {}, line.point(t));
  for (int step = 0; step < most_steps; ++step) {
    const geometry::Vector<Dim> normal = normal_of<Dim>(nearest.jet);
    const double slope = normal.dot(line.direction);
    // To the plane if that brings the two nearer, else to the point.
    double next = line.nearest(line.point(t) + nearest.jet.offset);
    if (std::abs(slope) > 1e-3 * normal.norm()) {
      const double meeting = std::max(t + normal.dot(nearest.jet.offset) / slope, line.at);
      const NearestPlace<Dim> there = quadrature::nearest_place(shape, {}, line.point(meeting));
      if (there.distance < nearest.distance) next = meeting;
    }
    const NearestPlace<Dim> better = quadrature::nearest_place(shape, {}, line.point(next));
    if (!(better.distance < nearest.distance)) break;
    nearest = better;
    t = next;
    if (nearest.distance < 1e-14 * shape.radius) break;
  }
  const double width = line.width * t / line.at;
  Target<Dim> target;
  target.position = line.point(t);
  if (nearest.distance >= width && nearest.distance > own_distance * shape.radius) return target;
  const geometry::Point<Dim> place = target.position + nearest.jet.offset;
  if (width > own_distance * shape.radius) {
    target.position = place + width * normal_of<Dim>(nearest.jet).normalized();
    return target;
  }
  return {place, element, nearest.place};
}

template <int Dim>
Target<Dim> PeakTargets<Dim>::on(int element, const Target<Dim>& target) const {
  if (target.element == element) return target;
  const quadrature::ElementShape<Dim>& shape = shapes_[static_cast<std::size_t>(element)];
  double least = (target.position - shape.centre).norm();
  Target<Dim> best = target;
  for (const RayPeak<Dim>& peak : peaks_) {
    const geometry::Vector<Dim> way = peak.place - target.position;
    const double distance = way.norm();
    if (distance <= peak.width || !(distance > 0.0)) continue;
    const Line line{target.position, way / distance, distance, peak.width};
    const double away = (line.point(line.nearest(shape.centre)) - shape.centre).norm();
    if (away >= least) continue;
    least = away;
    // Far rules go by the distance alone.
    constexpr double near = 2.0;
    best = away < near * shape.radius ? on_line(element, line) : Target<Dim>{line.point(line.nearest(shape.centre))};
  }
  return best;
}

template class PeakTargets<2>;
template class PeakTargets<3>;

}  // namespace isorim::solver
