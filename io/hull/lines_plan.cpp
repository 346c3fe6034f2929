#include "io/hull/lines_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/drawing/annotations.h"
#include "io/drawing/dxf_writer.h"
#include "io/drawing/pdf_writer.h"
#include "io/drawing/svg_writer.h"

namespace isorim::io {
namespace {

using geometry::HullLine;
using geometry::HullLines;
using geometry::NurbsCurve;
using geometry::OffsetTable;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;

// Millimetres on paper.
constexpr double gap = 25.0;
constexpr double overhang = 6.0;
constexpr double label_height = 2.5;
constexpr double margin = 15.0;

double midships(const OffsetTable& table) {
  return table.after_perpendicular + 0.5 * table.length;
}

geometry::LinePlanes planes_of(const OffsetTable& table, const LinesPlanKeys& keys) {
  geometry::LinePlanes planes;
  planes.stations = keys.stations.empty() ? table.stations : keys.stations;
  planes.waterlines = keys.waterlines.empty() ? table.waterlines : keys.waterlines;
  planes.buttocks = keys.buttocks;
  if (planes.buttocks.empty()) {
    for (const double part : {0.25, 0.5, 0.75}) planes.buttocks.push_back(0.5 * part * table.beam);
  }
  constexpr double degree = std::numbers::pi / 180.0;
  for (std::size_t k = 0; k + 1 < keys.diagonals.values.size(); k += 2)
    planes.diagonals.push_back({keys.diagonals.values[k], keys.diagonals.values[k + 1] * degree});
  if (planes.diagonals.empty()) planes.diagonals.push_back({table.baseline + table.draught, 45.0 * degree});
  return planes;
}

/// The port half's box, as closely as a drawing needs it.
struct Box {
  Point3 lower = Point3::Constant(std::numeric_limits<double>::infinity());
  Point3 upper = -lower;
};

/// With four steps between two values.
std::vector<double> finer(const std::vector<double>& breaks) {
  constexpr int steps = 4;
  std::vector<double> result{breaks.front()};
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    for (int k = 1; k < steps; ++k) result.push_back(breaks[i - 1] + (breaks[i] - breaks[i - 1]) * k / steps);
    result.push_back(breaks[i]);
  }
  return result;
}

Box box_of(const HullFacts& hull) {
  Box box;
  for (const geometry::NurbsSurface<3>& band : hull.port) {
    const std::vector<double> us = finer(band.knots_u().breakpoints());
    const std::vector<double> vs = finer(band.knots_v().breakpoints());
    for (const double v : vs) {
      for (const double u : us) {
        const Point3 point = evaluate(band, Point2(u, v));
        box.lower = box.lower.cwiseMin(point);
        box.upper = box.upper.cwiseMax(point);
      }
    }
  }
  return box;
}

/// The edges of the surface: keel, knuckles, the top of a bulb and deck along the ship, the ends across.
struct Edges {
  std::vector<NurbsCurve<3>> along;
  std::vector<NurbsCurve<3>> ends;
};

Edges edges_of(const HullFacts& hull) {
  Edges edges;
  // With a bulb: the hull below the line from the notch, the bulb, the hull above the line. The line is no edge.
  const bool has_bulb = hull.table.bulb.cols() > 0;
  for (std::size_t k = 0; k < hull.port.size(); ++k) {
    const auto sides = boundary_curves(hull.port[k]);
    const bool is_below_line = has_bulb && k == 0;
    const bool is_bulb = has_bulb && k == 1;
    if (k == 0 || is_bulb) edges.along.push_back(sides[0]);
    if (!is_below_line) edges.along.push_back(sides[2]);
    if (!is_below_line) edges.ends.push_back(sides[1]);
    if (!is_bulb) edges.ends.push_back(sides[3]);
  }
  return edges;
}

/// Two coordinates of a curve.
NurbsCurve<2> projected(const NurbsCurve<3>& curve, Eigen::Index first, Eigen::Index second) {
  const geometry::HomogeneousPoints<3>& points = curve.homogeneous();
  geometry::HomogeneousPoints<2> flat(3, points.cols());
  flat << points.row(first), points.row(second), points.row(3);
  return {curve.knots(), flat};
}

/// Points in one coordinate alone cannot be drawn.
bool is_point(const NurbsCurve<2>& curve, double size) {
  const Points<2> points = curve.control_points();
  return (points.colwise() - points.col(0)).cwiseAbs().maxCoeff() <= 1e-9 * size;
}

/// Of the ship's plane to the paper: p -> origin + (scale_x x, scale_y y).
struct View {
  Point2 origin = Point2::Zero();
  geometry::Vector2 factors = geometry::Vector2::Ones();

