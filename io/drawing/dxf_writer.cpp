#include "io/drawing/dxf_writer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/drawing/dxf_records.h"
#include "io/drawing/page_path.h"

namespace isorim::io::drawing {

namespace {

using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;

constexpr int largest_degree = 10;
/// Of polygons round fills, in mm.
constexpr double polygon_tolerance = 0.01;
constexpr double reference_width = 0.25;

/// The parts of a clamped curve between its jumps: AutoCAD's splines are continuous.
std::vector<NurbsCurve<2>> continuous_parts(const NurbsCurve<2>& curve) {
  std::vector<NurbsCurve<2>> parts{geometry::clamp(curve)};
  for (const double u : curve.knots().breakpoints()) {
    const geometry::Interval domain = parts.back().domain();
    if (u <= domain.first || u >= domain.last || parts.back().knots().multiplicity(u) <= curve.degree()) continue;
    auto [first, second] = split(parts.back(), u);
    parts.back() = std::move(first);
    parts.push_back(std::move(second));
  }
  return parts;
}

/// The curve as a polynomial cubic B-spline within the tolerance of pages.
NurbsCurve<2> cubic_spline(const NurbsCurve<2>& curve) {
  const auto segments = svg::path_segments(curve, page_tolerance);
  Points<2> points(2, 3 * segments.size() + 1);
  std::vector<double> breakpoints{0.0};
  Eigen::Index at = 0;
  for (const svg::PathSegment& segment : segments) {
    points.middleCols<4>(at) = segment;
    at += 3;
    breakpoints.insert(breakpoints.end(), 3, breakpoints.back() + 1.0);
  }
  breakpoints.resize(breakpoints.size() - 2);
  return NurbsCurve<2>::from_points(geometry::KnotVector::clamped(3, breakpoints), points);
}

/// The chain as a polygon: corners and as many points of each segment as it needs.
void add_polygon(const Chain& chain, std::vector<Point2>& polygon) {
  for (const svg::PathSegment& segment : svg::path_segments(chain, page_tolerance)) {
    polygon.emplace_back(segment.col(0));
    if (segment.cols() == 2) continue;
    // The sag of a chord is at most second differences of the control points over 8 n^2, times p (p - 1).
    const auto p = static_cast<double>(segment.cols() - 1);
    double bend = 0.0;
    for (Eigen::Index i = 2; i < segment.cols(); ++i)
      bend = std::max(bend, (segment.col(i) - 2.0 * segment.col(i - 1) + segment.col(i - 2)).norm());
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(p * (p - 1.0) * bend / 8.0 / polygon_tolerance))));
    for (int k = 1; k < pieces; ++k) polygon.push_back(svg::evaluate_segment(segment, static_cast<double>(k) / pieces));
  }
}

/// Writes entities of one layer.
class Entities {
 public:
  Entities(DxfText& out, const Layer& layer) : out_(out), layer_(layer) {}

  void operator()(const Path& path) const {
    for (const auto& curve : path.chain)
      for (const auto& part : continuous_parts(curve)) add_curve(part);
  }
  void operator()(const Polyline& polyline) const { add_polyline(polyline.points, polyline.is_closed); }
  void operator()(const Circle& circle) const {
    start("CIRCLE");
    out_.group(100, "AcDbCircle");
    out_.point(10, circle.centre);
    out_.group(40, circle.radius);
  }
  void operator()(const Fill& fill) const;
  void operator()(const Text& text) const;

 private:
  void start(const char* type) const;
  void add_curve(const NurbsCurve<2>& curve) const;
  void add_polyline(const Points<2>& points, bool is_closed) const;

  DxfText& out_;
  const Layer& layer_;
};

void Entities::start(const char* type) const {
  out_.start_entity(type, layer_.name);
  // Dashes in the table are those of lines 0.25 mm wide.
  if (layer_.line_type != LineType::continuous && layer_.line_width != reference_width)
    out_.group(48, layer_.line_width / reference_width);
}

void Entities::add_polyline(const Points<2>& points, bool is_closed) const {
  start("LWPOLYLINE");
  out_.group(100, "AcDbPolyline");
  out_.group(90, static_cast<int>(points.cols()));
  out_.group(70, is_closed ? 1 : 0);
  for (Eigen::Index i = 0; i < points.cols(); ++i) out_.plane_point(10, points.col(i));
}

