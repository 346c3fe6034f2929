#include "geometry/propeller/curved_hub.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "geometry/intersection/angle_gap.h"
#include "geometry/intersection/chebyshev_fit.h"
#include "geometry/intersection/tool_caps.h"
#include "geometry/propeller/blade_foot.h"
#include "geometry/propeller/generatrix.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"

namespace isorim::geometry {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
/// To which curves on the hub are met, relative to the parameters' range.
constexpr double fit_accuracy = 2e-14;

const Axis shaft{Point3::Zero(), Vector3::UnitX()};

/// A face of the blade cut off at its foot.
struct CutFace {
  Patch<3> patch;
  NurbsSurface<3> surface;
  std::vector<BladeFoot::Piece> foot;
  /// Of the foot, over X.
  Interval extent;
};

/// What lies outward of the foot: on its left, as u rises.
std::vector<TrimLoop> loops_outward(const NurbsSurface<3>& surface, const std::vector<BladeFoot::Piece>& foot) {
  const Interval u = surface.knots_u().domain();
  const double outer = surface.knots_v().domain().last;
  TrimLoop loop;
  for (const BladeFoot::Piece& piece : foot) loop.curves.push_back(piece.curve);
  const Point2 first = evaluate(foot.front().curve, 0.0);
  const Point2 last = evaluate(foot.back().curve, 1.0);
  loop.curves.push_back(line_segment<2>(last, {u.last, outer}));
  loop.curves.push_back(line_segment<2>({u.last, outer}, {u.first, outer}));
  loop.curves.push_back(line_segment<2>({u.first, outer}, first));
  return {loop};
}

/// u of the trailing edge's face runs outward as it is made.
CutFace cut_at_foot(const Patch<3>& patch, const Generatrix& hub) {
  const bool is_swapped = patch.name == "trailing_edge";
  NurbsSurface<3> surface = is_swapped ? swap_directions(surface_of(patch.shape)) : surface_of(patch.shape);
  const BladeFoot line(surface, hub);
  const Interval extent = line.extent();
  std::vector<BladeFoot::Piece> foot = line.pieces();
  TrimmedSurface trimmed(surface, loops_outward(surface, foot));
  return {{patch.name, std::move(trimmed), is_swapped ? -patch.orientation : patch.orientation},
          std::move(surface),
          std::move(foot),
          extent};
}

/// Y, Z turned by an angle about the shaft: the first component along Z, the second at right angles, in the direction
/// in which turned() turns.
Vector2 around_shaft(const Point3& point, double angle) {
  const CosineSine turn = cosine_sine(angle);
  return {turn.cosine * point.z() + turn.sine * point.y(), turn.sine * point.z() - turn.cosine * point.y()};
}

/// The angle about the shaft in the middle, nearly, of the widest gap between the feet of all blades.
double seam_between(const std::vector<CutFace>& faces, int count) {
  std::vector<double> angles;
  for (const CutFace& face : faces)
    for (const BladeFoot::Piece& piece : face.foot)
      for (int k = 0; k < 8; ++k) {
        const Vector2 place = around_shaft(evaluate(face.surface, evaluate(piece.curve, k / 8.0)), 0.0);
        angles.push_back(std::atan2(place.y(), place.x()));
      }
  return angle_in_widest_gap(std::move(angles), two_pi / count);
}

/// Brings pieces of feet to the parameters of the hub's legs.
class FootImages {
 public:
  FootImages(const Generatrix& hub, double seam) : hub_(hub), seam_(seam), curves_(hub.legs().size()) {}

  /// Of the blade turned by an angle; with the hub, whose natural normals point outward where it carries blades, on the
  /// left of the images.
  void append(const CutFace& face, double angle) {
    for (const BladeFoot::Piece& piece : face.foot) append(face, piece, angle - seam_);
  }
  const std::vector<NurbsCurve<2>>& on_leg(std::size_t leg) const { return curves_[leg]; }

 private:
  void append(const CutFace& face, const BladeFoot::Piece& piece, double angle) {
    const auto point = [&](double s) { return evaluate(face.surface, evaluate(piece.curve, s)); };
    const double size = point(0.5).norm();
    std::vector<double> cuts{0.0, 1.0};
    for (const int axis : {0, 1}) {
      const auto component = [&](double s) { return around_shaft(point(s), angle)(axis) / size; };
      const SignChart chart = sign_chart(component, 1e-14);
      cuts.insert(cuts.end(), chart.roots.begin(), chart.roots.end());
    }
    std::ranges::sort(cuts);
    const auto near = [](double a, double b) { return b - a < 1e-10; };
    cuts.erase(std::unique(cuts.begin(), cuts.end(), near), cuts.end());
    cuts.back() = 1.0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) append(face, piece, angle, {cuts[i], cuts[i + 1]});
  }

