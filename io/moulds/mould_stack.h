#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/propeller/mould_lines.h"
#include "io/case/drawing_keys.h"
#include "solver/plane_sections.h"

/// Sections of a body by planes z = constant, for boards that are stacked to a female mould. All lengths in mm.
namespace isorim::io {

/// What is known of a body that is moulded.
struct MouldBody {
  /// Closed, or open where a blade stands on its hub.
  geometry::Boundary<3> boundary;
  /// Of a propeller: the patch that has the blade's surface.
  std::optional<int> blade;
  /// Of the hub that the blade stands on; of one by its profile the largest where the blade stands.
  std::optional<double> hub_radius;
  /// X of the blade's root; if absent, that of its edges at the hub's radius.
  std::optional<geometry::Interval> root = std::nullopt;
  /// Between lines of the section and the sampled points that they are drawn from.
  double sag = 1e-4;
};

struct HubRectangle {
  geometry::Interval x;
  double half_width = 0.0;
};

/// One plane.
struct MouldSection {
  double height = 0.0;
  solver::MeasuredSection measured;
  /// The plane meets the body in more than points and lines.
  bool has_area = false;
  std::optional<geometry::PartingLine> parting;
  std::optional<HubRectangle> hub;
  /// Why there is nothing to cut, or what a user should know; empty nearly always.
  std::string remark;
};

struct MouldStack {
  /// Rising.
  std::vector<MouldSection> sections;
  /// With a thickness there is a board between each section and the next.
  std::optional<double> board_thickness;
  /// Over z.
  geometry::Interval body_heights;

  /// Their number; 0 without a thickness.
  std::size_t boards() const { return board_thickness && !sections.empty() ? sections.size() - 1 : 0; }
};

/// The least and the greatest z of the body, to 1e-9 of its size: the heights between which planes meet it. The body is
/// in one piece.
geometry::Interval height_range(const geometry::PlaneCutter& cutter, const geometry::Boundary<3>& boundary);

/// The heights of the faces of boards, or of sections without boards. Boards begin at multiples of their thickness and
/// reach from below the lowest point to above the highest, or are those between `from` and `to`, where given.
std::vector<double> mould_heights(const MouldKeys& keys, double millimetres, geometry::Interval body);

/// Cuts the body at the heights. A plane that cannot be cut gets a remark. Throws InputError if there are more than
/// 5000 planes.
MouldStack cut_moulds(const MouldBody& body, const MouldKeys& keys, double millimetres, int threads,
                      const std::function<void(double)>& progress = {});

/// "CORTE40_", "CORTE40_5": the name of the layer of the section at a height (Garcia 1999, section 7.4), with at most
/// four decimals.
std::string section_layer(double height);

}  // namespace isorim::io
