#include "io/drawing/dxf_records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "io/drawing/dxf_writer.h"
#include "io/drawing/text_metrics.h"

namespace isorim::io::drawing {

namespace {

/// Of dash patterns in the table of line types, in mm.
constexpr double reference_width = 0.25;

constexpr std::array line_types{LineType::dashed, LineType::chain, LineType::dotted};

/// Line widths that AutoCAD knows, in 1/100 mm.
int nearest_weight(double width) {
  constexpr std::array weights{0,  5,  9,  13, 15, 18,  20,  25,  30,  35,  40,  50,
                               53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211};
  return *std::ranges::min_element(weights, {}, [&](int weight) { return std::abs(weight - 100.0 * width); });
}

const char* name_of(LineType type) {
  switch (type) {
    case LineType::dashed:
      return "DASHED";
    case LineType::chain:
      return "CHAIN";
    case LineType::dotted:
      return "DOTTED";
    default:
      return "Continuous";
  }
}

/// Tables and dictionaries, whose handles are fixed.
class Frame {
 public:
  void open_section(const char* name) {
    out_.group(0, "SECTION");
    out_.group(2, name);
  }
  void close_section() { out_.group(0, "ENDSEC"); }
  void header(const Rectangle& bounds, double scale, const std::string& seed);
  void tables(const Drawing& drawing);
  void blocks();
  void objects();
  std::string text() const { return out_.text(); }

 private:
  void variable(const char* name) { out_.group(9, name); }
  void open_table(const char* name, const char* handle, std::size_t entries);
  void close_table() { out_.group(0, "ENDTAB"); }
  void object(const char* type, std::string_view handle, std::string_view owner) {
    out_.group(0, type);
    out_.group(5, handle);
    out_.group(330, owner);
  }
  void entry(const char* type, std::string_view handle, const char* table, const char* record, std::string_view name);
  void view();
  void line_type(const char* name, std::string_view handle, LineType type);
  void layer(const Layer& layer, const std::string& handle);
  void text_style();
  void dimension_style();
  void block(std::string_view record, const char* first, const char* last, const char* name);
  void dictionary(const char* handle, const char* owner,
                  const std::vector<std::pair<const char*, const char*>>& entries);
  void layout(const char* handle, const char* name, std::string_view record, int tab);

