#include "geometry/intersection/plane_image.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/intersection/chebyshev_fit.h"

namespace isorim::geometry {
namespace {

/// To which curves are met, relative to the size of the solid: the rounding of evaluation.
constexpr double fit_accuracy = 4e-15;

/// If the curve is a line of constant u or v: the isoparametric curve, exactly.
std::optional<NurbsCurve<3>> isoparametric(const NurbsSurface<3>& surface, const NurbsCurve<2>& curve) {
  if (curve.degree() != 1 || curve.knots().basis_count() != 2 || !curve.is_polynomial()) return std::nullopt;
  const Points<2> ends = curve.control_points();
  for (const Eigen::Index constant : {0, 1}) {
    const Eigen::Index running = 1 - constant;
    if (ends(constant, 0) != ends(constant, 1)) continue;
    const Direction direction = running == 0 ? Direction::u : Direction::v;
    const bool forward = ends(running, 0) < ends(running, 1);
    const Interval whole = surface.knots(direction).domain();
    const Interval part{std::max(whole.first, ends.row(running).minCoeff()),
                        std::min(whole.last, ends.row(running).maxCoeff())};
    if (!(part.length() > 0.0)) return std::nullopt;
    const NurbsCurve<3> line = restrict_to(isoparametric_curve(surface, direction, ends(constant, 0)), part);
    return forward ? line : reverse(line);
  }
  return std::nullopt;
}

NurbsCurve<2> project(const NurbsCurve<3>& curve, const PlaneFrame& frame) {
  const HomogeneousPoints<3>& net = curve.homogeneous();
  HomogeneousPoints<2> flat(3, net.cols());
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const Vector3 d = net.col(i).head<3>() - net(3, i) * frame.origin;
    flat.col(i) << d.dot(frame.axis_x), d.dot(frame.axis_y), net(3, i);
  }
  return {curve.knots(), flat};
}

}  // namespace

std::vector<NurbsCurve<2>> plane_image(const NurbsSurface<3>& surface, const NurbsCurve<2>& curve,
                                       const PlaneFrame& frame, double size) {
  if (const std::optional<NurbsCurve<3>> exact = isoparametric(surface, curve)) return {project(*exact, frame)};
  return fit_curve([&](double s) { return frame.to_plane(evaluate(surface, evaluate(curve, s))); },
                   fit_accuracy * size);
}

}  // namespace isorim::geometry
