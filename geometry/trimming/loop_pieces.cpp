#include "geometry/trimming/loop_pieces.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

std::vector<PlanePiece> curve_pieces(const TrimLoop& loop) {
  std::vector<PlanePiece> pieces;
  for (const NurbsCurve<2>& curve : loop.curves)
    for (const BezierSegment& segment : bezier_segments({curve.knots(), curve.homogeneous()}))
      pieces.emplace_back(segment.coefficients);
  return pieces;
}

}  // namespace

PlanePiece line_piece(const Point2& from, const Point2& to) {
  HomogeneousPoints<2> net(3, 2);
  net << from, to, 1.0, 1.0;
  return PlanePiece(std::move(net));
}

std::vector<PlanePiece> loop_pieces(const TrimLoop& loop) {
  std::vector<PlanePiece> given = curve_pieces(loop);
  std::erase_if(given, [](const PlanePiece& piece) { return piece.lower == piece.upper; });
  if (given.empty()) return given;
  double largest = 0.0;
  for (const PlanePiece& piece : given)
    largest = std::max({largest, piece.lower.cwiseAbs().maxCoeff(), piece.upper.cwiseAbs().maxCoeff()});
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * largest;

  std::vector<PlanePiece> pieces;
  pieces.reserve(given.size() + loop.curves.size());
  const Point2 start = given.front().start();
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Point2 end = given[i].end();
    const Point2 next = i + 1 < given.size() ? given[i + 1].start() : start;
    pieces.push_back(std::move(given[i]));
    if ((end - next).cwiseAbs().maxCoeff() > rounding) pieces.push_back(line_piece(end, next));
  }
  return pieces;
}

std::vector<PlanePiece> loop_pieces(std::span<const TrimLoop> loops) {
  std::vector<PlanePiece> pieces;
  for (const TrimLoop& loop : loops) {
    std::vector<PlanePiece> own = loop_pieces(loop);
    std::move(own.begin(), own.end(), std::back_inserter(pieces));
  }
  return pieces;
}

}  // namespace isorim::geometry
