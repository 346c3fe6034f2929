#include "geometry/trimming/curve_cuts.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/bezier/subdivision.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

/// Stretches of one Bézier segment that are surely below, above, or within the tolerance of the line, in order.
class SegmentSides {
 public:
  SegmentSides(const HomogeneousPoints<2>& net, Interval domain, int d, double value, double tolerance)
      : tolerance_(tolerance) {
    std::vector<double> coefficients;
    for (Eigen::Index i = 0; i < net.cols(); ++i) {
      coefficients.push_back(net(d, i) - value * net(2, i));
      coefficients.push_back(net(2, i));
    }
    divide(coefficients, domain, 0);
  }

  std::vector<CurvePart> parts;

 private:
  void divide(const std::vector<double>& coefficients, Interval domain, int depth) {
    double low = coefficients[0] / coefficients[1];
    double high = low;
    for (std::size_t i = 2; i < coefficients.size(); i += 2) {
      low = std::min(low, coefficients[i] / coefficients[i + 1]);
      high = std::max(high, coefficients[i] / coefficients[i + 1]);
    }
    constexpr int deepest = 40;
    const bool touches_above = low >= -tolerance_;
    const bool touches_below = high <= tolerance_;
    if (touches_above || touches_below || depth == deepest) {
      append(domain, touches_above == touches_below ? 0 : (touches_above ? 1 : -1));
      return;
    }
    const int degree = static_cast<int>(coefficients.size() / 2) - 1;
    const auto [left, right] = subdivide(coefficients, 2, std::span<const int>(&degree, 1), 0);
    divide(left, {domain.first, domain.middle()}, depth + 1);
    divide(right, {domain.middle(), domain.last}, depth + 1);
  }

  void append(Interval domain, int side) {
    if (!parts.empty() && parts.back().side == side)
      parts.back().domain.last = domain.last;
    else
      parts.push_back({domain, side});
  }

  double tolerance_;
};

/// Where the curve passes from `left` to `right`, which are on different sides of the line but for stretches within the
/// tolerance of it: bisection between the nearest two places on either side that are surely apart.
double root_between(const NurbsCurve<2>& curve, int d, double value, const CurvePart& left, const CurvePart& right) {
  const auto is_right = [&](double t) { return (evaluate(curve, t)[d] > value) == (right.side > 0); };
  double low = left.domain.last;
  double high = right.domain.first;
  double width = 1e-9 * (right.domain.last - left.domain.first);
  while ((is_right(low) || !is_right(high)) && (low > left.domain.first || high < right.domain.last)) {
    low = std::max(left.domain.first, left.domain.last - width);
    high = std::min(right.domain.last, right.domain.first + width);
    width *= 4.0;
  }
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;
    (is_right(middle) ? high : low) = middle;
  }
}

void append_part(std::vector<CurvePart>& parts, const CurvePart& part) {
  if (part.domain.length() <= 0.0) return;
  if (!parts.empty() && parts.back().side == part.side)
    parts.back().domain.last = part.domain.last;
  else
    parts.push_back(part);
}

/// A segment that is not along the line has a side everywhere but at roots: stretches within the tolerance go to their
/// neighbours.
void append_decided(const NurbsCurve<2>& curve, int d, double value, const std::vector<CurvePart>& segment,
                    std::vector<CurvePart>& parts) {
  std::vector<CurvePart> decided;
  for (const CurvePart& part : segment)
    if (part.side != 0) decided.push_back(part);
  if (decided.empty()) {
    append_part(parts, {{segment.front().domain.first, segment.back().domain.last}, 0});
    return;
  }
  decided.front().domain.first = segment.front().domain.first;
  decided.back().domain.last = segment.back().domain.last;
  for (std::size_t i = 0; i + 1 < decided.size(); ++i) {
    CurvePart& left = decided[i];
    CurvePart& right = decided[i + 1];
    left.domain.last = right.domain.first =
        left.side == right.side ? left.domain.last : root_between(curve, d, value, left, right);
  }
  for (const CurvePart& part : decided) append_part(parts, part);
}

