#include "geometry/trimming/loose_face.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/trimming/curve_cuts.h"
#include "geometry/trimming/domain_walk.h"
#include "geometry/trimming/loop_chaining.h"
#include "geometry/trimming/loop_sides.h"
#include "geometry/trimming/parameter_rectangle.h"
#include "geometry/trimming/piece_curves.h"

namespace isorim::geometry {
namespace {

InversionOptions inversion_options(const FaceOptions& options, double size) {
  return {size, options.inversion_tolerance * size,
          options.largest_deviation > 0.0 ? options.largest_deviation : 1e-3 * size};
}

std::vector<CoveringLoop> covering_loops(const LooseFace& face, const ParameterRectangle& rectangle,
                                         const InversionOptions& options, FaceRepairs& repairs) {
  PieceCurves pieces(rectangle, options, repairs);
  std::vector<CoveringLoop> loops;
  for (std::size_t i = 0; i < face.loops.size(); ++i) {
    const std::string name = fmt::format("loop {}", i + 1);
    if (face.loops[i].pieces.empty()) throw GeometryError(name + " has no piece");
    std::vector<LoopCurve> curves;
    for (std::size_t k = 0; k < face.loops[i].pieces.size(); ++k)
      for (LoopCurve& curve :
           pieces.curves_of(face.loops[i].pieces[k], static_cast<int>(k) + 1, fmt::format("{}, piece {}", name, k + 1)))
        curves.push_back(std::move(curve));
    if (curves.empty()) {
      // A vertex loop: the apex of a cone, written as a loop of its own.
      repairs.notes.push_back(name + ": it is a point and was left out");
      continue;
    }
    for (CoveringLoop& loop :
         chain_loop(std::move(curves), rectangle, {options.size, options.largest_deviation, name}, repairs))
      loops.push_back(std::move(loop));
  }
  return loops;
}

/// One loop that runs once around the rectangle, along its sides to the last digits.
bool is_whole(const std::vector<ClosedLoop>& loops, const ParameterRectangle& rectangle) {
  if (loops.size() != 1) return false;
  const Vector2 near = 1e-13 * rectangle.lengths();
  for (const LoopCurve& curve : loops.front().curves) {
    const Points<2> points = curve.curve.control_points();
    bool is_along = false;
    for (int side = 0; side < 4; ++side) {
      const SideLine line = side_line(rectangle, side);
      is_along = is_along || ((points.row(line.parameter).array() - line.value).abs() <= near[line.parameter]).all();
    }
    if (!is_along) return false;
  }
  const double whole = 2.0 * rectangle.lengths().prod();
  return std::abs(loops.front().area - whole) <= 1e-12 * whole;
}

AssembledFace assembled(const NurbsSurface<3>& surface, const ParameterRectangle& rectangle,
                        std::vector<ClosedLoop> loops, FaceRepairs repairs) {
  if (is_whole(loops, rectangle)) return {surface, {}, std::move(repairs)};
  std::vector<TrimLoop> trims;
  std::vector<std::vector<int>> edges;
  for (ClosedLoop& loop : loops) {
    trims.emplace_back();
    edges.emplace_back();
    for (LoopCurve& curve : loop.curves) {
      if (curve.is_given && curve.shift != Vector2::Zero()) ++repairs.shifted_curves;
      trims.back().curves.push_back(std::move(curve.curve));
      edges.back().push_back(curve.edge);
    }
  }
  return {TrimmedSurface(surface, std::move(trims)), std::move(edges), std::move(repairs)};
}

}  // namespace

AssembledFace assemble_face(const LooseFace& face, const FaceOptions& options) {
  FaceRepairs repairs;
  if (face.loops.empty()) return {face.surface, {}, std::move(repairs)};
  const ParameterRectangle rectangle(face.surface);
  const InversionOptions inversion = inversion_options(options, face_size(face, rectangle));
  const std::vector<CoveringLoop> covering = covering_loops(face, rectangle, inversion, repairs);
  std::vector<ClosedLoop> loops = closed_loops(covering, face, rectangle, repairs);
  return assembled(face.surface, rectangle, std::move(loops), std::move(repairs));
}

}  // namespace isorim::geometry
