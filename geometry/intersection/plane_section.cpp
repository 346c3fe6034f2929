#include "geometry/intersection/plane_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/intersection/plane_image.h"
#include "geometry/intersection/rounding_length.h"
#include "geometry/intersection/section_chains.h"
#include "geometry/intersection/section_faces.h"
#include "geometry/shapes/checks.h"
#include "geometry/trimming/face_locator.h"
#include "geometry/trimming/lifted_curve.h"

namespace isorim::geometry {
namespace {

/// Relative to the size: ends that count as the same without more ado.
constexpr double finest_gap = 1e-12;
/// How much wider than between patches gaps may be between the curves in which a plane cuts them.
constexpr double gap_growth = 100.0;
/// Points this near to a curve lie on it (double roots are known to the root of rounding), and this near to each other
/// are the same: relative to the root of the size times the diagonal.
constexpr double contact_distance = 2e-6;
/// Relative to the size: loops that are narrower, in the mean, are edges that run back on themselves.
constexpr double least_width = 1e-13;
/// Of the plane where it meets a singular point, relative to the size.
constexpr std::array<double, 5> shifts{0.0, 1e-11, -1e-11, 4e-11, -4e-11};

std::string at(const Point3& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x(), x.y(), x.z());
}

Point2 start_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().first);
}

Point2 end_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().last);
}

NurbsCurve<2> line(const Point2& from, const Point2& to) {
  Points<2> ends(2, 2);
  ends << from, to;
  return NurbsCurve<2>::from_points(KnotVector::bezier(1), ends);
}

/// Each start is moved onto the end before it, or joined with it by a line if it is farther than rounding.
void close_gaps(std::vector<NurbsCurve<2>>& curves, bool is_closed, double rounding) {
  std::vector<NurbsCurve<2>> result;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    NurbsCurve<2> curve = curves[i];
    const bool has_predecessor = i > 0;
    if (has_predecessor) {
      const Point2 end = end_of(result.back());
      if ((end - start_of(curve)).norm() > rounding) {
        result.push_back(line(end, start_of(curve)));
      } else {
        HomogeneousPoints<2> net = curve.homogeneous();
        net.col(0).head<2>() = net(2, 0) * end;
        curve = NurbsCurve<2>(curve.knots(), std::move(net));
      }
    }
    result.push_back(std::move(curve));
  }
  if (is_closed && !result.empty()) {
    const Point2 end = end_of(result.back());
    const Point2 start = start_of(result.front());
    if ((end - start).norm() > rounding) {
      result.push_back(line(end, start));
    } else {
      HomogeneousPoints<2> net = result.back().homogeneous();
      const Eigen::Index last = net.cols() - 1;
      net.col(last).head<2>() = net(2, last) * start;
      result.back() = NurbsCurve<2>(result.back().knots(), std::move(net));
    }
  }
  curves = std::move(result);
}

/// Chains the pieces of one section.
class CurveMaker {
 public:
  CurveMaker(const PlaneFrame& frame, double size, double gap_tolerance)
      : frame_(frame), size_(size), gap_tolerance_(gap_tolerance) {}

  std::vector<SectionCurve> curves(const std::vector<SectionPiece>& pieces) const {
    std::vector<ChainLink> links;
    for (const SectionPiece& piece : pieces) links.push_back(link(piece));
    std::vector<SectionCurve> result;
    for (const LinkChain& chain : join_links(links, finest_gap * size_, gap_growth * gap_tolerance_ * size_)) {
      SectionCurve curve;
      curve.is_closed = chain.is_closed;
      for (const int i : chain.links) curve.pieces.push_back(pieces[static_cast<std::size_t>(i)]);
      measure_gaps(curve);
      for (const SectionPiece& piece : curve.pieces)
        for (NurbsCurve<2>& image : plane_image(*piece.surface, piece.parameters, frame_, size_))
          curve.plane_curves.curves.push_back(std::move(image));
      close_gaps(curve.plane_curves.curves, curve.is_closed, finest_gap * size_);
      result.push_back(std::move(curve));
    }
    return result;
  }

