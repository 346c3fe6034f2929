#include "geometry/intersection/clip.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/intersection/clipped_face.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/intersection/rounding_length.h"
#include "geometry/intersection/tool_caps.h"
#include "geometry/trimming/face_locator.h"

namespace isorim::geometry {
namespace {

BoundingBox<3> box_of(const Boundary<3>& solid) {
  BoundingBox<3> box{Point3::Constant(std::numeric_limits<double>::infinity()),
                     Point3::Constant(-std::numeric_limits<double>::infinity())};
  for (const Patch<3>& patch : solid.patches) {
    const Points<3> points = surface_of(patch.shape).control_points();
    box.lower = box.lower.cwiseMin(points.rowwise().minCoeff());
    box.upper = box.upper.cwiseMax(points.rowwise().maxCoeff());
  }
  return box;
}

ImplicitSurface turned(const ImplicitSurface& inside, KeptSide keep) {
  return keep == KeptSide::inside ? inside : complement(inside);
}

/// A curve in the parameters is a point in space (along a pole).
bool is_point_in_space(const CapEdge& edge, double size) {
  const Point3 start = evaluate(edge.surface, evaluate(edge.curve, 0.0));
  for (const double t : {0.25, 0.5, 0.75, 1.0})
    if ((evaluate(edge.surface, evaluate(edge.curve, t)) - start).norm() > 1e-9 * size) return false;
  return true;
}

Point3 point_on(const CapEdge& edge, double t) {
  return evaluate(edge.surface, evaluate(edge.curve, t));
}

/// The two edges run along each other in opposite directions.
bool cancel(const CapEdge& a, const CapEdge& b, double distance) {
  const Point3 start = point_on(a, 0.0);
  const Point3 middle = point_on(a, 0.5);
  if ((start - point_on(b, 1.0)).norm() > distance || (point_on(a, 1.0) - point_on(b, 0.0)).norm() > distance)
    return false;
  // They may be parametrised differently.
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 1; k < 64; ++k) nearest = std::min(nearest, (middle - point_on(b, k / 64.0)).norm());
  return nearest <= 0.05 * (middle - start).norm();
}

/// Of a face on the tool: the solid lies on the kept side of it.
bool bounds_kept_side(const Patch<3>& patch, const ImplicitSurface& implicit) {
  const NurbsSurface<3>& surface = surface_of(patch.shape);
  const Point2 inside(surface.knots_u().domain().middle(), surface.knots_v().domain().middle());
  const SurfaceJet<3> jet = evaluate_jet(surface, inside);
  return patch.orientation * jet.du.cross(jet.dv).dot(gradient(implicit, jet.point)) > 0.0;
}

/// What is left of a solid, before it is closed.
struct OpenPart {
  Boundary<3> boundary;
  std::vector<CapEdge> edges;
  /// Some face lost more than what lies on the tool.
  bool is_reduced = false;
};

class Clipper {
 public:
  Clipper(const Boundary<3>& solid, const ClipOptions& options)
      : solid_(solid), options_(options), box_(box_of(solid)), size_(rounding_length(box_.lower, box_.upper)) {
    options_.gap_tolerance *= box_.diagonal() / size_;
  }

  /// That tolerances are relative to, and the options with the one of gaps brought to it.
  double size() const { return size_; }
  const ClipOptions& options() const { return options_; }
  Point3 middle() const { return box_.middle(); }

  OpenPart cut(const ImplicitSurface& implicit) const {
    OpenPart part;
    for (const Patch<3>& patch : solid_.patches) {
      try {
        append(patch, implicit, part);
      } catch (GeometryError& error) {
        error.add_context(fmt::format("cutting patch \"{}\"", patch.name));
        throw;
      }
    }
    remove_cancelling(part.edges);
    return part;
  }

 private:
  void append(const Patch<3>& patch, const ImplicitSurface& implicit, OpenPart& part) const {
    ClippedFace face = clip_face(patch.shape, implicit, {.tolerance = options_.tolerance, .size = size()});
    const bool is_own_cap = face.lies_on_tool && !face.shape && bounds_kept_side(patch, implicit);
    if (face.is_reduced && !is_own_cap) part.is_reduced = true;
    for (NurbsCurve<2>& cut : face.cuts) {
      // Seen against the outward normal the face lies on the left of its edge, so the cap on that of the reverse.
      CapEdge edge{surface_of(patch.shape), patch.orientation > 0 ? reverse(cut) : std::move(cut)};
      if (!is_point_in_space(edge, size())) part.edges.push_back(std::move(edge));
    }
    if (face.shape) part.boundary.patches.push_back({patch.name, std::move(*face.shape), patch.orientation});
  }

  /// Edges of two kept faces that both end at the tool bound nothing.
  void remove_cancelling(std::vector<CapEdge>& edges) const {
    const double distance = options_.gap_tolerance * size();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const auto partner = std::find_if(edges.begin() + static_cast<std::ptrdiff_t>(i) + 1, edges.end(),
                                        [&](const CapEdge& other) { return cancel(edges[i], other, distance); });
      if (partner == edges.end()) continue;
      edges.erase(partner);
      edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(i));
      --i;
    }
  }

  const Boundary<3>& solid_;
  ClipOptions options_;
  BoundingBox<3> box_;
  double size_;
};

