#include "solver/hydrostatics/station_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "geometry/bezier/bernstein_roots.h"
#include "geometry/bezier/subdivision.h"
#include "quadrature/boundary_sums.h"

namespace isorim::solver {
namespace {

using geometry::BezierElement;
using geometry::ElementTable;
using geometry::Vector2;
using geometry::Vector3;

/// Heights below this, relative to the size, count as zero.
constexpr double coincidence = 1e-14;

/// up . x - offset of a curve, times its weight: Bernstein coefficients.
std::vector<double> heights(std::span<const double> net, const Vector2& up, double offset) {
  std::vector<double> values(net.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = up.x() * net[3 * i] + up.y() * net[3 * i + 1] - offset * net[3 * i + 2];
  return values;
}

double value_at(std::vector<double> coefficients, double t) {
  for (std::size_t count = coefficients.size() - 1; count > 0; --count)
    for (std::size_t i = 0; i < count; ++i) coefficients[i] += t * (coefficients[i + 1] - coefficients[i]);
  return coefficients.front();
}

void append(const BezierElement<2>& element, std::vector<double> net, ElementTable<2>& table) {
  BezierElement<2> part = element;
  part.offset = table.nets.size();
  table.elements.push_back(part);
  table.nets.insert(table.nets.end(), net.begin(), net.end());
}

/// The parts of a curve under water.
void append_immersed(const ElementTable<2>& whole, const BezierElement<2>& element, const Vector2& up, double offset,
                     double noise, ElementTable<2>& table) {
  const std::span<const double> net = whole.net(element);
  const std::vector<double> height = heights(net, up, offset);
  if (*std::min_element(height.begin(), height.end()) >= -noise) return;
  std::vector<double> cuts{0.0};
  for (const geometry::Interval& root : geometry::bernstein_roots(height, noise))
    if (root.middle() > cuts.back() && root.middle() < 1.0) cuts.push_back(root.middle());
  cuts.push_back(1.0);
  const std::array<int, 1> degree{element.degree[0]};
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (value_at(height, 0.5 * (cuts[i] + cuts[i + 1])) >= 0.0) continue;
    std::vector<double> part(net.begin(), net.end());
    if (cuts.size() > 2) geometry::restrict_net(part, 3, degree, 0, {cuts[i], cuts[i + 1]});
    append(element, std::move(part), table);
  }
}

}  // namespace

StationSection station_section(const geometry::PlaneCutter& cutter, double x) {
  StationSection result;
  result.x = x;
  const geometry::PlaneSection section =
      cutter.section(geometry::plane_frame(geometry::Point3(x, 0.0, 0.0), Vector3::UnitX()));
  if (!section.loops.empty()) result.curves = geometry::bezier_elements(geometry::section_region(section));
  return result;
}

ImmersedSection immersed_section(const StationSection& section, const WaterPlane& plane, double tolerance) {
  using Layout = quadrature::SumLayout<2>;
  ImmersedSection result;
  const Vector2 across(plane.up.y(), plane.up.z());
  const double length = across.norm();
  if (section.curves.elements.empty() || length == 0.0) return result;
  const Vector2 up = across / length;
  const double offset = (plane.offset - plane.up.x() * section.x) / length;
  const geometry::BoundingBox<2> box = geometry::bounding_box(section.curves);
  ElementTable<2> immersed;
  for (const BezierElement<2>& element : section.curves.elements)
    append_immersed(section.curves, element, up, offset, coincidence * box.diagonal(), immersed);
  if (immersed.elements.empty()) return result;
  const geometry::Point2 pole = box.middle() + (offset - up.dot(box.middle())) * up;
  quadrature::Options options;
  options.tolerance = tolerance;
  options.threads = 1;
  const auto sums = quadrature::boundary_sums<2>(immersed, pole, quadrature::SumScope::all, options);
  result.area = {0.5 * sums.value[Layout::content], 0.5 * sums.error[Layout::content]};
  if (result.area.value > result.area.error)
    result.centroid = pole + sums.value.segment<2>(Layout::first).matrix() / (3.0 * result.area.value);
  return result;
}

}  // namespace isorim::solver
