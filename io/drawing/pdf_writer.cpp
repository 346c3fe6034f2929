#include "io/drawing/pdf_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "io/atomic_file.h"
#include "io/drawing/page_path.h"
#include "io/drawing/pdf_document.h"
#include "io/drawing/text_metrics.h"
#include "io/svg/markup.h"

namespace isorim::io::drawing {

namespace {

using geometry::Point2;
using svg::number;
using svg::PathSegment;

constexpr double points_per_mm = 72.0 / 25.4;

std::string coordinate(double value) {
  return number(value, page_decimals);
}

std::string colour_operands(const Colour& colour) {
  return fmt::format("{} {} {}", number(colour.red / 255.0, 4), number(colour.green / 255.0, 4),
                     number(colour.blue / 255.0, 4));
}

/// A segment of degree 2 as one of degree 3: PDF has no others.
PathSegment as_cubic(const PathSegment& segment) {
  if (segment.cols() != 3) return segment;
  PathSegment cubic(2, 4);
  cubic << segment.col(0), (segment.col(0) + 2.0 * segment.col(1)) / 3.0, (2.0 * segment.col(1) + segment.col(2)) / 3.0,
      segment.col(2);
  return cubic;
}

/// The operators that draw entities, in mm from `origin`.
class Operators {
 public:
  Operators(const Point2& origin, const Layer& layer) : origin_(origin), layer_(layer) {}

  std::string operator()(const Path& path) const { return construct(path.chain) + "S\n"; }
  std::string operator()(const Polyline& polyline) const {
    std::string result;
    for (Eigen::Index i = 0; i < polyline.points.cols(); ++i)
      result += operands(polyline.points.col(i)) + (i == 0 ? "m\n" : "l\n");
    return result + (polyline.is_closed ? "s\n" : "S\n");
  }
  std::string operator()(const Circle& circle) const {
    return construct({geometry::circle_curve(circle.radius, circle.centre)}) + "S\n";
  }
  std::string operator()(const Fill& fill) const {
    std::string result = colour_operands(fill.colour) + " rg\n";
    for (const Chain& chain : fill.chains) result += construct(chain);
    return result + "f*\n";
  }
  std::string operator()(const Text& text) const;

 private:
  std::string operands(const Point2& point) const {
    return fmt::format("{} {} ", coordinate(point.x() - origin_.x()), coordinate(point.y() - origin_.y()));
  }
  std::string construct(const Chain& chain) const;

  Point2 origin_;
  const Layer& layer_;
};

std::string Operators::construct(const Chain& chain) const {
  std::string result;
  for (const Subpath& subpath : subpaths(chain)) {
    result += operands(subpath.segments.front().col(0)) + "m\n";
    for (const PathSegment& segment : subpath.segments) {
      const PathSegment drawn = as_cubic(segment);
      for (Eigen::Index i = 1; i < drawn.cols(); ++i) result += operands(drawn.col(i));
      result += drawn.cols() == 2 ? "l\n" : "c\n";
    }
    if (subpath.is_closed) result += "h\n";
  }
  return result;
}

std::string Operators::operator()(const Text& text) const {
  const double angle = text.rotation * std::numbers::pi / 180.0;
  const std::string cosine = number(std::cos(angle), 6);
  const std::string sine = number(std::sin(angle), 6);
  const std::string minus_sine = number(-std::sin(angle), 6);
  const std::string size = coordinate(text.height / cap_height);
  std::string result = fmt::format("BT {} rg {} {} {} {} {}Tm\n", colour_operands(layer_.colour), cosine, sine,
                                   minus_sine, cosine, operands(text_origin(text)));
  for (const TextRun& run : text_runs(text.text))
    result += fmt::format("/{} {} Tf {} Tj\n", run.font == Font::helvetica ? "F1" : "F2", size, pdf_bytes(run.bytes));
  return result + "ET\n";
}

std::string dash_operands(const Layer& layer) {
  std::string list;
  for (const double length : dash_pattern(layer.line_type)) list += coordinate(length * layer.line_width) + " ";
  return "[" + list + "] 0 d";
}

/// The objects that all pages share, and the pages.
class Writer {
 public:
  Writer() {
    pages_ = document_.reserve();
    const std::string_view font = "<< /Type /Font /Subtype /Type1 /BaseFont /{}{} >>";
    const int helvetica = document_.add(fmt::format(fmt::runtime(font), "Helvetica", " /Encoding /WinAnsiEncoding"));
    const int symbol = document_.add(fmt::format(fmt::runtime(font), "Symbol", ""));
    fonts_ = fmt::format("/Font << /F1 {} /F2 {} >>", pdf_reference(helvetica), pdf_reference(symbol));
  }