  Point2 operator()(double x, double y) const { return origin + Point2(factors.x() * x, factors.y() * y); }
  NurbsCurve<2> operator()(const NurbsCurve<2>& curve) const {
    geometry::AffineMap<2> map;
    map.linear = factors.asDiagonal();
    map.translation = origin;
    return transform(curve, map);
  }
};

/// What three decimals show as 0 is not negative.
double without_sign_of_zero(double value) {
  return std::abs(value) < 5e-4 ? 0.0 : value;
}

/// Puts labels that would overlap into lanes beside one another.
class Lanes {
 public:
  /// The first lane with room from `first` to `last`.
  std::size_t take(double first, double last) {
    std::size_t lane = 0;
    while (lane < taken_.size() && std::ranges::any_of(taken_[lane], [&](const auto& other) {
             return first < other.second && other.first < last;
           }))
      ++lane;
    if (lane == taken_.size()) taken_.emplace_back();
    taken_[lane].emplace_back(first, last);
    return lane;
  }

 private:
  std::vector<std::vector<std::pair<double, double>>> taken_;
};

/// About as wide as the text is drawn.
double width_of(const std::string& text) {
  return 0.62 * label_height * static_cast<double>(text.size());
}

class LinesPlan {
 public:
  LinesPlan(const HullFacts& hull, const HullLines& lines, const LinesPlanKeys& keys)
      : hull_(hull), lines_(lines), box_(box_of(hull)), edges_(edges_of(hull)) {
    choose_scale(keys.width);
    grid_ = drawing_.add_layer({"grid", drawing::grey, 0.13});
    outline_ = drawing_.add_layer({"outline", drawing::black, 0.5});
    stations_ = drawing_.add_layer({"stations", drawing::black, 0.25});
    waterlines_ = drawing_.add_layer({"waterlines", drawing::blue, 0.25});
    buttocks_ = drawing_.add_layer({"buttocks", drawing::green, 0.25});
    diagonals_ = drawing_.add_layer({"diagonals", drawing::red, 0.25});
    texts_ = drawing_.add_layer({"text", drawing::black, 0.18});
    place_views();
  }

  drawing::Sheet sheet() {
    draw_sheer();
    draw_body();
    draw_half_breadths();
    add_titles();
    drawing::Sheet result = drawing::sheet_round(hull_.table.name + ": lines plan", std::move(drawing_), margin);
    return result;
  }

 private:
  void choose_scale(double width) {
    const double across = 2.0 * half_beam();
    const double room = width - 2.0 * margin - 2.0 * gap - 6.0 * overhang;
    const double wanted = (box_.upper.x() - box_.lower.x() + across) * 1000.0 / room;
    double power = std::pow(10.0, std::floor(std::log10(wanted)));
    for (const double step : {1.0, 2.0, 2.5, 5.0, 10.0}) {
      denominator_ = step * power;
      if (denominator_ >= wanted) break;
    }
    scale_ = 1000.0 / denominator_;
  }

  double half_beam() const { return box_.upper.y(); }

  /// The largest distance from the centre plane along a diagonal.
  double reach_of_diagonals() const {
    double reach = 0.0;
    for (const HullLine& line : lines_.diagonals) {
      for (const auto& spline : line.splines) reach = std::max(reach, spline.curve.control_points().row(1).maxCoeff());
    }
    return reach;
  }