 private:
  ChainLink link(const SectionPiece& piece) const {
    const auto place = [&](double t) { return frame_.to_plane(point_on(piece, t)); };
    ChainLink result;
    result.start = place(0.0);
    result.end = place(1.0);
    result.leaving = place(1e-3) - result.start;
    result.arriving = place(1.0 - 1e-3) - result.end;
    Point2 last = result.start;
    for (const double t : {0.25, 0.5, 0.75, 1.0}) {
      const Point2 next = place(t);
      result.length += (next - last).norm();
      last = next;
    }
    return result;
  }

  static void measure_gaps(SectionCurve& curve) {
    const std::size_t count = curve.pieces.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (i + 1 == count && !curve.is_closed) break;
      const Point3 end = point_on(curve.pieces[i], 1.0);
      const double gap = (point_on(curve.pieces[(i + 1) % count], 0.0) - end).norm();
      if (gap <= curve.largest_gap) continue;
      curve.largest_gap = gap;
      curve.largest_gap_place = end;
    }
  }

  const PlaneFrame& frame_;
  double size_;
  double gap_tolerance_;
};

bool encloses(const FaceLocator& outer, const SectionCurve& inner) {
  for (const NurbsCurve<2>& curve : inner.plane_curves.curves)
    for (const double t : {0.5, 0.21}) {
      const Interval domain = curve.domain();
      const std::optional<int> turns = outer.winding_number(evaluate(curve, domain.first + t * domain.length()), 1e-9);
      if (turns) return *turns != 0;
    }
  return false;
}

/// Finds holes and, for each, the smallest loop around it.
void nest(std::vector<SectionLoop>& loops, std::vector<double>& areas) {
  std::vector<std::optional<FaceLocator>> locators(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) loops[i].is_hole = areas[i] < 0.0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].is_hole) continue;
    for (std::size_t k = 0; k < loops.size(); ++k) {
      if (loops[k].is_hole || areas[k] < -areas[i]) continue;
      if (loops[i].parent >= 0 && areas[k] >= areas[static_cast<std::size_t>(loops[i].parent)]) continue;
      if (!locators[k]) locators[k].emplace(std::span<const TrimLoop>(&loops[k].curve.plane_curves, 1));
      if (encloses(*locators[k], loops[i].curve)) loops[i].parent = static_cast<int>(k);
    }
  }
}

double perimeter_of_polygon(const SectionCurve& curve) {
  double length = 0.0;
  for (const NurbsCurve<2>& piece : curve.plane_curves.curves) {
    const Points<2> points = piece.control_points();
    for (Eigen::Index i = 1; i < points.cols(); ++i) length += (points.col(i) - points.col(i - 1)).norm();
  }
  return length;
}

/// One section in the making.
class SectionMaker {
 public:
  /// Gaps are relative to the size, as other tolerances.
  SectionMaker(const PlaneFrame& frame, double size, double diagonal, const SectionOptions& options)
      : size_(size), contact_distance_(contact_distance * std::sqrt(size * diagonal)), options_(options) {
    section_.frame = frame;
  }

  PlaneSection make(FacesOnPlane found) {
    const double distance = options_.gap_tolerance * size_;
    std::vector<SectionPiece> touching = std::move(found.touching);
    std::vector<SectionPiece> above;
    const std::vector<SectionEdge> edges = cancel_opposite_edges(std::move(found.edges), distance, touching);
    const std::vector<SectionEdge> rest = cancel_opposite_edges(std::move(found.edges_above), distance, above);
    for (SectionPiece& piece : above) add_once(std::move(piece), touching);
    for (const SectionEdge& edge : rest)
      if (!runs_along_any(edge.piece, edges, found.coplanar_edges)) add_once(edge.piece, touching);
    make_curves(edges, touching);
    make_coplanar(found);
    add_points(found);
    measure();
    return std::move(section_);
  }

 private:
  CurveMaker maker() const { return {section_.frame, size_, options_.gap_tolerance}; }