/// The largest number of neighbours that are all true.
int longest_run(const Eigen::Array<bool, Eigen::Dynamic, 1>& flags) {
  int longest = 0;
  int run = 0;
  for (const bool flag : flags) {
    run = flag ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

/// How far the control points lie beyond a side, in space.
double excess_of(const NurbsCurve<2>& curve, const SideLine& line, const ParameterRectangle& rectangle) {
  const Points<2> controls = curve.control_points();
  double excess = 0.0;
  for (Eigen::Index i = 0; i < controls.cols(); ++i) {
    const Point2 control = controls.col(i);
    const SurfaceJet<3> jet = rectangle.jet(rectangle.clamp_open(control));
    const double speed = (line.parameter == 0 ? jet.du : jet.dv).norm();
    excess = std::max(excess, speed * std::abs(control[line.parameter] - line.value));
  }
  return excess;
}

}  // namespace

Point2 start_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().first);
}

Point2 end_of(const NurbsCurve<2>& curve) {
  return evaluate(curve, curve.domain().last);
}

NurbsCurve<2> straight(const Point2& from, const Point2& to) {
  Points<2> ends(2, 2);
  ends << from, to;
  return NurbsCurve<2>::from_points(KnotVector::bezier(1), ends);
}

NurbsCurve<2> part_of(const NurbsCurve<2>& curve, Interval piece) {
  const Interval all = curve.domain();
  if (piece.first <= all.first && piece.last >= all.last) return curve;
  return restrict_to(curve, piece);
}

std::vector<CurvePart> parts_about_line(const NurbsCurve<2>& curve, int d, double value, double tolerance) {
  const Eigen::ArrayXd distances = curve.homogeneous().row(d).array() / curve.homogeneous().row(2).array() - value;
  const bool above = distances.minCoeff() >= -tolerance;
  const bool below = distances.maxCoeff() <= tolerance;
  if (above && below) return {{curve.domain(), 0}};
  // A segment along the line has all its control points there.
  if ((above || below) && longest_run(distances.abs() <= tolerance) <= curve.degree())
    return {{curve.domain(), above ? 1 : -1}};
  std::vector<CurvePart> parts;
  for (const BezierSegment& segment : bezier_segments({curve.knots(), curve.homogeneous()})) {
    const SegmentSides sides(segment.coefficients, segment.domain, d, value, tolerance);
    append_decided(curve, d, value, sides.parts, parts);
  }
  return parts;
}

ClippedCurve clip_at_open_sides(const NurbsCurve<2>& curve, const ParameterRectangle& rectangle) {
  ClippedCurve result{{curve}, false, 0.0};
  for (int side = 0; side < 4; ++side) {
    const SideLine line = side_line(rectangle, side);
    if (rectangle.is_closed(line.parameter)) continue;
    const int outside = line.value == rectangle.domain(line.parameter).first ? -1 : 1;
    std::vector<NurbsCurve<2>> kept;
    for (const NurbsCurve<2>& whole : result.parts)
      for (const CurvePart& part :
           parts_about_line(whole, line.parameter, line.value, rectangle.tolerance()[line.parameter])) {
        NurbsCurve<2> stretch = part_of(whole, part.domain);
        if (part.side != outside) {
          kept.push_back(std::move(stretch));
          continue;
        }
        result.is_clipped = true;
        result.excess = std::max(result.excess, excess_of(stretch, line, rectangle));
        Point2 from = start_of(stretch);
        Point2 to = end_of(stretch);
        from[line.parameter] = to[line.parameter] = line.value;
        if ((to - from).cwiseAbs().maxCoeff() > 0.0) kept.push_back(straight(from, to));
      }
    result.parts = std::move(kept);
  }
  return result;
}

}  // namespace isorim::geometry
