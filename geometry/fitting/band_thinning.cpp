#include "geometry/fitting/band_thinning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/fitting/neighbour_tree.h"
#include "geometry/fitting/two_heaps.h"

namespace isorim::geometry {
namespace {

/// Largest ratio of the standard deviations across and along a longish neighbourhood.
constexpr double longish = 0.3;
constexpr int least_neighbours = 6;
/// Fine enough for two bands in one neighbourhood to be told apart afterwards.
constexpr double steps_a_radius = 6.0;

/// Mean, and principal directions with the standard deviations along them.
struct Spread {
  Point2 mean = Point2::Zero();
  Vector2 along = Vector2::UnitX();
  double sigma_along = 0.0;
  double sigma_across = 0.0;
};

struct Neighbour {
  int index = 0;
  double weight = 0.0;
};

Spread spread_of(const Points<2>& points, const std::vector<Neighbour>& neighbours) {
  Spread spread;
  double total = 0.0;
  for (const Neighbour& n : neighbours) {
    spread.mean += n.weight * points.col(n.index);
    total += n.weight;
  }
  spread.mean /= total;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const Neighbour& n : neighbours) {
    const Vector2 arm = points.col(n.index) - spread.mean;
    xx += n.weight * arm.x() * arm.x();
    xy += n.weight * arm.x() * arm.y();
    yy += n.weight * arm.y() * arm.y();
  }
  const double middle = 0.5 * (xx + yy) / total;
  const double radius = std::hypot(0.5 * (xx - yy), xy) / total;
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  spread.along = {std::cos(angle), std::sin(angle)};
  spread.sigma_along = std::sqrt(middle + radius);
  spread.sigma_across = std::sqrt(std::max(middle - radius, 0.0));
  return spread;
}

class Thinner {
 public:
  Thinner(const Points<2>& points, const std::vector<double>& weights)
      : tree_(points), weights_(weights), radii_(weights.size()) {
    for (std::size_t i = 0; i < radii_.size(); ++i)
      radii_[i] = longish_radius(points.col(static_cast<Eigen::Index>(i)));
    smooth_radii();
  }

  double radius(std::size_t i) const { return radii_[i]; }

  /// The place on the middle line; the data stay where they are.
  Point2 moved(std::size_t i) const {
    Point2 place = tree_.points().col(static_cast<Eigen::Index>(i));
    for (int round = 0; round < 2; ++round) place = projected(place, radii_[i]);
    return place;
  }

 private:
  std::vector<Neighbour> neighbours(const Point2& place, double radius) const {
    std::vector<Neighbour> found;
    tree_.for_each_within(place, radius, [&](int i, double) {
      found.push_back({i, weights_[static_cast<std::size_t>(i)]});
    });
    return found;
  }

  double longish_radius(const Point2& place) const {
    const std::vector<int> nearest = tree_.nearest(place, least_neighbours + 1);
    double radius = (tree_.points().col(nearest.back()) - place).norm() * (1.0 + 1e-12);
    // The whole set is the last resort.
    const auto count = static_cast<std::size_t>(tree_.points().cols());
    for (std::vector<Neighbour> found = neighbours(place, radius); found.size() < count;
         radius *= 1.25, found = neighbours(place, radius)) {
      const Spread spread = spread_of(tree_.points(), found);
      if (spread.sigma_across <= longish * spread.sigma_along) break;
    }
    return radius;
  }

