#include "io/results/drawings.h"

#include <variant>

#include "io/drawing/dxf_writer.h"
#include "io/drawing/pdf_writer.h"
#include "io/drawing/svg_writer.h"
#include "io/moulds/moulds.h"
#include "io/propeller/overview.h"

namespace isorim::io {

void write_sheet(const std::filesystem::path& folder, const std::string& stem, const drawing::Sheet& sheet,
                 const DrawingKeys& keys, double scale) {
  drawing::PdfOptions options;
  if (keys.sheets == SheetCut::a4) options.tiling = drawing::Tiling{};
  if (keys.has(DrawingFormat::pdf)) write_pdf(folder / (stem + ".pdf"), {&sheet, 1}, options);
  if (keys.has(DrawingFormat::svg)) write_svg(folder / (stem + ".svg"), sheet);
  if (keys.has(DrawingFormat::dxf)) write_dxf(folder / (stem + ".dxf"), sheet.drawing, {scale});
}

std::vector<std::string> write_drawings(const std::filesystem::path& folder, const CaseFile& file,
                                        const AnyModel& model, int threads) {
  const auto* solid = std::get_if<Model<3>>(&model);
  if (solid == nullptr) return {};
  if (file.keys.drawings && file.keys.drawings->overview && file.propeller) {
    const DrawingKeys& keys = *file.keys.drawings;
    const Overview overview = propeller_overview(*file.propeller, file.title(), {keys.millimetres, keys.scale});
    write_sheet(folder, "overview", overview.sheet, keys, overview.scale);
  }
  if (!file.keys.moulds) return {};
  return write_moulds(folder, file, solid->oriented.boundary, threads);
}

}  // namespace isorim::io
