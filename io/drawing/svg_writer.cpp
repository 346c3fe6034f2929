#include "io/drawing/svg_writer.h"

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/drawing/page_path.h"
#include "io/drawing/text_metrics.h"
#include "io/svg/markup.h"

namespace isorim::io::drawing {

namespace {

using geometry::Point2;
using svg::number;
using svg::PathSegment;

std::string hexadecimal(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::string coordinate(double value) {
  return number(value, page_decimals);
}

/// What SVG has for the entities of one layer, y downwards.
class LayerMarkup {
 public:
  LayerMarkup(const Rectangle& page, const Layer& layer) : page_(page), layer_(layer) {}

  std::string operator()(const Path& path) const { return element(path_data(path.chain)); }
  std::string operator()(const Polyline& polyline) const {
    std::string data;
    for (Eigen::Index i = 0; i < polyline.points.cols(); ++i) {
      const Point2 point = on_page(polyline.points.col(i));
      data += fmt::format("{}{} {}", i == 0 ? 'M' : 'L', coordinate(point.x()), coordinate(point.y()));
    }
    return element(data + (polyline.is_closed ? "Z" : ""));
  }
  std::string operator()(const Circle& circle) const {
    const Point2 centre = on_page(circle.centre);
    return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", coordinate(centre.x()), coordinate(centre.y()),
                       coordinate(circle.radius));
  }
  std::string operator()(const Fill& fill) const {
    std::string data;
    for (const Chain& chain : fill.chains) data += path_data(chain);
    return fmt::format("<path d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"none\"/>\n", data,
                       hexadecimal(fill.colour));
  }
  std::string operator()(const Text& text) const;

 private:
  Point2 on_page(const Point2& point) const { return {point.x() - page_.lower.x(), page_.upper.y() - point.y()}; }
  static std::string element(const std::string& data) { return fmt::format("<path d=\"{}\"/>\n", data); }
  std::string path_data(const Chain& chain) const;

  Rectangle page_;
  const Layer& layer_;
};

std::string LayerMarkup::path_data(const Chain& chain) const {
  std::string data;
  for (const Subpath& subpath : subpaths(chain)) {
    const Point2 start = on_page(subpath.segments.front().col(0));
    data += fmt::format("M{} {}", coordinate(start.x()), coordinate(start.y()));
    for (PathSegment segment : subpath.segments) {
      for (Eigen::Index i = 0; i < segment.cols(); ++i) segment.col(i) = on_page(segment.col(i));
      data += svg::path_command(segment, page_decimals);
    }
    if (subpath.is_closed) data += "Z";
  }
  return data;
}

std::string LayerMarkup::operator()(const Text& text) const {
  const double up = text.vertical == Vertical::baseline ? 0.0 : text.vertical == Vertical::top ? 1.0 : 0.5;
  const Point2 place = on_page(text.place);
  std::string where;
  if (text.rotation == 0.0) {
    where = fmt::format("x=\"{}\" y=\"{}\"", coordinate(place.x()), coordinate(place.y() + up * text.height));
  } else {
    where = fmt::format("transform=\"translate({} {}) rotate({})\" y=\"{}\"", coordinate(place.x()),
                        coordinate(place.y()), coordinate(-text.rotation), coordinate(up * text.height));
  }
  const char* anchor = text.horizontal == Horizontal::left     ? ""
                       : text.horizontal == Horizontal::centre ? " text-anchor=\"middle\""
                                                               : " text-anchor=\"end\"";
  return fmt::format("<text {} font-size=\"{}\"{} fill=\"{}\" stroke=\"none\">{}</text>\n", where,
                     coordinate(text.height / cap_height), anchor, hexadecimal(layer_.colour), svg::escape(text.text));
}

std::string dashes(const Layer& layer) {
  std::string list;
  for (const double length : dash_pattern(layer.line_type))
    list += (list.empty() ? "" : " ") + coordinate(length * layer.line_width);
  return list.empty() ? list : fmt::format(" stroke-dasharray=\"{}\"", list);
}

std::string layer_group(const Sheet& sheet, std::size_t i) {
  const Layer& layer = sheet.drawing.layers()[i];
  if (sheet.drawing.entities(i).empty()) return "";
  const LayerMarkup markup(sheet.page, layer);
  std::string content;
  for (const Entity& entity : sheet.drawing.entities(i)) content += std::visit(markup, entity);
  return fmt::format(
      "<g id=\"layer{}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\" stroke=\"{}\" stroke-width=\"{}\"{}>\n"
      "{}</g>\n",
      i + 1, svg::escape(layer.name), hexadecimal(layer.colour), coordinate(layer.line_width), dashes(layer), content);
}

}  // namespace

std::string to_svg(const Sheet& sheet) {
  require_page(sheet);
  std::string result = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
      "width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" "
      "fill=\"none\" stroke-linejoin=\"round\">\n",
      coordinate(sheet.width()), coordinate(sheet.height()));
  if (!sheet.title.empty()) result += fmt::format("<title>{}</title>\n", svg::escape(sheet.title));
  result += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", coordinate(sheet.width()),
                        coordinate(sheet.height()));
  for (std::size_t i = 0; i < sheet.drawing.layers().size(); ++i) result += layer_group(sheet, i);
  return result + "</svg>\n";
}

void write_svg(const std::filesystem::path& path, const Sheet& sheet) {
  write_file(path, to_svg(sheet));
}

}  // namespace isorim::io::drawing