  void smooth_radii() {
    const std::vector<double> raw = radii_;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      std::vector<double> around;
      tree_.for_each_within(tree_.points().col(static_cast<Eigen::Index>(i)), raw[i],
                            [&](int j, double) { around.push_back(raw[static_cast<std::size_t>(j)]); });
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::ranges::nth_element(around, middle);
      radii_[i] = *middle;
    }
    // At sharp corners no neighbourhood is longish before it is far too large.
    std::vector<double> sorted = radii_;
    const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, usual);
    for (double& radius : radii_) radius = std::min(radius, 1.5 * *usual);
  }

  /// The parabola of weighted least squares through the neighbours, in the directions of their spread about its mean.
  struct MiddleLine {
    Spread spread;
    Vector2 normal = Vector2::UnitY();
    double radius = 1.0;
    Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();

    double along(const Point2& x) const { return (x - spread.mean).dot(spread.along) / radius; }
    double height(double x) const { return coefficients.dot(Eigen::Vector3d(1.0, x, x * x)); }
    double offset(const Point2& x) const { return (x - spread.mean).dot(normal) / radius - height(along(x)); }
  };

  MiddleLine middle_line(const std::vector<Neighbour>& found, double radius) const {
    MiddleLine line;
    line.spread = spread_of(tree_.points(), found);
    line.normal = {-line.spread.along.y(), line.spread.along.x()};
    line.radius = radius;
    // Normal equations of y = a + b x + c x^2 with x in units of the radius: well conditioned.
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Neighbour& n : found) {
      const Vector2 arm = (tree_.points().col(n.index) - line.spread.mean) / radius;
      const double x = arm.dot(line.spread.along);
      const Eigen::Vector3d powers(1.0, x, x * x);
      matrix += n.weight * powers * powers.transpose();
      right += n.weight * arm.dot(line.normal) * powers;
    }
    line.coefficients = parabola(matrix, right);
    return line;
  }

  /// Where two bands lie side by side, only the neighbours in that of the place stay.
  void keep_own_band(const Point2& place, double radius, std::vector<Neighbour>& found) const {
    constexpr double two_bands = 0.85;
    const MiddleLine line = middle_line(found, radius);
    std::vector<double> offsets;
    for (const Neighbour& n : found) offsets.push_back(line.offset(tree_.points().col(n.index)));
    const std::optional<double> split = split_of_heaps(offsets, two_bands);
    if (!split) return;
    const bool is_above = line.offset(place) > *split;
    std::erase_if(found,
                  [&](const Neighbour& n) { return (line.offset(tree_.points().col(n.index)) > *split) != is_above; });
  }

  Point2 projected(const Point2& place, double radius) const {
    std::vector<Neighbour> found = neighbours(place, radius);
    if (found.size() < 5) return place;
    keep_own_band(place, radius, found);
    for (Neighbour& n : found) {
      const double squared = (tree_.points().col(n.index) - place).squaredNorm() / (radius * radius);
      n.weight *= (1.0 - squared) * (1.0 - squared);
    }
    const MiddleLine line = middle_line(found, radius);
    if (!(line.spread.sigma_along > 0.0)) return place;
    const double x = line.along(place);
    return line.spread.mean + radius * (x * line.spread.along + line.height(x) * line.normal);
  }

  /// Gauss elimination of a positive semidefinite matrix; a vanishing pivot leaves its coefficient 0.
  static Eigen::Vector3d parabola(Eigen::Matrix3d matrix, Eigen::Vector3d right) {
    const double size = matrix.diagonal().maxCoeff();
    for (int k = 0; k < 3; ++k) {
      if (matrix(k, k) <= 1e-10 * size) {
        matrix.row(k).setZero();
        matrix(k, k) = 1.0;
        right(k) = 0.0;
      }
      for (int i = k + 1; i < 3; ++i) {
        const double factor = matrix(i, k) / matrix(k, k);
        matrix.row(i) -= factor * matrix.row(k);
        right(i) -= factor * right(k);
      }
    }
    for (int k = 2; k >= 0; --k) {
      for (int j = k + 1; j < 3; ++j) right(k) -= matrix(k, j) * right(j);
      right(k) /= matrix(k, k);
    }
    return right;
  }

  NeighbourTree tree_;
  const std::vector<double>& weights_;
  std::vector<double> radii_;
};

}  // namespace

ThinnedPoints thin_band(const Points<2>& points, const std::vector<double>& weights) {
  const Thinner thinner(points, weights);
  const std::size_t count = weights.size();
  Points<2> moved(2, points.cols());
  for (std::size_t i = 0; i < count; ++i) moved.col(static_cast<Eigen::Index>(i)) = thinner.moved(i);

  // The first of those left absorbs what lies within its step; every cluster is then its weighted mean.
  const NeighbourTree tree(moved);
  std::vector<char> absorbed(count, 0);
  std::vector<Point2> sums;
  ThinnedPoints thinned;
  for (std::size_t i = 0; i < count; ++i) {
    if (absorbed[i]) continue;
    sums.emplace_back(Point2::Zero());
    thinned.weights.push_back(0.0);
    thinned.members.emplace_back();
    const Point2 centre = moved.col(static_cast<Eigen::Index>(i));
    tree.for_each_within(centre, thinner.radius(i) / steps_a_radius, [&](int j, double) {
      if (absorbed[static_cast<std::size_t>(j)]) return;
      absorbed[static_cast<std::size_t>(j)] = 1;
      thinned.members.back().push_back(j);
      sums.back() += weights[static_cast<std::size_t>(j)] * moved.col(j);
      thinned.weights.back() += weights[static_cast<std::size_t>(j)];
    });
  }
  thinned.points.resize(2, static_cast<Eigen::Index>(sums.size()));
  for (std::size_t k = 0; k < sums.size(); ++k) {
    thinned.points.col(static_cast<Eigen::Index>(k)) = sums[k] / thinned.weights[k];
  }
  return thinned;
}

}  // namespace isorim::geometry