  /// A part within a quarter of a turn.
  void append(const CutFace& face, const BladeFoot::Piece& piece, double angle, Interval part) {
    const auto point = [&](double s) { return evaluate(face.surface, evaluate(piece.curve, s)); };
    const Vector2 middle = around_shaft(point(part.middle()), angle);
    const int quarter = (middle.x() > 0.0 ? (middle.y() > 0.0 ? 0 : 3) : (middle.y() > 0.0 ? 1 : 2));
    const double from_quarter = angle - 0.25 * two_pi * quarter;
    const auto image = [&](double s) {
      const Point3 place = point(std::lerp(part.first, part.last, s));
      const Vector2 round = around_shaft(place, from_quarter);
      return Point2(0.25 * (quarter + part_of_quarter(std::atan2(round.y(), round.x()))),
                    hub_.parameter(piece.hub_piece, place.x()));
    };
    const auto leg = static_cast<std::size_t>(hub_.pieces()[static_cast<std::size_t>(piece.hub_piece)].leg);
    for (const NurbsCurve<2>& curve : fit_curve(image, fit_accuracy))
      curves_[leg].push_back(face.patch.orientation > 0 ? reverse(curve) : curve);
  }

  const Generatrix& hub_;
  double seam_;
  std::vector<std::vector<NurbsCurve<2>>> curves_;
};

/// Parameters per length on a leg over [0, 1].
Vector2 scale_of(const NurbsCurve<2>& leg) {
  const Points<2> points = leg.control_points();
  const double length =
      (points.rightCols(points.cols() - 1) - points.leftCols(points.cols() - 1)).colwise().norm().sum();
  return {1.0 / (two_pi * points.row(1).maxCoeff()), 1.0 / length};
}

std::vector<Patch<3>> plane_ends(const std::vector<NurbsCurve<2>>& legs, const std::vector<NurbsSurface<3>>& surfaces) {
  std::vector<Patch<3>> ends;
  const auto append = [&](const char* name, const Point2& rim, const NurbsCurve<3>& edge) {
    if (rim.y() > 1e-12 * rim.norm()) ends.push_back({name, fan<3>(edge, Point3(rim.x(), 0.0, 0.0))});
  };
  append("hub_aft", evaluate(legs.front(), 0.0), boundary_curves(surfaces.front())[0]);
  append("hub_forward", evaluate(legs.back(), 1.0), boundary_curves(surfaces.back())[2]);
  return ends;
}

/// The hub's patches, with and without the places where the blades stand.
void append_hub(const std::vector<NurbsCurve<2>>& legs, const FootImages& images, double seam, HubJoint& joint) {
  double size = 0.0;
  for (const NurbsCurve<2>& leg : legs) size = std::max(size, 2.0 * leg.control_points().cwiseAbs().maxCoeff());
  std::vector<NurbsSurface<3>> surfaces;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    surfaces.push_back(transform(turned(legs[i]), rotation(shaft, seam)));
    const std::string name = fmt::format("hub_{}", i + 1);
    joint.hub.patches.push_back({name, surfaces.back()});
    std::vector<TrimLoop> loops;
    if (!images.on_leg(i).empty()) loops = loops_on_side(surfaces.back(), images.on_leg(i), scale_of(legs[i]), size);
    SurfaceShape shape = surfaces.back();
    if (!loops.empty()) shape = TrimmedSurface(surfaces.back(), std::move(loops));
    joint.hub_beside_blades.push_back({name, std::move(shape)});
  }
  for (Patch<3>& end : plane_ends(legs, surfaces)) {
    joint.hub_beside_blades.push_back(end);
    joint.hub.patches.push_back(std::move(end));
  }
}

}  // namespace

NurbsSurface<3> turned(const NurbsCurve<2>& profile) {
  const HomogeneousPoints<2>& plane = profile.homogeneous();
  HomogeneousPoints<3> net = HomogeneousPoints<3>::Zero(4, plane.cols());
  net.row(0) = plane.row(0);
  net.row(2) = plane.row(1);
  net.row(3) = plane.row(2);
  return revolve(NurbsCurve<3>(profile.knots(), net), shaft, two_pi);
}

HubJoint joined_to_profile(const Boundary<3>& blade, int count, const std::vector<NurbsCurve<2>>& profile) {
  std::vector<NurbsCurve<2>> legs;
  for (const NurbsCurve<2>& leg : profile) legs.push_back(reparametrise(clamp(leg), {0.0, 1.0}));
  const Generatrix hub(legs);
  HubJoint joint;
  std::vector<CutFace> faces;
  for (const Patch<3>& patch : blade.patches) {
    if (patch.name == "root") continue;
    const bool is_cut = patch.name == "blade" || patch.name == "trailing_edge";
    if (is_cut) faces.push_back(cut_at_foot(patch, hub));
    joint.blade.patches.push_back(is_cut ? faces.back().patch : patch);
  }
  const double seam = seam_between(faces, count);
  FootImages images(hub, seam);
  for (int k = 0; k < count; ++k)
    for (const CutFace& face : faces) images.append(face, two_pi * k / count);
  append_hub(legs, images, seam, joint);
  Interval& feet = joint.feet.extent;
  feet = faces.front().extent;
  for (const CutFace& face : faces)
    feet = {std::min(feet.first, face.extent.first), std::max(feet.last, face.extent.last)};
  joint.feet.largest_radius = hub.largest_radius(feet);
  return joint;
}

}  // namespace isorim::geometry