  void place_views() {
    const double left = -scale_ * box_.lower.x();
    sheer_ = {Point2(left, -scale_ * box_.lower.z()), {scale_, scale_}};
    const double centre = scale_ * (box_.upper.x() - box_.lower.x() + half_beam()) + 2.0 * gap;
    starboard_ = {Point2(centre, -scale_ * box_.lower.z()), {scale_, scale_}};
    port_ = {starboard_.origin, {-scale_, scale_}};
    half_breadths_ = {Point2(left, -gap - scale_ * half_beam()), {scale_, scale_}};
    diagonal_view_ = {half_breadths_.origin, {scale_, -scale_}};
  }

  void add_curve(std::size_t layer, const NurbsCurve<2>& curve, const View& view) {
    if (!is_point(curve, box_.upper.x() - box_.lower.x())) drawing_.add(layer, drawing::Path{{view(curve)}});
  }
  void add_line(std::size_t layer, const Point2& from, const Point2& to) {
    drawing_.add(layer, drawing::line(from, to));
  }
  void add_label(const std::string& text, const Point2& place, drawing::Horizontal horizontal,
                 drawing::Vertical vertical, double rotation = 0.0) {
    drawing_.add(texts_, drawing::Text{text, place, label_height, horizontal, vertical, rotation});
  }

  std::string station_name(double x) const {
    const OffsetTable& table = hull_.table;
    for (std::size_t i = 0; i < table.stations.size(); ++i)
      if (table.stations[i] == x) return table.station_names[i];
    return fmt::format("x {:.4g}", x);
  }

  // --- Grids ---

  /// Verticals at the stations, labelled below.
  void add_station_grid(const View& view, double from, double to) {
    Lanes lanes;
    for (const HullLine& station : lines_.stations) {
      const Point2 foot = view(station.at, from) - Point2(0.0, overhang);
      const std::string name = station_name(station.at);
      const double half = 0.5 * width_of(name) + 0.5;
      const auto lane = static_cast<double>(lanes.take(foot.x() - half, foot.x() + half));
      add_line(grid_, foot, view(station.at, to) + Point2(0.0, overhang));
      add_label(name, foot - Point2(0.0, 1.0 + 1.3 * label_height * lane), drawing::Horizontal::centre,
                drawing::Vertical::top);
    }
  }

  /// Horizontals at heights or half-breadths, labelled on the left.
  void add_horizontals(const View& view, const std::vector<HullLine>& lines, const char* name, double from, double to) {
    Lanes lanes;
    for (const HullLine& line : lines) {
      const Point2 start = view(from, line.at) - Point2(overhang, 0.0);
      const std::string label = fmt::format("{} {:.4g}", name, line.at);
      const auto lane =
          static_cast<double>(lanes.take(start.y() - 0.65 * label_height, start.y() + 0.65 * label_height));
      add_line(grid_, start, view(to, line.at) + Point2(overhang, 0.0));
      add_label(label, start - Point2(1.0 + lane * (width_of("WL 0.1234") + 1.0), 0.0), drawing::Horizontal::right,
                drawing::Vertical::middle);
    }
  }

  // --- Views ---

  void draw_sheer() {
    add_station_grid(sheer_, box_.lower.z(), box_.upper.z());
    add_horizontals(sheer_, lines_.waterlines, "WL", box_.lower.x(), box_.upper.x());
    for (const NurbsCurve<3>& edge : edges_.along) add_curve(outline_, projected(edge, 0, 2), sheer_);
    for (const NurbsCurve<3>& edge : edges_.ends) add_curve(outline_, projected(edge, 0, 2), sheer_);
    for (const HullLine& line : lines_.buttocks) {
      for (const auto& spline : line.splines) add_curve(buttocks_, spline.curve, sheer_);
    }
  }