  void add(const Sheet& sheet, const std::optional<Tiling>& tiling);
  std::string file(const std::string& title);

 private:
  int layer_object(const std::string& name);
  /// The operators that draw the drawing, the properties (layers) that they name added to the list.
  std::string content(const Drawing& drawing, const Point2& origin, std::map<std::string, int>& properties);
  std::string resources(const std::map<std::string, int>& properties) const;
  void add_page(double width, double height, const std::string& content, const std::string& resources);
  /// `sheet`: the object that draws the sheet.
  void add_map(const AssemblyMap& map, const std::string& sheet);

  PdfDocument document_;
  int pages_ = 0;
  std::string fonts_;
  std::vector<int> page_objects_;
  std::vector<int> layer_objects_;
  std::map<std::string, int> layers_;
};

int Writer::layer_object(const std::string& name) {
  const auto [entry, is_new] = layers_.try_emplace(name, 0);
  if (is_new) {
    entry->second = document_.add(fmt::format("<< /Type /OCG /Name {} >>", pdf_text(name)));
    layer_objects_.push_back(entry->second);
  }
  return entry->second;
}

std::string Writer::content(const Drawing& drawing, const Point2& origin, std::map<std::string, int>& properties) {
  std::string result = "1 j\n";
  for (std::size_t i = 0; i < drawing.layers().size(); ++i) {
    if (drawing.entities(i).empty()) continue;
    const Layer& layer = drawing.layers()[i];
    const int object = layer_object(layer.name);
    const std::string property = fmt::format("L{}", object);
    properties[property] = object;
    fmt::format_to(std::back_inserter(result), "/OC /{} BDC\nq\n{} RG {} w {}\n", property,
                   colour_operands(layer.colour), coordinate(layer.line_width), dash_operands(layer));
    const Operators operators(origin, layer);
    for (const Entity& entity : drawing.entities(i)) result += std::visit(operators, entity);
    result += "Q\nEMC\n";
  }
  return result;
}

std::string Writer::resources(const std::map<std::string, int>& properties) const {
  std::string list;
  for (const auto& [name, object] : properties) list += fmt::format(" /{} {}", name, pdf_reference(object));
  return fonts_ + (list.empty() ? "" : " /Properties <<" + list + " >>");
}

void Writer::add_page(double width, double height, const std::string& content, const std::string& resources) {
  const std::string scaled = fmt::format("q\n{0} 0 0 {0} 0 0 cm\n{1}Q", number(points_per_mm, 9), content);
  const int stream = document_.add_stream("", scaled);
  page_objects_.push_back(document_.add(fmt::format(
      "<< /Type /Page /Parent {} /MediaBox [0 0 {} {}] /Resources << {} >> /Contents {} >>", pdf_reference(pages_),
      number(width * points_per_mm, 4), number(height * points_per_mm, 4), resources, pdf_reference(stream))));
}

void Writer::add_map(const AssemblyMap& map, const std::string& sheet) {
  std::map<std::string, int> properties;
  const std::string marks = content(map.marks, Point2::Zero(), properties);
  const std::string page = fmt::format("q\n{0} 0 0 {0} {1} {2} cm\n/Sheet Do\nQ\n{3}", number(map.factor, 9),
                                       coordinate(map.place.x()), coordinate(map.place.y()), marks);
  add_page(map.paper_width, map.paper_height, page,
           resources(properties) + fmt::format(" /XObject << /Sheet {} >>", sheet));
}

void Writer::add(const Sheet& sheet, const std::optional<Tiling>& tiling) {
  require_page(sheet);
  if (!tiling && std::max(sheet.width(), sheet.height()) > longest_pdf_side) {
    throw InputError(
        fmt::format("sheet \"{}\": {:.6g} x {:.6g} mm, but a page of a PDF file has at most {} mm: tile it",
                    sheet.title, sheet.width(), sheet.height(), longest_pdf_side));
  }
  std::map<std::string, int> properties;
  const std::string drawn = content(sheet.drawing, sheet.page.lower, properties);
  if (!tiling) return add_page(sheet.width(), sheet.height(), drawn, resources(properties));
  const std::string form = fmt::format("/Type /XObject /Subtype /Form /BBox [0 0 {} {}] /Resources << {} >>",
                                       coordinate(sheet.width()), coordinate(sheet.height()), resources(properties));
  const std::string object = pdf_reference(document_.add_stream(form, drawn));
  const std::vector<Tile> tiles = tiles_of(sheet, *tiling);
  if (tiles.size() > 1) add_map(assembly_map(sheet, tiles, *tiling), object);
  for (const Tile& tile : tiles) {
    const geometry::Vector2 size = tile.part.upper - tile.part.lower;
    const geometry::Vector2 shift = tile.place - (tile.part.lower - sheet.page.lower);
    std::map<std::string, int> mark_properties;
    const std::string marks = content(tile.marks, Point2::Zero(), mark_properties);
    const std::string page = fmt::format("q\n{} {} {} {} re W n\n1 0 0 1 {} {} cm\n/Sheet Do\nQ\n{}",
                                         coordinate(tile.place.x()), coordinate(tile.place.y()), coordinate(size.x()),
                                         coordinate(size.y()), number(shift.x(), 6), number(shift.y(), 6), marks);
    add_page(tile.paper_width, tile.paper_height, page,
             resources(mark_properties) + fmt::format(" /XObject << /Sheet {} >>", object));
  }
}

std::string references(const std::vector<int>& objects) {
  std::string result;
  for (const int object : objects) result += (result.empty() ? "" : " ") + pdf_reference(object);
  return result;
}

std::string Writer::file(const std::string& title) {
  document_.set(
      pages_, fmt::format("<< /Type /Pages /Kids [{}] /Count {} >>", references(page_objects_), page_objects_.size()));
  std::string layers;
  if (!layer_objects_.empty()) {
    const std::string list = references(layer_objects_);
    layers = fmt::format(" /OCProperties << /OCGs [{}] /D << /Order [{}] /ON [{}] >> >>", list, list, list);
  }
  // Readers that scale pages to the paper by default are asked not to.
  const int catalogue = document_.add(fmt::format(
      "<< /Type /Catalog /Pages {} /ViewerPreferences << /PrintScaling /None >>{} >>", pdf_reference(pages_), layers));
  const int information = document_.add(fmt::format("<< /Title {} /Producer (isorim) >>", pdf_text(title)));
  return document_.file(catalogue, information);
}

}  // namespace

std::string to_pdf(std::span<const Sheet> sheets, const PdfOptions& options) {
  if (sheets.empty()) throw InputError("PDF: there is no sheet");
  Writer writer;
  for (const Sheet& sheet : sheets) writer.add(sheet, options.tiling);
  return writer.file(options.title.empty() ? sheets.front().title : options.title);
}

void write_pdf(const std::filesystem::path& path, std::span<const Sheet> sheets, const PdfOptions& options) {
  write_file(path, to_pdf(sheets, options));
}

}  // namespace isorim::io::drawing
