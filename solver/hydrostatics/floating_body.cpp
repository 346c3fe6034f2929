#include "solver/hydrostatics/floating_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/errors.h"
#include "geometry/intersection/clipped_cell.h"
#include "geometry/intersection/rounding_length.h"
#include "geometry/nurbs/curve.h"
#include "quadrature/cut_region.h"
#include "quadrature/parallel.h"

namespace isorim::solver {
namespace {

using geometry::BezierElement;
using geometry::ClippedCell;
using geometry::ElementTable;
using geometry::Point3;
using geometry::Vector3;
using quadrature::ElementPiece;
using Layout = WettedLayout;

/// Of the plane where it meets a singular point, relative to the size.
constexpr std::array<double, 5> shifts{0.0, 1e-11, -1e-11, 4e-11, -4e-11};
/// Heights nearer to the plane count as in it, relative to the size: TraceOptions::tolerance.
constexpr double coincidence = 1e-13;

/// The smallest and largest direction . x of the control points.
geometry::Interval heights(const double* net, int count, const Vector3& direction) {
  geometry::Interval range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int i = 0; i < count; ++i) {
    const Eigen::Map<const Eigen::Vector4d> point(net + 4 * i);
    const double height = direction.dot(point.head<3>()) / point[3];
    range.first = std::min(range.first, height);
    range.last = std::max(range.last, height);
  }
  return range;
}

}  // namespace

struct FloatingBody::Elements {
  ElementTable<3> table;
  geometry::BoundingBox<3> box;
  Point3 reference;
  double tolerance = 0.0;
  WettedScales scales;
  std::vector<WettedSums> sums;
  WettedSums whole;
  struct Box {
    Point3 middle;
    Vector3 half;
  };
  std::vector<Box> boxes;
  /// Of elements that are cut already.
  std::vector<std::optional<geometry::CuttableFace>> cells;

  /// What tolerances and shifts are relative to.
  double size() const { return geometry::rounding_length(box.lower, box.upper); }

  void measure_scales();
  void integrate(int threads);

  /// -1: under water; +1: above; 0: met, perhaps.
  int side_of(std::size_t e, const WaterPlane& plane) const;
  WettedPart wetted(const WaterPlane& plane, WettedScope scope, Waterline waterline) const;
  void add_cut(std::size_t e, const geometry::ImplicitSurface& implicit, WettedScope scope, Waterline waterline,
               WettedPart& part) const;
};

void FloatingBody::Elements::measure_scales() {
  scales.elements = table.elements.size();
  scales.radius = 0.5 * box.diagonal();
  scales.coordinate = std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
  WettedArray rough = WettedArray::Zero();
  for (const BezierElement<3>& element : table.elements)
    rough += rough_integrals(quadrature::whole_element(table, element), reference);
  scales.area = rough[Layout::area];
  double volume = 0.0;
  for (int i = 0; i < 3; ++i) volume += rough[Layout::first_index(i, i)] / 3.0;
  // A thin body's may be far off.
  scales.volume = std::max(std::abs(volume), 1e-4 * scales.area * scales.radius);
}

void FloatingBody::Elements::integrate(int threads) {
  const std::size_t count = table.elements.size();
  sums.resize(count);
  boxes.resize(count);
  cells.resize(count);
  quadrature::parallel_for(count, threads, [&](std::size_t e, int /*thread*/) {
    const BezierElement<3>& element = table.elements[e];
    sums[e] = integrate_piece(quadrature::whole_element(table, element), reference, scales,
                              WettedScope::moments_and_area, tolerance);
    const Eigen::Matrix3Xd points = table.net_matrix(element).colwise().hnormalized();
    const Point3 lower = points.rowwise().minCoeff();
    const Point3 upper = points.rowwise().maxCoeff();
    boxes[e] = {0.5 * (lower + upper), 0.5 * (upper - lower)};
    if (element.is_cut()) cells[e].emplace(geometry::cuttable_cell(table, element));
  });
  for (const WettedSums& one : sums) whole += one;
}

int FloatingBody::Elements::side_of(std::size_t e, const WaterPlane& plane) const {
  const double noise = coincidence * size();
  const double middle = plane.up.dot(boxes[e].middle) - plane.offset;
  const double reach = plane.up.cwiseAbs().dot(boxes[e].half) + 2.0 * noise;
  if (middle + reach < 0.0) return -1;
  if (middle - reach > 0.0) return 1;
  const BezierElement<3>& element = table.elements[e];
  const geometry::Interval range = heights(table.net(element).data(), element.control_point_count(), plane.up);
  if (range.last - plane.offset < -noise) return -1;
  return range.first - plane.offset >= -noise ? 1 : 0;
}