  void draw_body() {
    const double low = box_.lower.z();
    const double high = box_.upper.z();
    Lanes lanes;
    for (const View* side : {&starboard_, &port_}) {
      for (const HullLine& line : lines_.waterlines)
        add_line(grid_, (*side)(0.0, line.at), (*side)(half_beam(), line.at));
      for (const HullLine& line : lines_.buttocks) {
        const Point2 foot = (*side)(line.at, low) - Point2(0.0, overhang);
        add_line(grid_, foot, (*side)(line.at, high) + Point2(0.0, overhang));
        const auto lane =
            static_cast<double>(lanes.take(foot.x() - 0.65 * label_height, foot.x() + 0.65 * label_height));
        add_label(fmt::format("B {:.4g}", line.at), foot - Point2(0.0, 1.0 + lane * (width_of("B 0.1234") + 1.0)),
                  drawing::Horizontal::right, drawing::Vertical::middle, 90.0);
      }
      add_diagonal_traces(*side);
    }
    add_line(grid_, starboard_(0.0, low) - Point2(0.0, overhang), starboard_(0.0, high) + Point2(0.0, overhang));
    const double middle = midships(hull_.table);
    for (const HullLine& line : lines_.stations) {
      for (const auto& spline : line.splines) {
        if (line.at >= middle) add_curve(stations_, spline.curve, starboard_);
        if (line.at <= middle) add_curve(stations_, spline.curve, port_);
      }
    }
    for (const NurbsCurve<3>& edge : edges_.along) {
      const geometry::Interval domain = edge.knots().domain();
      const double at = std::clamp(middle, domain.first, domain.last);
      if (at < domain.last) add_curve(outline_, projected(restrict_to(edge, {at, domain.last}), 1, 2), starboard_);
      if (at > domain.first) add_curve(outline_, projected(restrict_to(edge, {domain.first, at}), 1, 2), port_);
    }
  }

  /// From the centre plane as far as the diagonal goes on its side.
  void add_diagonal_traces(const View& side) {
    const double reach = reach_of_diagonals();
    for (std::size_t k = 0; k < lines_.diagonals.size(); ++k) {
      const geometry::PlaneFrame& frame = lines_.diagonals[k].frame;
      const Point3 end = frame.to_space(Point2(0.0, reach));
      add_line(diagonals_, side(0.0, frame.origin.z()), side(end.y(), end.z()));
      add_label(fmt::format("D{}", k + 1), side(end.y(), end.z()),
                side.factors.x() > 0.0 ? drawing::Horizontal::left : drawing::Horizontal::right,
                drawing::Vertical::top);
    }
  }

  void draw_half_breadths() {
    const double reach = reach_of_diagonals();
    add_station_grid(half_breadths_, -reach, half_beam());
    add_horizontals(half_breadths_, lines_.buttocks, "B", box_.lower.x(), box_.upper.x());
    add_line(outline_, half_breadths_(box_.lower.x(), 0.0), half_breadths_(box_.upper.x(), 0.0));
    for (const NurbsCurve<3>& edge : edges_.along) add_curve(outline_, projected(edge, 0, 1), half_breadths_);
    for (const NurbsCurve<3>& edge : edges_.ends) add_curve(outline_, projected(edge, 0, 1), half_breadths_);
    for (const HullLine& line : lines_.waterlines) {
      for (const auto& spline : line.splines) add_curve(waterlines_, spline.curve, half_breadths_);
    }
    for (std::size_t k = 0; k < lines_.diagonals.size(); ++k) {
      for (const auto& spline : lines_.diagonals[k].splines) {
        add_curve(diagonals_, spline.curve, diagonal_view_);
        const geometry::Interval domain = spline.curve.knots().domain();
        const Point2 middle = evaluate(spline.curve, domain.middle());
        add_label(fmt::format("D{}", k + 1), diagonal_view_(middle.x(), middle.y()) - Point2(0.0, 1.5),
                  drawing::Horizontal::centre, drawing::Vertical::top);
      }
    }
  }

