#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The objects of a PDF file (ISO 32000-1).
namespace isorim::io::drawing {

class PdfDocument {
 public:
  /// The number of an object that is set later.
  int reserve();
  void set(int object, std::string body) { bodies_[static_cast<std::size_t>(object - 1)] = std::move(body); }
  int add(std::string body);
  /// `entries`: of the stream's dictionary, but for its length.
  int add_stream(std::string_view entries, std::string_view data);

  /// The file: header, objects, cross-reference table, trailer. Every reserved object has been set.
  std::string file(int catalogue, int information) const;

 private:
  std::vector<std::string> bodies_;
};

/// "12 0 R"
std::string pdf_reference(int object);
/// A string of bytes in a font's encoding: "(text)".
std::string pdf_bytes(std::string_view bytes);
/// A text string for people to read, from UTF-8: "(text)" or UTF-16 in hexadecimal.
std::string pdf_text(std::string_view text);

}  // namespace isorim::io::drawing
