#include "io/svg/bezier_path.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "geometry/spline/bspline.h"
#include "io/svg/markup.h"

namespace isorim::io::svg {

namespace {

using geometry::Point2;
using geometry::Vector2;
/// 3 x (p + 1) homogeneous points of one Bézier segment over [0, 1].
using Net = geometry::HomogeneousPoints<2>;

/// Against endless halving where the tolerance is below rounding.
constexpr int most_halvings = 24;

Point2 cartesian(const Net& net, Eigen::Index i) {
  return net.col(i).head<2>() / net(2, i);
}

/// Both halves of the segment, by de Casteljau's algorithm.
std::pair<Net, Net> halve(const Net& net) {
  const Eigen::Index p = net.cols() - 1;
  Net left(3, p + 1);
  Net right = net;
  for (Eigen::Index k = 0; k <= p; ++k) {
    left.col(k) = right.col(0);
    for (Eigen::Index i = 0; i < p - k; ++i) right.col(i) = 0.5 * (right.col(i) + right.col(i + 1)).eval();
  }
  return {left, right};
}

Point2 evaluate(Net net, double t) {
  for (Eigen::Index k = net.cols() - 1; k > 0; --k) {
    for (Eigen::Index i = 0; i < k; ++i) net.col(i) = (1.0 - t) * net.col(i) + t * net.col(i + 1).eval();
  }
  return cartesian(net, 0);
}

Point2 evaluate_cubic(const PathSegment& cubic, double t) {
  const double s = 1.0 - t;
  return s * s * s * cubic.col(0) + 3.0 * s * s * t * cubic.col(1) + 3.0 * s * t * t * cubic.col(2) +
         t * t * t * cubic.col(3);
}

/// The cubic with the segment's ends and end derivatives (Piegl & Tiller, eqs 4.9 and 4.10).
PathSegment hermite_cubic(const Net& net) {
  const Eigen::Index p = net.cols() - 1;
  const double third = static_cast<double>(p) / 3.0;
  PathSegment cubic(2, 4);
  cubic.col(0) = cartesian(net, 0);
  cubic.col(3) = cartesian(net, p);
  cubic.col(1) = cubic.col(0) + third * net(2, 1) / net(2, 0) * (cartesian(net, 1) - cubic.col(0));
  cubic.col(2) = cubic.col(3) - third * net(2, p - 1) / net(2, p) * (cubic.col(3) - cartesian(net, p - 1));
  return cubic;
}

bool is_close(const Net& net, const PathSegment& cubic, double tolerance) {
  constexpr int probes = 16;
  for (int k = 0; k < probes; ++k) {
    const double t = (k + 0.5) / probes;
    if ((evaluate(net, t) - evaluate_cubic(cubic, t)).norm() > tolerance) return false;
  }
  return true;
}

void add_cubics(const Net& net, double tolerance, int halvings, std::vector<PathSegment>& segments) {
  const PathSegment cubic = hermite_cubic(net);
  if (halvings == most_halvings || is_close(net, cubic, tolerance)) {
    segments.push_back(cubic);
    return;
  }
  const auto [left, right] = halve(net);
  add_cubics(left, tolerance, halvings + 1, segments);
  add_cubics(right, tolerance, halvings + 1, segments);
}

bool is_drawn_exactly(const Net& net) {
  return net.cols() <= 4 && (net.row(2).array() == net(2, 0)).all();
}

}  // namespace

std::vector<PathSegment> path_segments(const geometry::NurbsCurve<2>& curve, double tolerance) {
  std::vector<PathSegment> segments;
  for (const auto& segment : geometry::bezier_segments({curve.knots(), curve.homogeneous()})) {
    const Net net = segment.coefficients;
    if (is_drawn_exactly(net)) {
      segments.emplace_back(net.topRows<2>() / net(2, 0));
    } else {
      add_cubics(net, tolerance, 0, segments);
    }
  }
  return segments;
}

std::string path_command(const PathSegment& segment) {
  constexpr std::array<std::string_view, 4> letters{"", "L", "Q", "C"};
  std::string command(letters[static_cast<std::size_t>(segment.cols() - 1)]);
  for (Eigen::Index i = 1; i < segment.cols(); ++i) {
    command += fmt::format("{}{} {}", i == 1 ? "" : " ", number(segment(0, i), 3), number(segment(1, i), 3));
  }
  return command;
}

}  // namespace isorim::io::svg