  bool lies_on(const Point3& x, const SectionPiece& piece) const {
    return nearest_on(piece, x).distance <= contact_distance_;
  }

  bool runs_along(const SectionPiece& a, const SectionPiece& b) const {
    return lies_on(point_on(a, 0.5), b) && lies_on(point_on(a, 0.2), b) && lies_on(point_on(a, 0.8), b);
  }

  /// The parts of an edge may run along different others.
  bool runs_along_any(const SectionPiece& piece, const std::vector<SectionEdge>& edges,
                      const std::vector<std::vector<SectionPiece>>& coplanar) const {
    for (const double t : {0.5, 0.17, 0.83}) {
      const Point3 x = point_on(piece, t);
      bool is_on = std::ranges::any_of(edges, [&](const SectionEdge& edge) { return lies_on(x, edge.piece); });
      for (const std::vector<SectionPiece>& loops : coplanar)
        is_on = is_on || std::ranges::any_of(loops, [&](const SectionPiece& edge) { return lies_on(x, edge); });
      if (!is_on) return false;
    }
    return true;
  }

  void add_once(SectionPiece piece, std::vector<SectionPiece>& pieces) const {
    if (std::ranges::none_of(pieces, [&](const SectionPiece& known) { return runs_along(piece, known); }))
      pieces.push_back(std::move(piece));
  }

  void make_curves(const std::vector<SectionEdge>& edges, const std::vector<SectionPiece>& touching) {
    std::vector<SectionPiece> pieces;
    for (const SectionEdge& edge : edges) pieces.push_back(edge.piece);
    std::vector<double> areas;
    for (SectionCurve& curve : maker().curves(pieces)) {
      if (!curve.is_closed) {
        section_.chains.push_back(std::move(curve));
        continue;
      }
      const double area = 0.5 * doubled_area(curve.plane_curves);
      if (std::abs(area) <= least_width * size_ * perimeter_of_polygon(curve)) continue;
      section_.loops.push_back({std::move(curve), false, -1});
      areas.push_back(area);
    }
    nest(section_.loops, areas);
    section_.touching = touching_curves(touching);
  }

  /// Touching curves have no direction: pieces are turned to make chains.
  std::vector<SectionCurve> touching_curves(std::vector<SectionPiece> pieces) const {
    std::vector<SectionPiece> ordered;
    std::vector<bool> used(pieces.size(), false);
    for (std::size_t first = 0; first < pieces.size(); ++first) {
      if (used[first]) continue;
      used[first] = true;
      ordered.push_back(pieces[first]);
      // Forwards from its end, then backwards from its start.
      for (const bool forwards : {true, false}) {
        Point3 place = point_on(pieces[first], forwards ? 1.0 : 0.0);
        while (std::optional<SectionPiece> next = take_next(pieces, used, place, forwards)) {
          place = point_on(*next, forwards ? 1.0 : 0.0);
          ordered.push_back(std::move(*next));
        }
      }
    }
    return maker().curves(ordered);
  }

