#include "io/svg/bezier_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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
    if ((evaluate(net, t) - evaluate_segment(cubic, t)).norm() > tolerance) return false;
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

/// The parameters in (0, 1) at which one coordinate, a Bézier polynomial of degree 3 at most, is stationary.
std::vector<double> stationary_parameters(const Eigen::RowVectorXd& b) {
  std::vector<double> roots;
  if (b.size() == 3) {
    roots = {(b(0) - b(1)) / (b(0) - 2.0 * b(1) + b(2))};
  } else if (b.size() == 4) {
    const double a = -b(0) + 3.0 * b(1) - 3.0 * b(2) + b(3);
    const double half_b = b(0) - 2.0 * b(1) + b(2);
    const double c = b(1) - b(0);
    const double root = std::sqrt(std::max(0.0, half_b * half_b - a * c));
    const double q = -(half_b + std::copysign(root, half_b));
    roots = {q / a, c / q};
  }
  std::erase_if(roots, [](double t) { return !(t > 0.0 && t < 1.0); });
  return roots;
}

bool is_drawn_exactly(const Net& net) {
  return net.cols() <= 4 && (net.row(2).array() == net(2, 0)).all();
}

}  // namespace

Point2 evaluate_segment(PathSegment segment, double t) {
  for (Eigen::Index k = segment.cols() - 1; k > 0; --k) {
    for (Eigen::Index i = 0; i < k; ++i) segment.col(i) = (1.0 - t) * segment.col(i) + t * segment.col(i + 1).eval();
  }
  return segment.col(0);
}

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

std::vector<PathSegment> path_segments(const Chain& chain, double tolerance) {
  std::vector<PathSegment> segments;
  for (const auto& curve : chain) std::ranges::move(path_segments(curve, tolerance), std::back_inserter(segments));
  return segments;
}

void add_extent(const PathSegment& segment, Bounds& bounds) {
  bounds.add(segment.leftCols(1));
  bounds.add(segment.rightCols(1));
  for (const Eigen::Index coordinate : {0, 1}) {
    for (const double t : stationary_parameters(segment.row(coordinate))) bounds.add(evaluate_segment(segment, t));
  }
}

std::string path_command(const PathSegment& segment, int decimals) {
  constexpr std::array<std::string_view, 4> letters{"", "L", "Q", "C"};
  std::string command(letters[static_cast<std::size_t>(segment.cols() - 1)]);
  for (Eigen::Index i = 1; i < segment.cols(); ++i) {
    command +=
        fmt::format("{}{} {}", i == 1 ? "" : " ", number(segment(0, i), decimals), number(segment(1, i), decimals));
  }
  return command;
}

}  // namespace isorim::io::svg
