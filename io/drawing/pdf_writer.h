#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "io/drawing/drawing.h"
#include "io/drawing/tiles.h"

/// Sheets as PDF files in true size.
namespace isorim::io::drawing {

struct PdfOptions {
  /// Of the document; by default that of the first sheet.
  std::string title = {};
  /// Each sheet as pages of this paper, where there are several after a map of them; by default as one page of its own
  /// size.
  std::optional<Tiling> tiling = std::nullopt;
};

/// The largest side of a page that PDF readers accept (ISO 32000-1, annex C.2: 14400 points), in mm.
inline constexpr double longest_pdf_side = 5080.0;

/// The sheets one after the other as a vector PDF of version 1.5, the same bytes on every machine: no date, and text in
/// the fonts that every reader has. Layers are optional content, so a reader can switch them off. Polynomial Bézier
/// segments of degree 3 at most are drawn exactly, others by cubics within 0.0005 mm; coordinates are rounded to
/// 0.0001 mm. Throws InputError as require_page() and tiles_of(), if there is no sheet, or if one is longer than
/// longest_pdf_side and not tiled.
std::string to_pdf(std::span<const Sheet> sheets, const PdfOptions& options = {});

/// Writes to_pdf() atomically; errors as write_file().
void write_pdf(const std::filesystem::path& path, std::span<const Sheet> sheets, const PdfOptions& options = {});

}  // namespace isorim::io::drawing