  std::optional<SectionPiece> take_next(const std::vector<SectionPiece>& pieces, std::vector<bool>& used,
                                        const Point3& place, bool forwards) const {
    const double distance = options_.gap_tolerance * size_;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (used[i]) continue;
      const bool at_start = (point_on(pieces[i], 0.0) - place).norm() <= distance;
      const bool at_end = (point_on(pieces[i], 1.0) - place).norm() <= distance;
      if (!at_start && !at_end) continue;
      used[i] = true;
      return at_start == forwards ? pieces[i] : reversed(pieces[i]);
    }
    return std::nullopt;
  }

  void make_coplanar(FacesOnPlane& found) {
    section_.coplanar = std::move(found.coplanar);
    for (std::size_t i = 0; i < section_.coplanar.size(); ++i)
      section_.coplanar[i].loops = maker().curves(found.coplanar_edges[i]);
  }

  // --- Points -------------------------------------------------------------------------------------------------

  bool is_on_curve(const Point3& x, const SectionCurve& curve) const {
    return std::ranges::any_of(curve.pieces, [&](const SectionPiece& piece) { return lies_on(x, piece); });
  }

  bool is_on_section(const Point3& x) const {
    const auto is_on = [&](const SectionCurve& curve) { return is_on_curve(x, curve); };
    return std::ranges::any_of(section_.loops, [&](const SectionLoop& loop) { return is_on(loop.curve); }) ||
           std::ranges::any_of(section_.chains, is_on) || std::ranges::any_of(section_.touching, is_on) ||
           std::ranges::any_of(section_.coplanar,
                               [&](const CoplanarFace& face) { return std::ranges::any_of(face.loops, is_on); });
  }

  void add_point(const SectionPoint& point, std::vector<SectionPoint>& points) const {
    const auto is_same = [&](const SectionPoint& known) {
      return (known.point - point.point).norm() <= contact_distance_;
    };
    if (std::ranges::none_of(points, is_same)) points.push_back(point);
  }

  void add_points(const FacesOnPlane& found) {
    for (const SectionPoint& point : found.saddles)
      add_point(point, is_on_section(point.point) ? section_.double_points : section_.isolated);
    for (const SectionPoint& point : found.points)
      if (!is_on_section(point.point)) add_point(point, section_.isolated);
  }

  // --- The whole ----------------------------------------------------------------------------------------------

  void measure() {
    const auto add = [&](const SectionCurve& curve) {
      if (curve.largest_gap <= section_.largest_gap) return;
      section_.largest_gap = curve.largest_gap;
      section_.largest_gap_place = curve.largest_gap_place;
    };
    for (const SectionLoop& loop : section_.loops) add(loop.curve);
    for (const SectionCurve& chain : section_.chains) add(chain);
    if (section_.largest_gap > 1e-9 * size_)
      section_.messages.push_back(fmt::format("gaps between patches of up to {:.3g} were bridged, the largest at {}",
                                              section_.largest_gap, at(section_.largest_gap_place)));
    for (const SectionCurve& chain : section_.chains)
      section_.messages.push_back(fmt::format("an open curve runs from {} to {}",
                                              at(point_on(chain.pieces.front(), 0.0)),
                                              at(point_on(chain.pieces.back(), 1.0))));
    for (const SectionLoop& loop : section_.loops)
      if (loop.is_hole && loop.parent < 0)
        section_.messages.push_back(
            fmt::format("the hole at {} lies in no outer loop", at(point_on(loop.curve.pieces.front(), 0.0))));
  }

  double size_;
  double contact_distance_;
  SectionOptions options_;
  PlaneSection section_;
};

/// Whether the boundary touches the plane all along a piece of the curve, but for 1e-5 of a radian: an open curve like
/// that is a part of a loop that is too narrow to be told.
bool grazes(const SectionCurve& curve, const Vector3& plane_normal) {
  constexpr double smallest_sine = 1e-5;
  const auto touches = [&](const SectionPiece& piece, double t) {
    const SurfaceJet<3> jet = evaluate_jet(*piece.surface, evaluate_jet(piece, t).place.uv);
    return jet.du.cross(jet.dv).stableNormalized().cross(plane_normal).norm() <= smallest_sine;
  };
  return std::ranges::any_of(curve.pieces, [&](const SectionPiece& piece) {
    return touches(piece, 0.1) && touches(piece, 0.5) && touches(piece, 0.9);
  });
}

}  // namespace

PlaneFrame plane_frame(const Point3& point, const Vector3& normal) {
  checks::finite("plane", "point", point);
  PlaneFrame frame;
  frame.normal = checks::unit<3>("plane", "normal", normal);
  frame.origin = point.dot(frame.normal) * frame.normal;
  const Vector3 horizontal = Vector3::UnitZ().cross(frame.normal);
  // A normal that rounding has tilted is vertical.
  frame.axis_x = horizontal.norm() > 1e-9 ? horizontal.normalized()
                                          : (Vector3::UnitX() - frame.normal.x() * frame.normal).normalized();
  frame.axis_y = frame.normal.cross(frame.axis_x);
  return frame;
}