void Entities::add_curve(const NurbsCurve<2>& curve) const {
  if (curve.degree() == 1) return add_polyline(curve.control_points(), false);
  if (curve.degree() > largest_degree) return add_curve(cubic_spline(curve));
  const bool is_rational = !curve.is_polynomial();
  const Points<2> points = curve.control_points();
  const Eigen::VectorXd weights = curve.weights();
  start("SPLINE");
  out_.group(100, "AcDbSpline");
  out_.group(210, 0.0);
  out_.group(220, 0.0);
  out_.group(230, 1.0);
  out_.group(70, is_rational ? 12 : 8);
  out_.group(71, curve.degree());
  out_.group(72, static_cast<int>(curve.knots().knots().size()));
  out_.group(73, static_cast<int>(points.cols()));
  out_.group(74, 0);
  out_.group(42, 1e-10);
  out_.group(43, 1e-10);
  for (const double knot : curve.knots().knots()) out_.group(40, knot);
  for (Eigen::Index i = 0; is_rational && i < weights.size(); ++i) out_.group(41, weights(i));
  for (Eigen::Index i = 0; i < points.cols(); ++i) out_.point(10, points.col(i));
}

void Entities::operator()(const Fill& fill) const {
  start("HATCH");
  out_.group(62, colour_index(fill.colour));
  out_.group(100, "AcDbHatch");
  out_.point(10, {0, 0});
  out_.group(210, 0.0);
  out_.group(220, 0.0);
  out_.group(230, 1.0);
  out_.group(2, "SOLID");
  out_.group(70, 1);
  out_.group(71, 0);
  out_.group(91, static_cast<int>(fill.chains.size()));
  for (const Chain& chain : fill.chains) {
    std::vector<Point2> polygon;
    add_polygon(chain, polygon);
    out_.group(92, 3);
    out_.group(72, 0);
    out_.group(73, 1);
    out_.group(93, static_cast<int>(polygon.size()));
    for (const Point2& point : polygon) out_.plane_point(10, point);
    out_.group(97, 0);
  }
  out_.group(75, 0);
  out_.group(76, 1);
  out_.group(98, 0);
}

void Entities::operator()(const Text& text) const {
  const int across = text.horizontal == Horizontal::left ? 0 : text.horizontal == Horizontal::centre ? 1 : 2;
  const int along = text.vertical == Vertical::baseline ? 0 : text.vertical == Vertical::middle ? 2 : 3;
  start("TEXT");
  out_.group(100, "AcDbText");
  out_.point(10, text_origin(text));
  out_.group(40, text.height);
  out_.group(1, std::string_view(dxf_string(text.text)));
  out_.group(50, text.rotation);
  out_.group(7, "Standard");
  if (across != 0 || along != 0) {
    out_.group(72, across);
    out_.point(11, text.place);
  }
  out_.group(100, "AcDbText");
  if (along != 0) out_.group(73, along);
}

}  // namespace

std::string to_dxf(const Drawing& drawing, const DxfOptions& options) {
  if (!std::isfinite(options.scale) || options.scale <= 0.0)
    throw InputError(fmt::format("DXF: the scale is {}, expected more than 0", options.scale));
  DxfText entities;
  Rectangle bounds = extent(drawing);
  if (!bounds.is_empty()) {
    bounds.lower *= options.scale;
    bounds.upper *= options.scale;
  }
  for (std::size_t i = 0; i < drawing.layers().size(); ++i) {
    const Entities writer(entities, drawing.layers()[i]);
    for (const Entity& entity : drawing.entities(i)) {
      if (options.scale == 1.0) {
        std::visit(writer, entity);
      } else {
        std::visit(writer, scaled(entity, options.scale, geometry::Vector2::Zero()));
      }
    }
  }
  return dxf_head(drawing, bounds, options.scale, "20000000") + "  0\nSECTION\n  2\nENTITIES\n" + entities.text() +
         "  0\nENDSEC\n" + dxf_tail() + "  0\nEOF\n";
}

void write_dxf(const std::filesystem::path& path, const Drawing& drawing, const DxfOptions& options) {
  write_file(path, to_dxf(drawing, options));
}

}  // namespace isorim::io::drawing
