#include "io/propeller/overview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/nurbs/surface.h"
#include "geometry/shapes/curves.h"
#include "geometry/spline/interpolation.h"
#include "io/drawing/annotations.h"
#include "io/drawing/text_metrics.h"
#include "io/svg/axis.h"
#include "io/svg/markup.h"

namespace isorim::io {
namespace {

using drawing::Drawing;
using drawing::Horizontal;
using drawing::LineType;
using drawing::Path;
using drawing::Rectangle;
using drawing::Text;
using drawing::Vertical;
using geometry::BladeSection;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::Vector2;
using svg::number;

constexpr double text_height = 2.5;
constexpr double small_text = 1.8;
/// Between views.
constexpr double gap = 14.0;
constexpr double pitch_width = 45.0;
constexpr double sheet_margin = 10.0;
constexpr double a3_width = 420.0;
constexpr double a3_height = 297.0;

/// A view's own drawing, its shaft at y = 0, in mm on paper.
struct View {
  std::string name;
  Drawing drawing;
};

/// Layers in the order in which they are drawn.
struct Layers {
  std::size_t radii, axes, hub, outline, sections, thickness, text;
};

Layers add_layers(Drawing& target) {
  return {target.add_layer({"radii", {170, 170, 170}, 0.13}),
          target.add_layer({"axes", {110, 110, 110}, 0.18, LineType::chain}),
          target.add_layer({"hub", drawing::black, 0.35}),
          target.add_layer({"outline", drawing::black, 0.5}),
          target.add_layer({"sections", drawing::blue, 0.25}),
          target.add_layer({"thickness", drawing::red, 0.25, LineType::dashed}),
          target.add_layer({"text", drawing::black, 0.18})};
}

/// The cubic spline (of lower degree through fewer points) with the points at the parameters.
NurbsCurve<2> spline_through(const std::vector<double>& parameters, const Points<2>& points) {
  const int degree = std::min(3, static_cast<int>(parameters.size()) - 1);
  const auto spline = geometry::interpolate(geometry::averaged_knots(degree, parameters), parameters, points);
  return NurbsCurve<2>::from_points(spline.knots, spline.coefficients);
}

/// At its chord lengths.
NurbsCurve<2> spline_through(const Points<2>& points) {
  std::vector<double> parameters{0.0};
  for (Eigen::Index i = 1; i < points.cols(); ++i)
    parameters.push_back(parameters.back() + (points.col(i) - points.col(i - 1)).norm());
  return spline_through(parameters, points);
}

/// Draws the views of one propeller.
class Views {
 public:
  Views(const PropellerFacts& facts, const OverviewOptions& options, double scale)
      : facts_(facts),
        sections_(facts.screw.sections),
        factor_(options.millimetres / scale),
        millimetres_(options.millimetres),
        across_(geometry::parameters_across(sections_)),
        surface_(geometry::blade_surface(sections_, facts.screw.surface)),
        leading_edge_(geometry::leading_edge_parameter(sections_)) {}

  std::vector<View> all() const { return {profile(), transverse(), expanded(), pitch()}; }
  /// The table of the sections, its upper left corner at the origin.
  Drawing table() const;

 private:
  View profile() const;
  View transverse() const;
  View expanded() const;
  View pitch() const;

  double tip_radius() const { return 0.5 * facts_.diameter * factor_; }
  double hub_radius() const { return facts_.screw.hub ? facts_.hub_radius * factor_ : 0.0; }
  /// To the right of a view from astern the blade's leading edge lies on a right-handed screw.
  double side() const { return facts_.screw.surface.hand == geometry::Hand::right ? 1.0 : -1.0; }
  /// A curve in space seen along an axis: x and y of paper are these coordinates.
  NurbsCurve<2> seen(const NurbsCurve<3>& curve, const Eigen::Matrix<double, 2, 3>& view) const;
  /// Both edges of the blade, the tip and the root, seen so.
  void add_blade(const Eigen::Matrix<double, 2, 3>& view, std::size_t layer, Drawing& target) const;
  /// A quantity over the radius: x(section) against r, as a spline of v.
  template <class Quantity>
  NurbsCurve<2> over_radius(const Quantity& x) const;
  /// Lines across a view at the radii of the sections.
  void add_radii(double left, double right, std::size_t layer, Drawing& target) const;
  /// From the tip inward, as many as have room.
  void add_radius_labels(double x, std::size_t layer, Drawing& target) const;