SectionPointJet evaluate_jet(const SectionPiece& piece, double t) {
  const LiftedJet jet = lifted_jet(*piece.surface, piece.parameters, t);
  return {{jet.point, piece.patch, piece.element, jet.uv}, jet.tangent};
}

class PlaneCutter::Faces {
 public:
  Faces(const Boundary<3>& boundary, const SectionOptions& options)
      : options_(options), faces_(section_faces(boundary)) {
    if (faces_.empty()) throw GeometryError("the boundary has no patches");
    Point3 lower = faces_.front().lower;
    Point3 upper = faces_.front().upper;
    for (const SectionFace& face : faces_) {
      lower = lower.cwiseMin(face.lower);
      upper = upper.cwiseMax(face.upper);
    }
    for (const Patch<3>& patch : boundary.patches) names_.push_back(patch.name);
    diagonal_ = (upper - lower).norm();
    size_ = rounding_length(lower, upper);
    options_.gap_tolerance *= diagonal_ / size_;
  }

  double diagonal() const { return diagonal_; }

  PlaneSection section(const PlaneFrame& plane) const {
    for (std::size_t k = 0; k + 1 < shifts.size(); ++k) {
      try {
        PlaneSection result = shifted_section(plane, shifts[k]);
        if (std::ranges::none_of(result.chains, [&](const auto& chain) { return grazes(chain, plane.normal); }))
          return result;
      } catch (const GeometryError&) {
        // The next plane may miss what is singular here; the last one says what is wrong.
      }
    }
    return shifted_section(plane, shifts.back());
  }

 private:
  PlaneSection shifted_section(const PlaneFrame& plane, double relative_shift) const {
    PlaneFrame frame = plane;
    const double shift = relative_shift * size_;
    frame.origin += shift * plane.normal;
    const ImplicitSurface implicit = implicit_plane(frame.origin, frame.normal);
    PlaneSection result = SectionMaker(frame, size_, diagonal_, options_)
                              .make(cut_faces(faces_, implicit, frame.normal, size_, options_.tolerance));
    result.shift = shift;
    if (shift != 0.0)
      result.messages.push_back(
          fmt::format("the plane meets the boundary in a singular point; it was moved by {:.2g}", shift));
    for (const CoplanarFace& face : result.coplanar)
      if (face.element < 0)
        result.messages.push_back(
            fmt::format("patch '{}' lies in the plane", names_[static_cast<std::size_t>(face.patch)]));
    return result;
  }

  SectionOptions options_;
  std::vector<SectionFace> faces_;
  std::vector<std::string> names_;
  double diagonal_ = 0.0;
  /// What tolerances are relative to: rounding_length().
  double size_ = 0.0;
};

PlaneCutter::PlaneCutter(const Boundary<3>& boundary, const SectionOptions& options)
    : faces_(std::make_unique<const Faces>(boundary, options)) {}
PlaneCutter::~PlaneCutter() = default;
PlaneCutter::PlaneCutter(PlaneCutter&&) noexcept = default;
PlaneCutter& PlaneCutter::operator=(PlaneCutter&&) noexcept = default;

double PlaneCutter::size() const {
  return faces_->diagonal();
}

PlaneSection PlaneCutter::section(const PlaneFrame& plane) const {
  return faces_->section(plane);
}

PlaneSection plane_section(const Boundary<3>& boundary, const PlaneFrame& plane, const SectionOptions& options) {
  return PlaneCutter(boundary, options).section(plane);
}

Boundary<2> section_region(const PlaneSection& section) {
  if (section.loops.empty()) throw GeometryError("the section has no loops");
  Boundary<2> region;
  for (std::size_t i = 0; i < section.loops.size(); ++i) {
    const std::vector<NurbsCurve<2>>& curves = section.loops[i].curve.plane_curves.curves;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      std::string name = fmt::format("loop_{}", i + 1);
      if (curves.size() > 1) name += fmt::format("_curve_{}", k + 1);
      region.patches.push_back({std::move(name), curves[k], 1});
    }
  }
  return region;
}

}  // namespace isorim::geometry
