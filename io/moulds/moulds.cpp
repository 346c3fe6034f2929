#include "io/moulds/moulds.h"

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/transforms.h"
#include "io/atomic_file.h"
#include "io/drawing/dxf_writer.h"
#include "io/drawing/pdf_writer.h"
#include "io/drawing/svg_writer.h"
#include "io/moulds/mould_sheets.h"
#include "io/propeller/propeller_facts.h"

namespace isorim::io {
namespace {

constexpr const char* blade_name = "blade_1";

bool belongs_to_blade(const std::string& patch) {
  const std::string first = blade_name;
  return patch == first || patch.starts_with(first + "_");
}

/// The first blade of a screw.
void take_blade(const PropellerFacts& facts, double millimetres, MouldBody& body) {
  if (facts.whole) body.boundary = *facts.whole;
  std::erase_if(body.boundary.patches, [](const auto& patch) { return !belongs_to_blade(patch.name); });
  for (std::size_t i = 0; i < body.boundary.patches.size(); ++i)
    if (body.boundary.patches[i].name == blade_name) body.blade = static_cast<int>(i);
  if (!facts.screw.hub) return;
  body.hub_radius = (facts.feet ? facts.feet->largest_radius : facts.screw.hub->radius) * millimetres;
  if (facts.feet)
    body.root = geometry::Interval{facts.feet->extent.first * millimetres, facts.feet->extent.last * millimetres};
}

drawing::Sheet overlay_sheet(const MouldStack& stack, const std::string& title) {
  return drawing::sheet_round(title + ": all sections", mould_overlay(stack));
}

void write_files(const std::filesystem::path& folder, const MouldStack& stack, const std::string& title,
                 const DrawingKeys& keys) {
  write_file(folder / "moulds.csv", mould_table(stack));
  const std::vector<drawing::Sheet> sheets = mould_sheets(stack, title);
  if (keys.has(DrawingFormat::pdf)) {
    drawing::PdfOptions options{title};
    if (keys.sheets == SheetCut::a4) options.tiling = drawing::Tiling{};
    write_pdf(folder / "moulds.pdf", sheets, options);
  }
  if (keys.has(DrawingFormat::dxf)) write_dxf(folder / "moulds.dxf", mould_overlay(stack));
  if (!keys.has(DrawingFormat::svg)) return;
  write_svg(folder / "moulds.svg", overlay_sheet(stack, title));
  std::filesystem::create_directories(folder / "moulds");
  for (std::size_t i = 0; i < sheets.size(); ++i)
    write_svg(folder / "moulds" / fmt::format("{:03}.svg", i + 1), sheets[i]);
}

}  // namespace

MouldBody mould_body(const CaseFile& file, const geometry::Boundary<3>& boundary) {
  const double millimetres = file.keys.drawings.value_or(DrawingKeys{}).millimetres;
  MouldBody body{boundary, std::nullopt, std::nullopt};
  if (file.propeller) take_blade(*file.propeller, millimetres, body);
  if (millimetres != 1.0)
    body.boundary = transform(body.boundary, geometry::scaling<3>(geometry::Vector3::Constant(millimetres)));
  return body;
}

std::vector<std::string> write_moulds(const std::filesystem::path& folder, const CaseFile& file,
                                      const geometry::Boundary<3>& boundary, int threads) {
  const DrawingKeys drawings = file.keys.drawings.value_or(DrawingKeys{});
  const MouldStack stack = cut_moulds(mould_body(file, boundary), *file.keys.moulds, drawings.millimetres, threads);
  write_files(folder, stack, file.title(), drawings);
  std::vector<std::string> messages;
  if (stack.board_thickness)
    messages.push_back(fmt::format("moulds: {} boards of {} mm, z = {} to {} mm", stack.boards(),
                                   *stack.board_thickness, stack.sections.front().height,
                                   stack.sections.back().height));
  for (const MouldSection& section : stack.sections)
    if (!section.remark.empty()) messages.push_back("moulds: " + section.remark);
  return messages;
}

}  // namespace isorim::io