void FloatingBody::Elements::add_cut(std::size_t e, const geometry::ImplicitSurface& implicit, WettedScope scope,
                                     Waterline waterline, WettedPart& part) const {
  const BezierElement<3>& element = table.elements[e];
  const geometry::TraceOptions options{.tolerance = coincidence, .size = size()};
  ClippedCell cell = cells[e] ? geometry::clip_cell(*cells[e], implicit, options)
                              : geometry::clip_cell(table, element, implicit, options);
  if (waterline == Waterline::collect)
    for (geometry::HomogeneousPoints<2>& cut : cell.cuts)
      part.waterline.push_back({static_cast<int>(e), std::move(cut)});
  if (cell.extent == ClippedCell::Extent::nothing) return;
  if (cell.extent == ClippedCell::Extent::everything) {
    ++part.immersed_elements;
    part.sums += sums[e];
    return;
  }
  ++part.cut_elements;
  ElementPiece<3> piece{&element, table.nets.data() + element.offset, {}, 0};
  quadrature::CutRegion region(cell.region);
  if (region.extent() != quadrature::CutRegion::Extent::everything)
    piece.region = std::make_shared<quadrature::CutRegion>(std::move(region));
  part.sums += integrate_piece(piece, reference, scales, scope, tolerance);
}

WettedPart FloatingBody::Elements::wetted(const WaterPlane& plane, WettedScope scope, Waterline waterline) const {
  const geometry::ImplicitSurface implicit =
      geometry::implicit_plane(reference + (plane.offset - plane.up.dot(reference)) * plane.up, plane.up);
  WettedPart part;
  for (std::size_t e = 0; e < table.elements.size(); ++e) {
    const int side = side_of(e, plane);
    if (side > 0) continue;
    if (side < 0) {
      ++part.immersed_elements;
      part.sums += sums[e];
    } else {
      add_cut(e, implicit, scope, waterline, part);
    }
  }
  return part;
}

FloatingBody::FloatingBody(const geometry::Boundary<3>& boundary, const FloatingBodyOptions& options) {
  auto elements = std::make_unique<Elements>();
  elements->table = geometry::bezier_elements(boundary);
  elements->box = geometry::bounding_box(elements->table);
  elements->reference = elements->box.middle();
  elements->tolerance = options.tolerance;
  elements->measure_scales();
  elements->integrate(options.threads);
  elements_ = std::move(elements);
  if (!(volume() > 0.0))
    throw GeometryError(fmt::format(
        "the boundary encloses {:.6g}; expected a positive volume, with normals that point outwards", volume()));
}

FloatingBody::~FloatingBody() = default;
FloatingBody::FloatingBody(FloatingBody&&) noexcept = default;
FloatingBody& FloatingBody::operator=(FloatingBody&&) noexcept = default;

const Point3& FloatingBody::reference() const {
  return elements_->reference;
}

const geometry::BoundingBox<3>& FloatingBody::box() const {
  return elements_->box;
}

const ElementTable<3>& FloatingBody::table() const {
  return elements_->table;
}

const WettedSums& FloatingBody::whole() const {
  return elements_->whole;
}

double FloatingBody::volume() const {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += elements_->whole.value[Layout::first_index(i, i)];
  return sum / 3.0;
}

double FloatingBody::tolerance() const {
  return elements_->tolerance;
}

WettedPart FloatingBody::wetted(const WaterPlane& plane, WettedScope scope, Waterline waterline) const {
  for (const double shift : shifts) {
    try {
      const double distance = shift * elements_->size();
      WettedPart part = elements_->wetted({plane.up, plane.offset + distance}, scope, waterline);
      part.shift = distance;
      return part;
    } catch (GeometryError& error) {
      if (shift != shifts.back()) continue;
      error.add_context(fmt::format("cutting the boundary by the water plane ({:.6g}, {:.6g}, {:.6g}) . x = {:.9g}",
                                    plane.up.x(), plane.up.y(), plane.up.z(), plane.offset));
      throw;
    }
  }
  return {};
}

namespace {

/// A piece of the boundary, and between which heights it lies.
struct Candidate {
  ElementPiece<3> piece;
  geometry::Interval range;
  /// Across which the heights of its control points vary most.
  int direction = 0;
  /// A height that it reaches: of a corner of an element that is not cut.
  double reached = 0.0;

