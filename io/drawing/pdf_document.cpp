#include "io/drawing/pdf_document.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "io/drawing/text_metrics.h"

namespace isorim::io::drawing {

int PdfDocument::reserve() {
  bodies_.emplace_back();
  return static_cast<int>(bodies_.size());
}

int PdfDocument::add(std::string body) {
  bodies_.push_back(std::move(body));
  return static_cast<int>(bodies_.size());
}

int PdfDocument::add_stream(std::string_view entries, std::string_view data) {
  return add(fmt::format("<< {} /Length {} >>\nstream\n{}\nendstream", entries, data.size(), data));
}

std::string PdfDocument::file(int catalogue, int information) const {
  // Four bytes above 127 tell that the file is binary; layers need version 1.5.
  std::string result = "%PDF-1.5\n%\xE2\xE3\xCF\xD3\n";
  std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", bodies_.size() + 1);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    fmt::format_to(std::back_inserter(table), "{:010} 00000 n \n", result.size());
    fmt::format_to(std::back_inserter(result), "{} 0 obj\n{}\nendobj\n", i + 1, bodies_[i]);
  }
  const std::size_t start = result.size();
  return result + table +
         fmt::format("trailer\n<< /Size {} /Root {} /Info {} >>\nstartxref\n{}\n%%EOF\n", bodies_.size() + 1,
                     pdf_reference(catalogue), pdf_reference(information), start);
}

std::string pdf_reference(int object) {
  return fmt::format("{} 0 R", object);
}

std::string pdf_bytes(std::string_view bytes) {
  std::string result = "(";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '(' || c == ')' || c == '\\') {
      result += {'\\', c};
    } else if (byte < 0x20 || byte >= 0x7F) {
      result += fmt::format("\\{:03o}", byte);
    } else {
      result += c;
    }
  }
  return result + ")";
}

std::string pdf_text(std::string_view text) {
  if (std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; })) return pdf_bytes(text);
  std::string result = "<FEFF";
  for (const char32_t c : code_points(text)) {
    if (c < 0x10000) {
      result += fmt::format("{:04X}", static_cast<unsigned>(c));
    } else {
      const auto rest = static_cast<unsigned>(c - 0x10000);
      result += fmt::format("{:04X}{:04X}", 0xD800 + (rest >> 10), 0xDC00 + (rest & 0x3FFU));
    }
  }
  return result + ">";
}

}  // namespace isorim::io::drawing
