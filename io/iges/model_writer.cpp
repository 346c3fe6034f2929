#include "io/iges/model_writer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/lifted_curve.h"
#include "geometry/trimming/loop_pieces.h"
#include "io/iges/nurbs_records.h"
#include "io/iges/t_splines.h"

namespace isorim::io::iges {

using geometry::NurbsCurve;
using geometry::PlanePiece;
using geometry::Point2;
using geometry::TrimLoop;

namespace {

constexpr int dependent = 1;
constexpr int logically_dependent = 2;
constexpr int in_parameter_space = 5;

struct LoopRegion {
  int loop = 0;
  std::vector<PlanePiece> pieces;
  double doubled_area = 0.0;
  double size = 0.0;
};

LoopRegion region_of(const std::vector<TrimLoop>& loops, std::size_t i) {
  LoopRegion region{static_cast<int>(i), loop_pieces(loops[i]), 0.0, 0.0};
  for (const PlanePiece& piece : region.pieces) {
    region.size = std::max({region.size, piece.lower.cwiseAbs().maxCoeff(), piece.upper.cwiseAbs().maxCoeff()});
  }
  constexpr double rounding = 1e-15;
  region.doubled_area = doubled_signed_area(region.pieces, rounding * region.size * region.size).value;
  return region;
}

/// Whether the inner loop lies in the outer one, which it may touch but not cross: judged where it does not touch.
bool lies_within(const LoopRegion& inner, const LoopRegion& outer) {
  constexpr double relative_resolution = 1e-12;
  for (const PlanePiece& piece : inner.pieces) {
    for (const double s : {0.5, 0.25, 0.8125, 0.0}) {
      const auto winding = winding_number(outer.pieces, evaluate(piece, s), relative_resolution * outer.size);
      if (winding) return *winding != 0;
    }
  }
  return false;
}

}  // namespace

std::vector<FaceLoops> connected_faces(const std::vector<TrimLoop>& loops) {
  if (loops.size() == 1) return {FaceLoops{}};
  std::vector<LoopRegion> regions;
  for (std::size_t i = 0; i < loops.size(); ++i) regions.push_back(region_of(loops, i));
  std::vector<FaceLoops> faces;
  for (const LoopRegion& region : regions) {
    if (region.doubled_area > 0.0) faces.push_back({region.loop, {}});
  }
  for (const LoopRegion& hole : regions) {
    if (hole.doubled_area > 0.0) continue;
    FaceLoops* owner = nullptr;
    double smallest = std::numeric_limits<double>::infinity();
    for (FaceLoops& face : faces) {
      const LoopRegion& outer = regions[static_cast<std::size_t>(face.outer)];
      if (outer.doubled_area >= smallest || (faces.size() > 1 && !lies_within(hole, outer))) continue;
      smallest = outer.doubled_area;
      owner = &face;
    }
    if (owner == nullptr) {
      throw GeometryError(fmt::format("loop {} runs clockwise, but no counter-clockwise loop holds it", hole.loop + 1));
    }
    owner->holes.push_back(hole.loop);
  }
  return faces;
}

ModelWriter::ModelWriter(const geometry::Boundary<3>& boundary, const WriterOptions& options, double tolerance)
    : boundary_(boundary), options_(options), tolerance_(tolerance) {
  for (const auto& patch : boundary.patches) {
    const bool extracted = std::holds_alternative<geometry::ExtractedSurface>(patch.shape);
    loops_.push_back(extracted ? std::vector<TrimLoop>() : trim_loops(patch.shape));
  }
}

int ModelWriter::add_curve(const NurbsCurve<3>& curve) {
  return entities_.add(126, curve_record(curve), {.subordinate = dependent});
}

int ModelWriter::add_pcurve(const NurbsCurve<2>& pcurve) {
  return entities_.add(126, curve_record(pcurve), {.subordinate = dependent, .use = in_parameter_space});
}

NurbsCurve<3> ModelWriter::lifted(int patch, const NurbsCurve<2>& pcurve) const {
  return lift(surface_of(this->patch(patch).shape), pcurve, tolerance_);
}

bool ModelWriter::is_point(const NurbsCurve<3>& curve) const {
  const geometry::Points<3> points = curve.control_points();
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm() <= tolerance_;
}

int ModelWriter::add_name(const std::string& name) {
  return entities_.add(406, EntityList::parameters(406).integer(1).text(name), {.form = 15, .subordinate = dependent});
}

DirectoryFields ModelWriter::look_of(int patch) {
  DirectoryFields fields;
  if (options_.looks.empty()) return fields;
  const Look& look = options_.looks[static_cast<std::size_t>(patch)];
  fields.level = look.level;
  if (!look.colour) return fields;
  const auto [at, is_new] = colours_.try_emplace(*look.colour, 0);
  if (is_new) {
    Record record = EntityList::parameters(314);
    for (const double part : *look.colour) record.real(100.0 * part);
    at->second = entities_.add(314, record, {.use = 2});
  }
  fields.colour = -at->second;
  return fields;
}

int ModelWriter::add_named(int type, Record record, const DirectoryFields& fields, int patch) {
  const std::string& name = this->patch(patch).name;
  DirectoryFields all = look_of(patch);
  all.form = fields.form;
  all.subordinate = fields.subordinate;
  // No associativities, one property.
  if (!name.empty()) record.integer(0).integer(1).integer(add_name(name));
  return entities_.add(type, record, all);
}

int ModelWriter::add_surface(int patch, bool is_independent) {
  const auto& surface = surface_of(this->patch(patch).shape);
  if (is_independent) return add_named(128, surface_record(surface), {}, patch);
  return entities_.add(128, surface_record(surface), {.subordinate = dependent});
}

int ModelWriter::add_composite(const std::vector<int>& curves, int use) {
  if (curves.size() == 1) return curves.front();
  Record record = EntityList::parameters(102);
  record.integer(static_cast<long>(curves.size()));
  for (const int curve : curves) record.integer(curve);
  return entities_.add(102, record, {.subordinate = dependent, .use = use});
}

int ModelWriter::add_boundary(int patch, int surface, const TrimLoop& loop) {
  std::vector<int> pcurves;
  std::vector<int> curves;
  for (const NurbsCurve<2>& pcurve : loop.curves) {
    pcurves.push_back(add_pcurve(pcurve));
    // Degenerate stretches have no curve in space.
    const NurbsCurve<3> curve = lifted(patch, pcurve);
    if (!is_point(curve)) curves.push_back(add_curve(curve));
  }
  const int in_parameters = add_composite(pcurves, in_parameter_space);
  const int in_space = curves.empty() ? 0 : add_composite(curves, 0);
  // The last value prefers the parameter curves.
  Record record = EntityList::parameters(142);
  record.integer(0).integer(surface).integer(in_parameters).integer(in_space).integer(1);
  return entities_.add(142, record, {.subordinate = dependent});
}

namespace {

bool same(const NurbsCurve<2>& a, const NurbsCurve<2>& b) {
  return a.knots() == b.knots() && a.homogeneous() == b.homogeneous();
}

/// The loop is the domain's rectangle, to the last bit.
bool is_natural(const TrimLoop& loop, const geometry::NurbsSurface<3>& surface) {
  const TrimLoop rectangle = domain_loop(surface);
  return std::equal(loop.curves.begin(), loop.curves.end(), rectangle.curves.begin(), rectangle.curves.end(), same);
}

}  // namespace

int ModelWriter::add_t_spline(int patch, const geometry::ExtractedSurface& surface) {
  const auto count = static_cast<int>(surface.elements().size());
  DirectoryFields fields = look_of(patch);
  fields.subordinate = logically_dependent;
  Record group = EntityList::parameters(402);
  group.integer(count);
  for (int e = 0; e < count; ++e) group.integer(entities_.add(128, surface_record(bezier_surface(surface, e)), fields));
  const int property = entities_.add(406, t_spline_property(surface), {.form = 27, .subordinate = dependent});
  // No associativities, and the properties.
  const std::string& name = this->patch(patch).name;
  group.integer(0).integer(name.empty() ? 1 : 2);
  if (!name.empty()) group.integer(add_name(name));
  group.integer(property);
  fields.subordinate = 0;
  fields.form = 15;
  entities_.add(402, group, fields);
  return count;
}

int ModelWriter::add_loose_faces(int patch) {
  if (const auto* surface = std::get_if<geometry::ExtractedSurface>(&this->patch(patch).shape))
    return add_t_spline(patch, *surface);
  const auto* face = std::get_if<geometry::TrimmedSurface>(&this->patch(patch).shape);
  if (face == nullptr) {
    add_surface(patch, true);
    return 1;
  }
  const std::vector<FaceLoops> pieces = connected_faces(face->loops());
  const int surface = add_surface(patch, false);
  for (const FaceLoops& piece : pieces) {
    const TrimLoop& outer = face->loops()[static_cast<std::size_t>(piece.outer)];
    const bool natural = is_natural(outer, face->surface());
    const int outer_boundary = natural ? 0 : add_boundary(patch, surface, outer);
    Record record = EntityList::parameters(144);
    record.integer(surface).integer(natural ? 0 : 1).integer(static_cast<long>(piece.holes.size()));
    record.integer(outer_boundary);
    for (const int hole : piece.holes) {
      record.integer(add_boundary(patch, surface, face->loops()[static_cast<std::size_t>(hole)]));
    }
    add_named(144, record, {}, patch);
  }
  return static_cast<int>(pieces.size());
}

}  // namespace isorim::io::iges
