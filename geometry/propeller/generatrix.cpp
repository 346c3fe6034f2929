#include "geometry/propeller/generatrix.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/errors.h"
#include "geometry/propeller/bracketed_root.h"

namespace isorim::geometry {
namespace {

/// Then X rises along the segment: a line X = constant crosses it no more often than its control polygon.
bool rises(const NurbsCurve<2>& segment) {
  const Points<2> points = segment.control_points();
  const Eigen::Index last = points.cols() - 1;
  return points(0, last) > points(0, 0) &&
         (points.row(0).tail(last).array() >= points.row(0).head(last).array()).all() &&
         points.row(1).minCoeff() >= 0.0;
}

/// The rising segments of all legs, stretch by stretch.
std::vector<std::vector<Generatrix::Piece>> rising_stretches(const std::vector<NurbsCurve<2>>& legs) {
  std::vector<std::vector<Generatrix::Piece>> stretches(1);
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const std::vector<double> ends = legs[k].knots().breakpoints();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const Interval parameters{ends[i], ends[i + 1]};
      const NurbsCurve<2> segment = restrict_to(legs[k], parameters);
      if (!rises(segment)) {
        if (!stretches.back().empty()) stretches.emplace_back();
        continue;
      }
      const Points<2> points = segment.control_points();
      stretches.back().push_back({static_cast<int>(k), parameters, {points(0, 0), points(0, points.cols() - 1)}});
    }
  }
  return stretches;
}

double length_of(const std::vector<Generatrix::Piece>& stretch) {
  return stretch.empty() ? 0.0 : stretch.back().x.last - stretch.front().x.first;
}

}  // namespace

Generatrix::Generatrix(std::vector<NurbsCurve<2>> legs) : legs_(std::move(legs)) {
  std::vector<std::vector<Piece>> stretches = rising_stretches(legs_);
  pieces_ = std::move(*std::ranges::max_element(stretches, {}, length_of));
  if (pieces_.empty())
    throw GeometryError(
        "propeller hub: no piece of the profile runs along the shaft; expected one, on which the "
        "blades stand");
}

int Generatrix::piece_at(double x) const {
  const auto above = std::upper_bound(pieces_.begin() + 1, pieces_.end(), x,
                                      [](double value, const Piece& piece) { return value < piece.x.first; });
  return static_cast<int>(above - pieces_.begin()) - 1;
}

double Generatrix::parameter(int piece, double x) const {
  const Piece& own = pieces_[static_cast<std::size_t>(piece)];
  if (x <= own.x.first) return own.parameters.first;
  if (x >= own.x.last) return own.parameters.last;
  const NurbsCurve<2>& leg = legs_[static_cast<std::size_t>(own.leg)];
  return bracketed_root([&](double t) { return evaluate(leg, t).x() - x; }, own.parameters);
}

double Generatrix::radius(double x) const {
  const int piece = piece_at(x);
  const auto leg = static_cast<std::size_t>(pieces_[static_cast<std::size_t>(piece)].leg);
  return evaluate(legs_[leg], parameter(piece, x)).y();
}

double Generatrix::largest_radius(Interval range) const {
  constexpr int samples = 256;
  double largest = 0.0;
  for (int i = 0; i <= samples; ++i)
    largest = std::max(largest, radius(std::lerp(range.first, range.last, static_cast<double>(i) / samples)));
  for (const Piece& piece : pieces_)
    if (range.first < piece.x.first && piece.x.first < range.last) largest = std::max(largest, radius(piece.x.first));
  return largest;
}

}  // namespace isorim::geometry