  const PropellerFacts& facts_;
  const std::vector<BladeSection>& sections_;
  double factor_;
  double millimetres_;
  std::vector<double> across_;
  geometry::NurbsSurface<3> surface_;
  double leading_edge_;
};

NurbsCurve<2> Views::seen(const NurbsCurve<3>& curve, const Eigen::Matrix<double, 2, 3>& view) const {
  geometry::HomogeneousPoints<2> points(3, curve.homogeneous().cols());
  points.topRows<2>() = factor_ * (view * curve.homogeneous().topRows<3>());
  points.row(2) = curve.homogeneous().row(3);
  return {curve.knots(), points};
}

void Views::add_blade(const Eigen::Matrix<double, 2, 3>& view, std::size_t layer, Drawing& target) const {
  using geometry::Direction;
  const double first = surface_.knots_u().domain().first;
  const geometry::Interval across = surface_.knots_v().domain();
  for (const double u : {first, leading_edge_})
    target.add(layer, Path{{seen(isoparametric_curve(surface_, Direction::v, u), view)}});
  for (const double v : {across.first, across.last}) {
    const NurbsCurve<2> curve = seen(isoparametric_curve(surface_, Direction::u, v), view);
    const bool is_point = (curve.control_points().colwise() - curve.control_points().col(0)).norm() == 0.0;
    if (!is_point) target.add(layer, Path{{curve}});
  }
}

template <class Quantity>
NurbsCurve<2> Views::over_radius(const Quantity& x) const {
  Points<2> points(2, static_cast<Eigen::Index>(sections_.size()));
  for (std::size_t i = 0; i < sections_.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) << x(sections_[i]), factor_ * sections_[i].station.radius;
  return spline_through(across_, points);
}

void Views::add_radii(double left, double right, std::size_t layer, Drawing& target) const {
  for (const BladeSection& section : sections_) {
    const double y = factor_ * section.station.radius;
    target.add(layer, drawing::line({left, y}, {right, y}));
  }
}

/// A chain line a little longer than what it goes through.
void add_axis(const Point2& from, const Point2& to, std::size_t layer, Drawing& target) {
  const Vector2 beyond = 4.0 * (to - from).normalized();
  target.add(layer, drawing::line(from - beyond, to + beyond));
}

void Views::add_radius_labels(double x, std::size_t layer, Drawing& target) const {
  double free_below = INFINITY;
  for (auto section = sections_.rbegin(); section != sections_.rend(); ++section) {
    const double y = factor_ * section->station.radius;
    if (y > free_below) continue;
    free_below = y - 1.5 * small_text;
    target.add(layer, Text{fmt::format("{} R", number(2.0 * section->station.radius / facts_.diameter, 3)),
                           {x, y},
                           small_text,
                           Horizontal::left,
                           Vertical::middle});
  }
}

View Views::profile() const {
  View view{"profile", {}};
  const Layers layers = add_layers(view.drawing);
  Eigen::Matrix<double, 2, 3> from_starboard;
  from_starboard << 1, 0, 0, 0, 0, 1;
  add_blade(from_starboard, layers.outline, view.drawing);
  const auto generator = [&](const BladeSection& section, double part) {
    return -factor_ * section.station.rake + part * factor_ * section.max_thickness;
  };
  view.drawing.add(layers.axes, Path{{over_radius([&](const auto& section) { return generator(section, 0.0); })}});
  for (const double part : {-0.5, 0.5})
    view.drawing.add(layers.thickness,
                     Path{{over_radius([&](const auto& section) { return generator(section, part); })}});
  if (facts_.hub) {
    const geometry::PlaneFrame middle{Point3::Zero(), geometry::Vector3::UnitX(), geometry::Vector3::UnitZ(),
                                      -geometry::Vector3::UnitY()};
    const geometry::AffineMap<2> shrink{factor_ * Eigen::Matrix2d::Identity()};
    for (const geometry::SectionLoop& loop : plane_section(*facts_.hub, middle).loops) {
      Path path;
      for (const auto& curve : loop.curve.plane_curves.curves) path.chain.push_back(transform(curve, shrink));
      view.drawing.add(layers.hub, path);
    }
  }
  const Rectangle bounds = drawing::extent(view.drawing);
  add_radii(bounds.lower.x(), bounds.upper.x(), layers.radii, view.drawing);
  add_axis({bounds.lower.x(), 0.0}, {bounds.upper.x(), 0.0}, layers.axes, view.drawing);
  const Point2 arrow(bounds.upper.x() - 1.0, -hub_radius() - 5.0);
  view.drawing.add(layers.text, drawing::line(arrow - Vector2(12.0, 0.0), arrow));
  drawing::add_arrow(view.drawing, layers.text, arrow, Vector2::UnitX(), 2.5);
  view.drawing.add(layers.text,
                   Text{"forward", arrow - Vector2(14.0, 0.0), small_text, Horizontal::right, Vertical::middle});
  return view;
}

View Views::transverse() const {
  View view{"transverse, from astern", {}};
  const Layers layers = add_layers(view.drawing);
  Eigen::Matrix<double, 2, 3> from_astern;
  from_astern << 0, -1, 0, 0, 0, 1;
  add_blade(from_astern, layers.outline, view.drawing);
  const double half_width = drawing::extent(view.drawing).upper.cwiseAbs().x();
  if (hub_radius() > 0.0) view.drawing.add(layers.hub, drawing::Circle{Point2::Zero(), hub_radius()});
  const double opening = std::min(0.5, 1.15 * std::asin(std::min(1.0, half_width / tip_radius())));
  const double quarter = 0.5 * std::numbers::pi;
  view.drawing.add(layers.axes,
                   Path{{geometry::circular_arc(tip_radius(), Point2::Zero(), quarter - opening, quarter + opening)}});
  for (const BladeSection& section : sections_) {
    const double radius = factor_ * section.station.radius;
    const double reach = std::min(quarter, std::asin(std::min(1.0, 1.02 * half_width / radius)));
    view.drawing.add(layers.radii,
                     Path{{geometry::circular_arc(radius, Point2::Zero(), quarter - reach, quarter + reach)}});
  }
  const Rectangle bounds = drawing::extent(view.drawing);
  add_axis({0.0, -hub_radius()}, {0.0, tip_radius()}, layers.axes, view.drawing);
  add_axis({bounds.lower.x(), 0.0}, {bounds.upper.x(), 0.0}, layers.axes, view.drawing);
  return view;
}

View Views::expanded() const {
  View view{"expanded outline and sections", {}};
  const Layers layers = add_layers(view.drawing);
  const auto leading = [&](const BladeSection& section) { return side() * factor_ * section.leading_edge; };
  const auto trailing = [&](const BladeSection& section) {
    return side() * factor_ * (section.leading_edge - section.chord);
  };
  view.drawing.add(layers.outline, Path{{over_radius(leading)}});
  view.drawing.add(layers.outline, Path{{over_radius(trailing)}});
  for (const BladeSection* end : {&sections_.front(), &sections_.back()}) {
    const double y = factor_ * end->station.radius;
    if (end->chord > 0.0) view.drawing.add(layers.outline, drawing::line({trailing(*end), y}, {leading(*end), y}));
  }
  for (const BladeSection& section : sections_) {
    if (!(section.chord > 0.0)) continue;
    Points<2> points = factor_ * section.outline;
    points.row(0) *= side();
    points.row(1).array() += factor_ * section.station.radius;
    view.drawing.add(layers.sections, Path{{spline_through(points)}});
  }
  const Rectangle bounds = drawing::extent(view.drawing);
  add_radii(bounds.lower.x() - 3.0, bounds.upper.x() + 3.0, layers.radii, view.drawing);
  add_radius_labels(bounds.upper.x() + 4.0, layers.text, view.drawing);
  add_axis({0.0, 0.0}, {0.0, tip_radius()}, layers.axes, view.drawing);
  add_axis({bounds.lower.x(), 0.0}, {bounds.upper.x(), 0.0}, layers.axes, view.drawing);
  const double y = -5.0;
  view.drawing.add(layers.text, Text{"LE",
                                     {side() > 0 ? bounds.upper.x() : bounds.lower.x(), y},
                                     small_text,
                                     side() > 0 ? Horizontal::right : Horizontal::left,
                                     Vertical::middle});
  view.drawing.add(layers.text, Text{"TE",
                                     {side() > 0 ? bounds.lower.x() : bounds.upper.x(), y},
                                     small_text,
                                     side() > 0 ? Horizontal::left : Horizontal::right,
                                     Vertical::middle});
  return view;
}

View Views::pitch() const {
  View view{"pitch over diameter", {}};
  const Layers layers = add_layers(view.drawing);
  const auto ratio = [&](const BladeSection& section) { return section.station.pitch / facts_.diameter; };
  double largest = 0.0;
  for (const BladeSection& section : sections_) largest = std::max(largest, ratio(section));
  const svg::AxisRange range = svg::round_range(svg::Scale::linear, 0.0, 1.1 * largest);
  const auto place = [&](double value) { return pitch_width * range.fraction(value); };
  view.drawing.add(layers.sections, Path{{over_radius([&](const auto& section) { return place(ratio(section)); })}});
  add_radii(0.0, pitch_width, layers.radii, view.drawing);
  for (const svg::Tick& tick : svg::ticks(range, 5).major) {
    const double x = place(tick.value);
    view.drawing.add(layers.radii, drawing::line({x, 0.0}, {x, tip_radius()}));
    view.drawing.add(layers.text, Text{tick.label.base, {x, -1.5}, small_text, Horizontal::centre, Vertical::top});
  }
  view.drawing.add(layers.outline, drawing::line({0.0, 0.0}, {pitch_width, 0.0}));
  view.drawing.add(layers.outline, drawing::line({0.0, 0.0}, {0.0, tip_radius()}));
  view.drawing.add(layers.text, Text{"P/D", {0.5 * pitch_width, -6.0}, small_text, Horizontal::centre, Vertical::top});
  return view;
}

Drawing Views::table() const {
  Drawing table;
  const std::size_t layer = table.add_layer({"text", drawing::black, 0.18});
  const std::array<std::string, 7> names{"r/R", "radius", "chord", "leading edge", "thickness", "pitch", "rake"};
  constexpr double row = 4.2;
  constexpr double column = 22.0;
  for (std::size_t k = 0; k < names.size(); ++k)
    table.add(layer,
              Text{names[k], {column * static_cast<double>(k + 1) - 3.0, -row + 1.2}, small_text, Horizontal::right});
  const double width = column * static_cast<double>(names.size());
  table.add(layer, drawing::line({0.0, -row}, {width, -row}));
  double y = -row;
  for (const BladeSection& section : sections_) {
    y -= row;
    const std::array values{2.0 * section.station.radius / facts_.diameter,
                            millimetres_ * section.station.radius,
                            millimetres_ * section.chord,
                            millimetres_ * section.leading_edge,
                            millimetres_ * section.max_thickness,
                            millimetres_ * section.station.pitch,
                            millimetres_ * section.station.rake};
    for (std::size_t k = 0; k < values.size(); ++k)
      table.add(layer, Text{fmt::format("{:.2f}", values[k] == 0.0 ? 0.0 : values[k]),
                            {column * static_cast<double>(k + 1) - 3.0, y + 1.2},
                            small_text,
                            Horizontal::right});
  }
  table.add(layer, drawing::outline({{0.0, y}, {width, 0.0}}));
  return table;
}

drawing::TitleBlock title_block(const PropellerFacts& facts, const std::string& title, double millimetres,
                                double scale) {
  drawing::TitleBlock block{title, "1:" + number(scale, 4), {}};
  block.fields.emplace_back("diameter", number(facts.diameter * millimetres, 3) + " mm");
  block.fields.emplace_back("blades",
                            fmt::format("{}, {}-handed", facts.screw.blades,
                                        facts.screw.surface.hand == geometry::Hand::right ? "right" : "left"));
  block.fields.emplace_back("AE/A0", fmt::format("{:.4f}", facts.area_ratios.expanded));
  block.fields.emplace_back("AD/A0, AP/A0",
                            fmt::format("{:.4f}, {:.4f}", facts.area_ratios.developed, facts.area_ratios.projected));
  return block;
}

/// The views in a row, on one level; below them the table, the scale bar and the title block.
drawing::Sheet laid_out(const PropellerFacts& facts, const std::string& title, const OverviewOptions& options,
                        double scale) {
  const Views drawn(facts, options, scale);
  drawing::Sheet sheet{title, {}, {}};
  double x = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
  const std::vector<View> views = drawn.all();
  for (const View& view : views) {
    const Rectangle bounds = drawing::extent(view.drawing);
    lowest = std::min(lowest, bounds.lower.y());
    highest = std::max(highest, bounds.upper.y());
  }
  for (const View& view : views) {
    const Rectangle bounds = drawing::extent(view.drawing);
    sheet.drawing.add(view.drawing, Vector2(x - bounds.lower.x(), 0.0));
    sheet.drawing.add(sheet.drawing.layer("text"), Text{view.name, {x, highest + 4.0}, text_height});
    x += std::max(bounds.upper.x() - bounds.lower.x(), drawing::text_width(view.name, text_height)) + gap;
  }
  const double right = x - gap;
  const Drawing table = drawn.table();
  const Rectangle table_bounds = drawing::extent(table);
  const double top = lowest - 10.0;
  sheet.drawing.add(table, Vector2(0.0, top));
  const std::size_t text = sheet.drawing.layer("text");
  const drawing::TitleBlock block = title_block(facts, title, options.millimetres, scale);
  const Vector2 block_size = drawing::title_block_size(block);
  const double bottom = top - std::max(-table_bounds.lower.y(), block_size.y() + 16.0);
  const double block_right = std::max(right, table_bounds.upper.x() + gap + block_size.x());
  drawing::add_title_block(sheet.drawing, text, block, {block_right, bottom});
  const double bar = std::max(50.0, 10.0 * std::floor(0.1 * std::min(100.0, block_size.x() - 10.0)));
  drawing::add_scale_bar(sheet.drawing, text, {block_right - block_size.x() + 2.0, bottom + block_size.y() + 6.0}, bar,
                         number(bar * scale, 4) + " mm", small_text);
  sheet.drawing.add(text, Text{"lengths in mm; positive rake is aft", {0.0, top + 2.0}, small_text});
  sheet.page = {{-sheet_margin, bottom - sheet_margin},
                {block_right + sheet_margin, highest + 4.0 + text_height + sheet_margin}};
  const std::size_t frame = sheet.drawing.add_layer({"frame", drawing::black, 0.7});
  sheet.drawing.add(frame, drawing::outline({sheet.page.lower.array() + 5.0, sheet.page.upper.array() - 5.0}));
  return sheet;
}

}  // namespace

Overview propeller_overview(const PropellerFacts& facts, const std::string& title, const OverviewOptions& options) {
  if (!std::isfinite(options.scale) || options.scale < 0.0)
    throw InputError(fmt::format("overview: the scale is {}, expected 0 or more", options.scale));
  if (options.scale > 0.0) return {laid_out(facts, title, options, options.scale), options.scale};
  constexpr std::array mantissas{1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5};
  double scale = 1.0;
  for (double decade = 1.0; decade < 1e6; decade *= 10.0) {
    for (const double mantissa : mantissas) {
      scale = mantissa * decade;
      drawing::Sheet sheet = laid_out(facts, title, options, scale);
      if (sheet.width() <= a3_width && sheet.height() <= a3_height) return {sheet, scale};
    }
  }
  return {laid_out(facts, title, options, scale), scale};
}

}  // namespace isorim::io