/// The first of "cap", "cap_2", ... that is not taken.
std::string free_name(const std::set<std::string>& taken) {
  std::string name = "cap";
  for (int k = 2; taken.count(name) > 0; ++k) name = fmt::format("cap_{}", k);
  return name;
}

void append_caps(Boundary<3>& boundary, std::vector<Patch<3>> caps) {
  std::set<std::string> names;
  for (const Patch<3>& patch : boundary.patches) names.insert(patch.name);
  for (Patch<3>& cap : caps) {
    cap.name = free_name(names);
    names.insert(cap.name);
    boundary.patches.push_back(std::move(cap));
  }
}

/// Makes the caps of one tool.
struct CapMaker {
  const Boundary<3>& solid;
  const Clipper& clipper;
  const std::vector<CapEdge>& edges;
  const ClipOptions& options;

  std::vector<Patch<3>> operator()(const PlaneTool& tool) const {
    const PlaneFrame frame = cap_frame(tool, clipper.middle());
    return plane_caps(frame, plane_loops(frame, edges, clipper.size(), clipper.options()));
  }
  std::vector<Patch<3>> operator()(const SphereTool& tool) const {
    return sphere_caps(tool, edges, clipper.size(), clipper.options(),
                       [this](const Point3& point) { return contains(point); });
  }
  std::vector<Patch<3>> operator()(const CylinderTool& tool) const {
    return cylinder_caps(tool, edges, clipper.size(), clipper.options());
  }
  std::vector<Patch<3>> operator()(const ConeTool& tool) const {
    return cone_caps(tool, edges, clipper.size(), clipper.options());
  }

 private:
  /// The point lies in the region in which a plane through it cuts the solid.
  bool contains(const Point3& point) const {
    const SectionOptions section_options{options.tolerance, options.gap_tolerance};
    const PlaneSection cut = plane_section(solid, plane_frame(point, Vector3(0.4387, 0.2913, 0.8501)), section_options);
    if (cut.loops.empty()) return false;
    std::vector<TrimLoop> loops;
    for (const SectionLoop& loop : cut.loops) loops.push_back(loop.curve.plane_curves);
    return FaceLocator(loops).winding_number(cut.frame.to_plane(point)).value_or(0) != 0;
  }
};

/// Every patch with a surface of its own: the elements of extracted surfaces one by one.
Boundary<3> with_single_surfaces(const Boundary<3>& solid) {
  Boundary<3> result;
  for (const Patch<3>& patch : solid.patches) {
    const auto* extracted = std::get_if<ExtractedSurface>(&patch.shape);
    if (!extracted) {
      result.patches.push_back(patch);
      continue;
    }
    for (int e = 0; e < static_cast<int>(extracted->elements().size()); ++e)
      result.patches.push_back(
          {fmt::format("{}[{}]", patch.name, e), bezier_surface(*extracted, e), patch.orientation});
  }
  return result;
}

/// Empty if nothing is cut off.
std::optional<Boundary<3>> clip_once(const Boundary<3>& solid, const ClipTool& tool, const ClipOptions& options) {
  const Clipper clipper(solid, options);
  OpenPart part = clipper.cut(implicit_surface(tool));
  const auto* ball = std::get_if<SphereTool>(&tool);
  if (!part.is_reduced && !ball) return std::nullopt;
  const std::vector<Patch<3>> caps = std::visit(CapMaker{solid, clipper, part.edges, options}, tool);
  if (!part.is_reduced && caps.empty()) return std::nullopt;
  append_caps(part.boundary, caps);
  if (part.boundary.patches.empty()) throw GeometryError("clip: nothing is left of the solid");
  return std::move(part.boundary);
}

}  // namespace

ImplicitSurface implicit_surface(const ClipTool& tool) {
  struct Maker {
    ImplicitSurface operator()(const PlaneTool& t) const { return implicit_plane(t.point, t.normal); }
    ImplicitSurface operator()(const SphereTool& t) const {
      return turned(implicit_sphere(t.centre, t.radius), t.keep);
    }
    ImplicitSurface operator()(const CylinderTool& t) const {
      return turned(implicit_cylinder(t.point, t.axis, t.radius), t.keep);
    }
    ImplicitSurface operator()(const ConeTool& t) const {
      return turned(implicit_cone(t.apex, t.axis, t.half_angle), t.keep);
    }
  };
  return std::visit(Maker{}, tool);
}

Boundary<3> clip(const Boundary<3>& solid, const ClipTool& tool, const ClipOptions& options) {
  const Boundary<3> faces = with_single_surfaces(solid);
  const auto* cone = std::get_if<ConeTool>(&tool);
  if (!cone || cone->keep == KeptSide::outside) return clip_once(faces, tool, options).value_or(solid);
  // What lies within the other nappe goes first.
  const std::optional<Boundary<3>> half = clip_once(faces, PlaneTool{cone->apex, -cone->axis}, options);
  const std::optional<Boundary<3>> rest = clip_once(half.value_or(faces), tool, options);
  return rest ? *rest : half.value_or(solid);
}

}  // namespace isorim::geometry