  void add_titles() {
    const OffsetTable& table = hull_.table;
    const auto title = [&](const char* text, const Point2& place) {
      drawing_.add(texts_, drawing::Text{text, place, 3.5, drawing::Horizontal::centre, drawing::Vertical::baseline});
    };
    const double middle = 0.5 * (box_.lower.x() + box_.upper.x());
    title("SHEER PLAN", sheer_(middle, box_.upper.z()) + Point2(0.0, overhang + 3.0));
    title("BODY PLAN", starboard_(0.0, box_.upper.z()) + Point2(0.0, overhang + 3.0));
    title("HALF-BREADTH PLAN", half_breadths_(middle, half_beam()) + Point2(0.0, overhang + 3.0));
    drawing::TitleBlock block;
    block.title = table.name;
    block.scale = fmt::format("1:{:g}", denominator_);
    block.fields = {{"Length, m", fmt::format("{:.6g}", table.length)},
                    {"Beam, m", fmt::format("{:.6g}", table.beam)},
                    {"Draught, m", fmt::format("{:.6g}", table.draught)},
                    {"Prismatic coefficient", fmt::format("{:.4f}", hull_.prismatic)},
                    {"LCB, % L forward", fmt::format("{:+.3f}", without_sign_of_zero(100.0 * hull_.buoyancy_centre))}};
    const drawing::Rectangle drawn = extent(drawing_);
    const std::size_t frame = drawing_.add_layer({"title block", drawing::black, 0.35});
    const Point2 corner(std::max(drawn.upper.x(), half_breadths_(box_.upper.x(), 0.0).x() + overhang + gap +
                                                      drawing::title_block_size(block).x()),
                        drawn.lower.y());
    drawing::add_title_block(drawing_, frame, block, corner);
  }

  const HullFacts& hull_;
  const HullLines& lines_;
  Box box_;
  Edges edges_;
  drawing::Drawing drawing_;
  double denominator_ = 1.0;
  /// Paper mm a unit.
  double scale_ = 1.0;
  View sheer_;
  View starboard_;
  View port_;
  View half_breadths_;
  View diagonal_view_;
  std::size_t grid_ = 0;
  std::size_t outline_ = 0;
  std::size_t stations_ = 0;
  std::size_t waterlines_ = 0;
  std::size_t buttocks_ = 0;
  std::size_t diagonals_ = 0;
  std::size_t texts_ = 0;
};

void add_points(std::string& text, const char* family, const std::vector<HullLine>& lines, double sag) {
  for (const HullLine& line : lines) {
    for (std::size_t k = 0; k < line.curves.size(); ++k) {
      for (const geometry::SectionSample& sample : sample_section(line.curves[k], line.frame, sag)) {
        const Point3& x = sample.place.point;
        text += fmt::format("{},{},{},{},{},{}\n", family, line.at, k + 1, x.x(), x.y(), x.z());
      }
    }
  }
}

}  // namespace

HullLines plan_lines(const HullFacts& hull, const LinesPlanKeys& keys) {
  return geometry::hull_lines(hull.port, planes_of(hull.table, keys), 1e-7);
}

drawing::Sheet lines_plan(const HullFacts& hull, const HullLines& lines, const LinesPlanKeys& keys) {
  return LinesPlan(hull, lines, keys).sheet();
}

void write_lines_plan(const std::filesystem::path& folder, const HullFacts& hull, const LinesPlanKeys& keys) {
  const HullLines lines = plan_lines(hull, keys);
  const drawing::Sheet sheet = lines_plan(hull, lines, keys);
  drawing::write_svg(folder / "lines_plan.svg", sheet);
  drawing::write_pdf(folder / "lines_plan.pdf", {&sheet, 1});
  drawing::write_dxf(folder / "lines_plan.dxf", sheet.drawing);
  std::string text = "family,at,curve,x,y,z\n";
  const double sag = 1e-4 * hull.table.length;
  add_points(text, "station", lines.stations, sag);
  add_points(text, "waterline", lines.waterlines, sag);
  add_points(text, "buttock", lines.buttocks, sag);
  add_points(text, "diagonal", lines.diagonals, sag);
  write_file(folder / "lines.csv", text);
}

}  // namespace isorim::io
