#pragma once

#include <string>
#include <string_view>

#include "geometry/vocabulary.h"
#include "io/drawing/drawing.h"

/// The text of DXF files: pairs of a group code and a value, one a line.
namespace isorim::io::drawing {

/// Handles that the file's parts name.
struct DxfHandles {
  static constexpr std::string_view model_space = "1F";
  static constexpr std::string_view paper_space = "1B";
};

class DxfText {
 public:
  void group(int code, std::string_view value);
  void group(int code, const char* value) { group(code, std::string_view(value)); }
  void group(int code, int value);
  /// With all digits.
  void group(int code, double value);
  /// x, y and z = 0 with the codes `code`, `code` + 10, `code` + 20.
  void point(int code, const geometry::Point2& point);
  /// x and y alone.
  void plane_point(int code, const geometry::Point2& point);
  /// Starts an object that belongs to `owner`, with a new handle.
  void start(std::string_view type, std::string_view owner);
  /// Starts an entity of the model on a layer.
  void start_entity(std::string_view type, const std::string& layer);

  const std::string& text() const { return text_; }
  /// The handle that the next object will get, in hexadecimal.
  std::string next_handle() const;

 private:
  std::string text_;
  /// Those below belong to tables and dictionaries.
  int next_handle_ = 0x100;
};

/// Everything before the entities: header, tables and blocks; what comes after them: the dictionaries. `seed`: a
/// handle that no object has.
std::string dxf_head(const Drawing& drawing, const Rectangle& bounds, double scale, const std::string& seed);
std::string dxf_tail();

/// A text for people as a DXF string: in Windows-1252, as the header says, other characters as \U+xxxx.
std::string dxf_string(std::string_view text);

}  // namespace isorim::io::drawing