  DxfText out_;
};

void Frame::header(const Rectangle& bounds, double scale, const std::string& seed) {
  const bool is_empty = bounds.is_empty();
  const geometry::Point2 lower = is_empty ? geometry::Point2::Zero() : geometry::Point2(bounds.lower);
  const geometry::Point2 upper = is_empty ? geometry::Point2::Ones() : geometry::Point2(bounds.upper);
  open_section("HEADER");
  variable("$ACADVER");
  out_.group(1, "AC1015");
  variable("$DWGCODEPAGE");
  out_.group(3, "ANSI_1252");
  variable("$INSBASE");
  out_.point(10, geometry::Point2::Zero());
  variable("$EXTMIN");
  out_.point(10, lower);
  variable("$EXTMAX");
  out_.point(10, upper);
  variable("$LTSCALE");
  out_.group(40, scale);
  variable("$INSUNITS");
  out_.group(70, 4);
  variable("$MEASUREMENT");
  out_.group(70, 1);
  variable("$LWDISPLAY");
  out_.group(290, 1);
  variable("$HANDSEED");
  out_.group(5, seed);
  close_section();
}

void Frame::open_table(const char* name, const char* handle, std::size_t entries) {
  out_.group(0, "TABLE");
  out_.group(2, name);
  out_.group(5, handle);
  out_.group(330, "0");
  out_.group(100, "AcDbSymbolTable");
  out_.group(70, static_cast<int>(entries));
}

void Frame::entry(const char* type, std::string_view handle, const char* table, const char* record,
                  std::string_view name) {
  object(type, handle, table);
  out_.group(100, "AcDbSymbolTableRecord");
  out_.group(100, record);
  out_.group(2, name);
}

void Frame::view() {
  entry("VPORT", "29", "8", "AcDbViewportTableRecord", "*Active");
  out_.group(70, 0);
  out_.plane_point(10, {0, 0});
  out_.plane_point(11, {1, 1});
  out_.plane_point(12, {0, 0});
  out_.plane_point(13, {0, 0});
  out_.plane_point(14, {10, 10});
  out_.plane_point(15, {10, 10});
  out_.point(16, {0, 0});
  out_.point(17, {0, 0});
  out_.group(40, 300.0);
  out_.group(41, 1.5);
  out_.group(42, 50.0);
}

void Frame::line_type(const char* name, std::string_view handle, LineType type) {
  entry("LTYPE", handle, "5", "AcDbLinetypeTableRecord", name);
  const auto pattern = dash_pattern(type);
  double length = 0.0;
  for (const double part : pattern) length += part * reference_width;
  out_.group(70, 0);
  out_.group(3, type == LineType::continuous ? "" : name);
  out_.group(72, 65);
  out_.group(73, static_cast<int>(pattern.size()));
  out_.group(40, length);
  double sign = 1.0;
  for (const double part : pattern) {
    out_.group(49, sign * part * reference_width);
    out_.group(74, 0);
    sign = -sign;
  }
}

void Frame::layer(const Layer& layer, const std::string& handle) {
  entry("LAYER", handle, "2", "AcDbLayerTableRecord", dxf_string(layer.name));
  out_.group(70, 0);
  out_.group(62, colour_index(layer.colour));
  out_.group(6, name_of(layer.line_type));
  out_.group(370, nearest_weight(layer.line_width));
  out_.group(390, "F");
}

void Frame::text_style() {
  entry("STYLE", "11", "3", "AcDbTextStyleTableRecord", "Standard");
  out_.group(70, 0);
  out_.group(40, 0.0);
  out_.group(41, 1.0);
  out_.group(50, 0.0);
  out_.group(71, 0);
  out_.group(42, 2.5);
  out_.group(3, "arial.ttf");
  out_.group(4, "");
}

void Frame::dimension_style() {
  out_.group(0, "DIMSTYLE");
  out_.group(105, "27");
  out_.group(330, "A");
  out_.group(100, "AcDbSymbolTableRecord");
  out_.group(100, "AcDbDimStyleTableRecord");
  out_.group(2, "Standard");
  out_.group(70, 0);
}

void Frame::tables(const Drawing& drawing) {
  open_section("TABLES");
  open_table("VPORT", "8", 1);
  view();
  close_table();
  open_table("LTYPE", "5", 3 + line_types.size());
  line_type("ByBlock", "14", LineType::continuous);
  line_type("ByLayer", "15", LineType::continuous);
  line_type("Continuous", "16", LineType::continuous);
  for (std::size_t i = 0; i < line_types.size(); ++i)
    line_type(name_of(line_types[i]), fmt::format("{:X}", 0x40 + i), line_types[i]);
  close_table();
  const bool has_zero = std::ranges::any_of(drawing.layers(), [](const Layer& own) { return own.name == "0"; });
  open_table("LAYER", "2", drawing.layers().size() + (has_zero ? 0 : 1));
  if (!has_zero) layer({"0"}, "10");
  for (std::size_t i = 0; i < drawing.layers().size(); ++i)
    layer(drawing.layers()[i], drawing.layers()[i].name == "0" ? "10" : fmt::format("{:X}", 0x10000000 + i));
  close_table();
  open_table("STYLE", "3", 1);
  text_style();
  close_table();
  open_table("VIEW", "6", 0);
  close_table();
  open_table("UCS", "7", 0);
  close_table();
  open_table("APPID", "9", 1);
  entry("APPID", "12", "9", "AcDbRegAppTableRecord", "ACAD");
  out_.group(70, 0);
  close_table();
  open_table("DIMSTYLE", "A", 1);
  out_.group(100, "AcDbDimStyleTable");
  dimension_style();
  close_table();
  open_table("BLOCK_RECORD", "1", 2);
  entry("BLOCK_RECORD", DxfHandles::model_space, "1", "AcDbBlockTableRecord", "*Model_Space");
  out_.group(340, "22");
  entry("BLOCK_RECORD", DxfHandles::paper_space, "1", "AcDbBlockTableRecord", "*Paper_Space");
  out_.group(340, "1E");
  close_table();
  close_section();
}

void Frame::block(std::string_view record, const char* first, const char* last, const char* name) {
  const auto start = [&](const char* type, const char* handle, const char* kind) {
    object(type, handle, record);
    out_.group(100, "AcDbEntity");
    if (record == DxfHandles::paper_space) out_.group(67, 1);
    out_.group(8, "0");
    out_.group(100, kind);
  };
  start("BLOCK", first, "AcDbBlockBegin");
  out_.group(2, name);
  out_.group(70, 0);
  out_.point(10, {0, 0});
  out_.group(3, name);
  out_.group(1, "");
  start("ENDBLK", last, "AcDbBlockEnd");
}

void Frame::blocks() {
  open_section("BLOCKS");
  block(DxfHandles::model_space, "20", "21", "*Model_Space");
  block(DxfHandles::paper_space, "1C", "1D", "*Paper_Space");
  close_section();
}

void Frame::dictionary(const char* handle, const char* owner,
                       const std::vector<std::pair<const char*, const char*>>& entries) {
  object("DICTIONARY", handle, owner);
  out_.group(100, "AcDbDictionary");
  out_.group(281, 1);
  for (const auto& [name, value] : entries) {
    out_.group(3, name);
    out_.group(350, value);
  }
}

void Frame::layout(const char* handle, const char* name, std::string_view record, int tab) {
  object("LAYOUT", handle, "1A");
  out_.group(100, "AcDbPlotSettings");
  for (const int code : {1, 2, 4, 6}) out_.group(code, "");
  for (const int code : {40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 140, 141}) out_.group(code, 0.0);
  out_.group(142, 1.0);
  out_.group(143, 1.0);
  // Line widths are plotted; the model's sheet is marked as such.
  out_.group(70, tab == 0 ? 1024 + 688 : 688);
  out_.group(72, 1);
  out_.group(73, 0);
  out_.group(74, 5);
  out_.group(7, "");
  out_.group(75, 16);
  out_.group(147, 1.0);
  out_.group(148, 0.0);
  out_.group(149, 0.0);
  out_.group(100, "AcDbLayout");
  out_.group(1, name);
  out_.group(70, 1);
  out_.group(71, tab);
  out_.plane_point(10, {0, 0});
  out_.plane_point(11, {210, 297});
  for (const int code : {12, 14, 15}) out_.point(code, {0, 0});
  out_.group(146, 0.0);
  out_.point(13, {0, 0});
  out_.point(16, {1, 0});
  out_.point(17, {0, 1});
  out_.group(76, 0);
  out_.group(330, record);
}

void Frame::objects() {
  open_section("OBJECTS");
  dictionary("C", "0", {{"ACAD_GROUP", "D"}, {"ACAD_LAYOUT", "1A"}, {"ACAD_PLOTSTYLENAME", "E"}});
  dictionary("D", "C", {});
  dictionary("1A", "C", {{"Layout1", "1E"}, {"Model", "22"}});
  object("ACDBDICTIONARYWDFLT", "E", "C");
  out_.group(100, "AcDbDictionary");
  out_.group(281, 1);
  out_.group(3, "Normal");
  out_.group(350, "F");
  out_.group(100, "AcDbDictionaryWithDefault");
  out_.group(340, "F");
  object("ACDBPLACEHOLDER", "F", "E");
  layout("22", "Model", DxfHandles::model_space, 0);
  layout("1E", "Layout1", DxfHandles::paper_space, 1);
  close_section();
}

}  // namespace

void DxfText::group(int code, std::string_view value) {
  fmt::format_to(std::back_inserter(text_), "{:3}\n{}\n", code, value);
}

void DxfText::group(int code, int value) {
  fmt::format_to(std::back_inserter(text_), "{:3}\n{}\n", code, value);
}

void DxfText::group(int code, double value) {
  std::string number = fmt::format("{}", value == 0.0 ? 0.0 : value);
  if (number.find_first_of(".e") == std::string::npos) number += ".0";
  group(code, std::string_view(number));
}

void DxfText::plane_point(int code, const geometry::Point2& point) {
  group(code, point.x());
  group(code + 10, point.y());
}

void DxfText::point(int code, const geometry::Point2& point) {
  plane_point(code, point);
  group(code + 20, 0.0);
}

std::string DxfText::next_handle() const {
  return fmt::format("{:X}", next_handle_);
}

void DxfText::start(std::string_view type, std::string_view owner) {
  group(0, type);
  group(5, std::string_view(next_handle()));
  ++next_handle_;
  group(330, owner);
}

void DxfText::start_entity(std::string_view type, const std::string& layer) {
  start(type, DxfHandles::model_space);
  group(100, "AcDbEntity");
  group(8, std::string_view(dxf_string(layer)));
}

std::string dxf_string(std::string_view text) {
  std::string result;
  for (const char32_t c : code_points(text)) {
    if (c < 0x20) {
      result += ' ';
    } else if (c == U'^') {
      result += "^ ";
    } else if (const auto byte = windows_1252_byte(c)) {
      result += static_cast<char>(*byte);
    } else {
      result += c < 0x10000 ? fmt::format("\\U+{:04X}", static_cast<std::uint32_t>(c)) : "?";
    }
  }
  return result;
}

std::string dxf_head(const Drawing& drawing, const Rectangle& bounds, double scale, const std::string& seed) {
  Frame frame;
  frame.header(bounds, scale, seed);
  frame.open_section("CLASSES");
  frame.close_section();
  frame.tables(drawing);
  frame.blocks();
  return frame.text();
}

std::string dxf_tail() {
  Frame frame;
  frame.objects();
  return frame.text();
}

}  // namespace isorim::io::drawing