  /// The lowest come first; of level ones the smallest.
  bool operator<(const Candidate& other) const {
    return range.first != other.range.first ? range.first > other.range.first : piece.depth < other.piece.depth;
  }
};

/// The largest difference of heights along a line of control points. `heights`: u fastest, `counts` of them.
double largest_difference(const std::vector<double>& heights, const std::array<std::size_t, 2>& counts, int direction) {
  const std::size_t step = direction == 0 ? 1 : counts[0];
  const std::size_t line_step = direction == 0 ? counts[0] : 1;
  const auto d = static_cast<std::size_t>(direction);
  double largest = 0.0;
  for (std::size_t line = 0; line < counts[1 - d]; ++line) {
    geometry::Interval range{heights[line * line_step], heights[line * line_step]};
    for (std::size_t i = 1; i < counts[d]; ++i) {
      range.first = std::min(range.first, heights[line * line_step + i * step]);
      range.last = std::max(range.last, heights[line * line_step + i * step]);
    }
    largest = std::max(largest, range.length());
  }
  return largest;
}

Candidate candidate(ElementPiece<3> piece, const Vector3& direction) {
  const std::array<std::size_t, 2> counts{static_cast<std::size_t>(piece.element->degree[0] + 1),
                                          static_cast<std::size_t>(piece.element->degree[1] + 1)};
  std::vector<double> all(counts[0] * counts[1]);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = heights(piece.net() + 4 * i, 1, direction).first;
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  Candidate result{std::move(piece), {*least, *most}, 0, *most};
  if (largest_difference(all, counts, 1) > largest_difference(all, counts, 0)) result.direction = 1;
  if (!result.piece.is_cut())
    result.reached = std::min({all.front(), all[counts[0] - 1], all[all.size() - counts[0]], all.back()});
  return result;
}

}  // namespace

double FloatingBody::lowest(const Vector3& direction) const {
  // Enough for any point, and for lines of lowest points that follow a parameter; others follow diagonals.
  constexpr int most_bisections = 20000;
  const double rounding = 2.0 * std::numeric_limits<double>::epsilon() * elements_->size();
  double reached = std::numeric_limits<double>::infinity();
  std::priority_queue<Candidate> queue;
  const auto push = [&](ElementPiece<3> piece) {
    if (piece.empty()) return;
    Candidate next = candidate(std::move(piece), direction);
    reached = std::min(reached, next.reached);
    if (next.range.first <= reached) queue.push(std::move(next));
  };
  for (const BezierElement<3>& element : elements_->table.elements)
    push(quadrature::whole_element(elements_->table, element));
  for (int k = 0; k < most_bisections && !queue.empty(); ++k) {
    const Candidate best = queue.top();
    if (reached - best.range.first <= rounding) break;
    queue.pop();
    auto halves = quadrature::bisect(best.piece, best.direction);
    push(std::move(halves.first));
    push(std::move(halves.second));
  }
  return reached;
}

Point3 point_on(const FloatingBody& body, const WaterlinePiece& piece, double t) {
  const geometry::NurbsCurve<2> curve(geometry::KnotVector::bezier(static_cast<int>(piece.parameters.cols()) - 1),
                                      piece.parameters);
  const BezierElement<3>& element = body.table().elements[static_cast<std::size_t>(piece.element)];
  return geometry::evaluate_jet<3>(body.table(), element, geometry::evaluate(curve, t)).position;
}

double farthest(const FloatingBody& body, const std::vector<WaterlinePiece>& waterline, const Vector3& direction) {
  constexpr int samples = 16;
  constexpr double golden = 0.6180339887498949;
  double best = -std::numeric_limits<double>::infinity();
  for (const WaterlinePiece& piece : waterline) {
    const auto height = [&](double t) { return direction.dot(point_on(body, piece, t)); };
    int peak = 0;
    double highest = height(0.0);
    for (int k = 1; k <= samples; ++k) {
      const double value = height(static_cast<double>(k) / samples);
      if (value <= highest) continue;
      highest = value;
      peak = k;
    }
    // Golden section about the highest sample: at a maximum values are flat, so its place need not be exact.
    double from = std::max(0.0, static_cast<double>(peak - 1) / samples);
    double to = std::min(1.0, static_cast<double>(peak + 1) / samples);
    while (to - from > 1e-9) {
      const double a = to - golden * (to - from);
      const double b = from + golden * (to - from);
      (height(a) > height(b) ? to : from) = height(a) > height(b) ? b : a;
    }
    best = std::max({best, highest, height(0.5 * (from + to))});
  }
  return best;
}

}  // namespace isorim::solver
