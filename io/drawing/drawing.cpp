#include "io/drawing/drawing.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/drawing/text_metrics.h"

namespace isorim::io::drawing {

namespace {

using geometry::Point2;
using geometry::Points;
using geometry::Vector2;

/// Of curves that are measured, in mm.
constexpr double tolerance = 1e-4;
constexpr std::size_t longest_name = 255;
/// Of letters such as g, in units of the height of capitals.
constexpr double descent = 0.3;

std::string lower_case(std::string_view name) {
  std::string result(name);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool is_refused(char c) {
  return static_cast<unsigned char>(c) < 0x20 || std::string_view("<>/\\\":;?*|,=`").find(c) != std::string_view::npos;
}

void require(bool holds, const char* what) {
  if (!holds) throw InputError(fmt::format("drawing: {}", what));
}

/// Throws InputError if the entity is not fit to be drawn.
struct Check {
  void operator()(const Path& path) const { require(!path.chain.empty(), "a path without curves"); }
  void operator()(const Polyline& polyline) const {
    require(polyline.points.cols() >= 2, "a polyline of fewer than two points");
    require(polyline.points.allFinite(), "a point of a polyline is not finite");
  }
  void operator()(const Circle& circle) const {
    require(circle.centre.allFinite() && std::isfinite(circle.radius), "a number of a circle is not finite");
    require(circle.radius > 0.0, "a circle's radius is not positive");
  }
  void operator()(const Fill& fill) const {
    const auto is_drawn = [](const Chain& chain) { return !chain.empty(); };
    require(!fill.chains.empty() && std::ranges::all_of(fill.chains, is_drawn), "a fill without curves");
  }
  void operator()(const Text& text) const {
    require(text.place.allFinite() && std::isfinite(text.height) && std::isfinite(text.rotation),
            "a number of a text is not finite");
    require(text.height > 0.0, "a text's height is not positive");
  }
};

/// Adds to the bounds what the entity covers.
struct Measure {
  Rectangle& bounds;

  void operator()(const Chain& chain) const {
    for (const svg::PathSegment& segment : svg::path_segments(chain, tolerance)) add_extent(segment, bounds);
  }
  void operator()(const Path& path) const { (*this)(path.chain); }
  void operator()(const Polyline& polyline) const { bounds.add(polyline.points); }
  void operator()(const Circle& circle) const {
    const Vector2 radii = Vector2::Constant(circle.radius);
    bounds.add(circle.centre - radii);
    bounds.add(circle.centre + radii);
  }
  void operator()(const Fill& fill) const { std::ranges::for_each(fill.chains, *this); }
  void operator()(const Text& text) const {
    const double width = text_width(text.text, text.height);
    const Point2 start = text_origin(text);
    const double angle = text.rotation * std::numbers::pi / 180.0;
    const Vector2 along(std::cos(angle), std::sin(angle));
    const Vector2 up(-along.y(), along.x());
    for (const double x : {0.0, width}) {
      for (const double y : {-descent * text.height, text.height}) bounds.add(start + x * along + y * up);
    }
  }
};

struct Scale {
  double factor;
  Vector2 offset;

  Chain operator()(const Chain& chain) const {
    const geometry::AffineMap<2> map{factor * Eigen::Matrix2d::Identity(), offset};
    Chain result;
    for (const auto& curve : chain) result.push_back(transform(curve, map));
    return result;
  }
  Entity operator()(const Path& path) const { return Path{(*this)(path.chain)}; }
  Entity operator()(const Polyline& polyline) const {
    return Polyline{(factor * polyline.points).colwise() + offset, polyline.is_closed};
  }
  Entity operator()(const Circle& circle) const {
    return Circle{factor * circle.centre + offset, factor * circle.radius};
  }
  Entity operator()(const Fill& fill) const {
    Fill result{{}, fill.colour};
    for (const Chain& chain : fill.chains) result.chains.push_back((*this)(chain));
    return result;
  }
  Entity operator()(Text text) const {
    text.place = factor * text.place + offset;
    text.height *= factor;
    return text;
  }
};

}  // namespace

std::span<const double> dash_pattern(LineType type) {
  static constexpr std::array dashed{12.0, 3.0};
  static constexpr std::array chain{24.0, 3.0, 0.5, 3.0};
  static constexpr std::array dotted{0.5, 3.0};
  switch (type) {
    case LineType::dashed:
      return dashed;
    case LineType::chain:
      return chain;
    case LineType::dotted:
      return dotted;
    default:
      return {};
  }
}

Point2 text_origin(const Text& text) {
  const double width = text_width(text.text, text.height);
  const double across = text.horizontal == Horizontal::left ? 0.0 : text.horizontal == Horizontal::right ? 1.0 : 0.5;
  const double up = text.vertical == Vertical::baseline ? 0.0 : text.vertical == Vertical::top ? 1.0 : 0.5;
  const double angle = text.rotation * std::numbers::pi / 180.0;
  const Vector2 along(std::cos(angle), std::sin(angle));
  return text.place - across * width * along - up * text.height * Vector2(-along.y(), along.x());
}

std::size_t Drawing::add_layer(Layer layer) {
  if (layer.name.empty() || layer.name.size() > longest_name || std::ranges::any_of(layer.name, is_refused)) {
    throw InputError(
        fmt::format("layer \"{}\": a layer's name has 1 to 255 bytes and none of <>/\\\":;?*|,=`", layer.name));
  }
  if (!std::isfinite(layer.line_width) || layer.line_width <= 0.0)
    throw InputError(fmt::format("layer \"{}\": line_width is {}, expected more than 0", layer.name, layer.line_width));
  const std::string key = lower_case(layer.name);
  if (std::ranges::any_of(layers_, [&](const Layer& other) { return lower_case(other.name) == key; }))
    throw InputError(fmt::format("layer \"{}\": there is a layer of this name", layer.name));
  layers_.push_back(std::move(layer));
  entities_.emplace_back();
  return layers_.size() - 1;
}

void Drawing::add(std::size_t layer, Entity entity) {
  if (layer >= layers_.size())
    throw InputError(fmt::format("drawing: layer {} of {}: there is no such layer", layer, layers_.size()));
  std::visit(Check{}, entity);
  entities_[layer].push_back(std::move(entity));
}

void Drawing::add(const Drawing& other, const Vector2& offset) {
  for (std::size_t i = 0; i < other.layers_.size(); ++i) {
    const std::string key = lower_case(other.layers_[i].name);
    const auto same = std::ranges::find_if(layers_, [&](const Layer& own) { return lower_case(own.name) == key; });
    const std::size_t own =
        same != layers_.end() ? static_cast<std::size_t>(same - layers_.begin()) : add_layer(other.layers_[i]);
    for (const Entity& entity : std::vector<Entity>(other.entities_[i])) add(own, scaled(entity, 1.0, offset));
  }
}

std::size_t Drawing::layer(std::string_view name) const {
  const std::string key = lower_case(name);
  const auto found = std::ranges::find_if(layers_, [&](const Layer& own) { return lower_case(own.name) == key; });
  if (found == layers_.end()) throw InputError(fmt::format("drawing: there is no layer \"{}\"", name));
  return static_cast<std::size_t>(found - layers_.begin());
}

Rectangle extent(const Entity& entity) {
  Rectangle bounds;
  std::visit(Measure{bounds}, entity);
  return bounds;
}

Rectangle extent(const Drawing& drawing) {
  Rectangle bounds;
  for (std::size_t layer = 0; layer < drawing.layers().size(); ++layer) {
    for (const Entity& entity : drawing.entities(layer)) std::visit(Measure{bounds}, entity);
  }
  return bounds;
}

Entity scaled(const Entity& entity, double factor, const Vector2& offset) {
  return std::visit(Scale{factor, offset}, entity);
}

void require_page(const Sheet& sheet) {
  const Rectangle& page = sheet.page;
  if (!page.lower.allFinite() || !page.upper.allFinite() || !(page.lower.array() < page.upper.array()).all()) {
    throw InputError(fmt::format("sheet \"{}\": its page goes from ({}, {}) to ({}, {}) mm, expected an area",
                                 sheet.title, page.lower.x(), page.lower.y(), page.upper.x(), page.upper.y()));
  }
}

Sheet sheet_round(std::string title, Drawing drawing, double margin) {
  Rectangle page = extent(drawing);
  if (page.is_empty()) throw InputError(fmt::format("sheet \"{}\": there is nothing on it", title));
  page.lower.array() -= margin;
  page.upper.array() += margin;
  Sheet sheet{std::move(title), std::move(drawing), page};
  require_page(sheet);
  return sheet;
}

Polyline line(const Point2& from, const Point2& to) {
  Polyline result;
  result.points.resize(2, 2);
  result.points << from, to;
  return result;
}

Polyline outline(const Rectangle& rectangle) {
  Polyline result{Points<2>(2, 4), true};
  result.points << rectangle.lower.x(), rectangle.upper.x(), rectangle.upper.x(), rectangle.lower.x(),
      rectangle.lower.y(), rectangle.lower.y(), rectangle.upper.y(), rectangle.upper.y();
  return result;
}

}  // namespace isorim::io::drawing
