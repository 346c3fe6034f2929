#pragma once

#include <string>
#include <vector>

#include "io/drawing/drawing.h"
#include "io/moulds/mould_stack.h"

/// The drawings of a mould's boards.
namespace isorim::io {

/// The rectangle in which every section is drawn, so that boards cut to it lie right when they are stacked: that round
/// all sections, with a tenth more on each side (Garcia 1999, section 7.4), at least 5 mm.
drawing::Rectangle mould_rectangle(const MouldStack& stack);

/// All sections over each other, each on the layers CORTE..., CORTE..._hub and CORTE..._parting (so that the name and
/// an asterisk stand for all of it), the rectangle on "base". The sections of one stack in one DXF file, as Garcia's
/// program left them, or in one picture.
drawing::Drawing mould_overlay(const MouldStack& stack);

/// One sheet a board, or a section where there are no boards: the rectangle, the section at the lower face (full), that
/// at the upper face (dashed, on layers of its own height), the hub's rectangle and the line along which to part the
/// board, and texts below.
std::vector<drawing::Sheet> mould_sheets(const MouldStack& stack, const std::string& title);

/// A line for each board or section: number, heights, area of the opening at the lower and the upper face, half width
/// of the hub, ends of the parting line.
std::string mould_table(const MouldStack& stack);

}  // namespace isorim::io
